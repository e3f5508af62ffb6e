// Pictures of a BRDF on a sphere, to look at.
#pragma once
#include <Eigen/Core>
#include <vector>

#include "ibrdf/brdf/brdf_grid.h"
#include "ibrdf/image/image.h"

namespace ibrdf {

// Parallel light.
struct DirectionalLight {
  Eigen::Vector3d direction;  // to the light, length > 0
  // W/m^2 on a surface that faces the light: one of pi gives radiance
  // cos(theta_i) on a white Lambertian surface.
  Eigen::Array3d irradiance;
};

// A key light at the upper left, a weaker one from the right, one from behind.
std::vector<DirectionalLight> StudioLights();

// An outdoor scene by formula: sky, clouds, hills and a soft sun. Radiance, the
// same in every run. Equirectangular, as of light/environment_map.h.
Image ProceduralSky(int height, int width);

// The unit sphere seen by the orthographic camera, size x size pixels, each the
// mean of samples_per_side^2 positions; 0 outside. `brdf` may be called from
// several threads at a time.
Image RenderBrdfSphere(const BrdfFunction& brdf,
                       const std::vector<DirectionalLight>& lights, int size,
                       int samples_per_side = 3, int num_threads = 0);

// The same of each reflectance under an environment map, at pixel centres, with
// a coarse quadrature (for the eye, not for measurements). All have one grid.
std::vector<Image> RenderBrdfSpheres(const std::vector<BrdfGrid>& brdfs,
                                     const Image& map, int size,
                                     int num_threads = 0);

// The pixels whose centre lies on that sphere.
Mask BrdfSphereMask(int size);

}  // namespace ibrdf
