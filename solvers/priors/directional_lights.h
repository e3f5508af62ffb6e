// Compact sources of light: the sun, directional lights, windows far away. A
// Gaussian process of log radiance that is right for the rest of light holds
// none.
#pragma once
#include <Eigen/Core>
#include <vector>

#include "ibrdf/scene/scene.h"

namespace ibrdf {

// sr. A directional light has no width; its radiance is that of so large a
// piece of sky.
inline constexpr double kDirectionalLightSolidAngle = 0.1;

// Where light that makes the image's highlights comes from if it mirrors: unit
// directions, at most `most`, the brightest first. A highlight is a local
// maximum of luminance over the directions around it; where it is clipped, the
// middle of what is. radiance [points][3]; clipped [points]: whether of one of
// the channels the least is known alone; empty: none.
std::vector<Eigen::Vector3d> FindDirectionalLights(
    const std::vector<ShadingPoint>& points,
    const std::vector<double>& radiance, int most,
    const std::vector<char>& clipped = {});

// A directional light at offsets [2], radians along two axes of its tangent
// plane.
Eigen::Vector3d MovedDirectionalLight(const Eigen::Vector3d& directional_light,
                                      const double* offsets);

// A texel of a map [H, W] in which a directional light may be.
struct DirectionalLightTexel {
  int texel = 0;        // row * W + column
  double weight = 0.0;  // in (0, 1], of LightProcess::DirectionalLight
};

// Those around directional lights whose directions are known to some degrees,
// in order; where directional lights meet, the larger weight.
std::vector<DirectionalLightTexel> NearDirectionalLights(
    const std::vector<Eigen::Vector3d>& directional_lights, int height,
    int width);

}  // namespace ibrdf
