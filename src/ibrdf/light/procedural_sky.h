// A made-up outdoor illumination: sun, sky, clouds, a skyline, ground.
#pragma once
#include <Eigen/Core>

#include "ibrdf/image/image.h"

namespace ibrdf {

// Angles in degrees. theta is from +y, phi from +z towards +x, as in
// light/environment_map.h.
struct SkyOptions {
  double sun_theta_degrees = 40.0;  // [0, 90]
  double sun_phi_degrees = 60.0;
  // Where the sun's radiance has fallen to 1/e of its peak; (0, 30].
  double sun_radius_degrees = 1.5;
  double sun_irradiance = 3.0;    // on a surface that faces it, W/m^2; >= 0
  double zenith_radiance = 0.35;  // clear sky overhead, W/(m^2 sr); > 0
  double haze = 0.4;     // [0, 1]: whiter horizon, wider glow around the sun
  double clouds = 0.6;   // [0, 1]: strength of the clouds
  double skyline = 0.7;  // [0, 1]: height of the buildings and their windows
  double ground_albedo = 0.2;  // [0, 1]
};

// Radiance without the sun's disc (its glow included); `direction`: unit.
// Smooth, finite and positive.
Eigen::Array3d SkyRadiance(const SkyOptions& options,
                           const Eigen::Vector3d& direction);

// Equirectangular map: SkyRadiance at texel centres plus the sun averaged over
// each texel, with sun_irradiance kept at any size. width, height > 0.
Image RenderSky(const SkyOptions& options, int height, int width);

}  // namespace ibrdf
