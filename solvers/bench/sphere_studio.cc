#include "ibrdf/solvers/bench/sphere_studio.h"

#include <glog/logging.h>

#include "ibrdf/brdf/lambertian.h"
#include "ibrdf/render/reference_renderer.h"
#include "ibrdf/solvers/drawing/tone_map.h"
#include "ibrdf/solvers/report/brdf_sphere.h"

namespace ibrdf {
namespace {
constexpr int kSkyHeight = 128;
constexpr double kWhitePercentile = 95.0;
constexpr double kWhiteAlbedo = 0.5;
}  // namespace

SphereStudio::SphereStudio(int size, const BrdfGridShape& grid, int num_threads)
    : size_(size), sky_(ProceduralSky(kSkyHeight, 2 * kSkyHeight)) {
  StatusOr<std::vector<ShadingPoint>> points =
      FindShadingPoints(Scene::UnitSphere(), Camera(), size, size, Mask(), 1);
  CHECK(points.ok()) << points.status().message();
  points_ = *std::move(points);
  // Coarse near the normal: for the eye. Far cells as fine as they may be, or
  // the sun in a wide one leaves a ring where the two rules meet.
  TransportOptions options;
  options.quadrature.near_rings = 14;
  options.quadrature.near_ring_samples = 36;
  options.quadrature.far_width = 64;
  options.grid = grid;
  options.num_threads = num_threads;
  transport_ =
      std::make_unique<Transport>(points_, sky_.height, sky_.width, options);
  Lambertian white;
  white.albedo.setConstant(kWhiteAlbedo);
  exposure_ = ExposureOf(Render(BrdfGrid::FromFunction(white.Function(), grid)),
                         Mask(), kWhitePercentile);
}

Image SphereStudio::Render(const BrdfGrid& brdf) const {
  std::vector<double> L_o(3 * points_.size());
  transport_->Render(brdf, sky_.rgb.data(), L_o.data());
  return PixelMeans(points_, L_o.data(), size_, size_);
}

}  // namespace ibrdf
