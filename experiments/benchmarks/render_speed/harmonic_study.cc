#include <algorithm>
#include <string>
#include <vector>

#include "experiments/benchmarks/render_speed/scenes.h"
#include "experiments/benchmarks/render_speed/studies.h"
#include "ibrdf/approximation/harmonic_transport.h"
#include "ibrdf/brdf/cook_torrance.h"
#include "ibrdf/brdf/sample_merl.h"
#include "ibrdf/render/reference_renderer.h"
#include "ibrdf/transport/transport.h"

namespace ibrdf {
namespace {

constexpr int kProbeOrder = 20;

// Rough surfaces beside those of the other studies.
std::vector<Look> MatteToMirror() {
  std::vector<Look> looks;
  for (const double roughness : {0.8, 0.4}) {
    CookTorrance brdf;
    brdf.roughness = Eigen::Array3d::Constant(roughness);
    looks.push_back(
        {"rough_0." + std::to_string(static_cast<int>(10 * roughness + 0.5)),
         SampleMerl(brdf.Function())});
  }
  for (Look& look : Materials()) looks.push_back(std::move(look));
  return looks;
}

// One material under one light, whose renderer is `renderer`.
void StudyErrors(const std::vector<ShadingPoint>& points, const Light& light,
                 const ReferenceRenderer& renderer, const Look& look) {
  const int height = light.map.height, width = light.map.width;
  const BrdfGrid grid = BrdfGrid::FromMerl(look.table, {});
  std::vector<double> truth(3 * points.size()), L_o(truth.size());
  renderer.Render(points, look.table, truth.data());
  HarmonicOptions options;
  options.order = kProbeOrder;
  const std::vector<double> predicted =
      HarmonicTransport(points, height, width, options)
          .PredictLogErrors(grid, light.map.rgb.data());
  const std::string name = look.name + " " + light.name;
  for (const int order : {2, 3, 4, 6, 8, 12, 16}) {
    options.order = order;
    HarmonicTransport(points, height, width, options)
        .Render(grid, light.map.rgb.data(), L_o.data());
    const std::string at = "_order_" + std::to_string(order);
    Row("harmonics", name, "log_error" + at, LogError(L_o, truth));
    Row("harmonics", name, "predicted" + at, predicted[order]);
  }
}

// Both transports' products take turns, on one thread.
void StudySpeed(const std::vector<ShadingPoint>& points) {
  const Light light = Lights()[0];
  const int height = light.map.height, width = light.map.width;
  const float* const map = light.map.rgb.data();
  const BrdfGrid grid = BrdfGrid::FromMerl(Materials()[0].table, {});
  TransportOptions direct_options;
  direct_options.num_threads = 1;
  const Transport direct(points, height, width, direct_options);
  std::vector<double> L_o(3 * points.size());
  std::vector<float> by_grid(grid.values.size()), by_map(light.map.rgb.size());
  for (const int order : {2, 4, 8}) {
    HarmonicOptions options;
    options.order = order;
    options.num_threads = 1;
    const HarmonicTransport harmonic(points, height, width, options);
    double seconds[4] = {1e300, 1e300, 1e300, 1e300};
    const auto least = [&](int k, const auto& call) {
      seconds[k] = std::min(seconds[k], Seconds(call));
    };
    for (int round = 0; round < 3; ++round) {
      least(0, [&] { direct.Render(grid, map, L_o.data()); });
      least(1, [&] { harmonic.Render(grid, map, L_o.data()); });
      least(2, [&] { harmonic.GridGradient(map, L_o.data(), by_grid.data()); });
      least(3, [&] {
        harmonic.ByLight(grid).ApplyTranspose(L_o.data(), by_map.data());
      });
    }
    const std::string name = "sphere 128 order " + std::to_string(order);
    Row("harmonics", name, "transport_render_ms", 1e3 * seconds[0]);
    Row("harmonics", name, "render_ms", 1e3 * seconds[1]);
    Row("harmonics", name, "grid_gradient_ms", 1e3 * seconds[2]);
    Row("harmonics", name, "map_gradient_ms", 1e3 * seconds[3]);
    Row("harmonics", name, "times_faster", seconds[0] / seconds[1]);
  }
}

}  // namespace

void HarmonicStudy(const std::string&) {
  const Scene scene = Scene::UnitSphere();
  const std::vector<ShadingPoint> few = PointsByAngle(scene, 16, 1);
  for (const Light& light : Lights()) {
    const ReferenceRenderer renderer(light.map, {});
    for (const Look& look : MatteToMirror()) {
      StudyErrors(few, light, renderer, look);
    }
  }
  StudySpeed(PointsByAngle(scene, 128, 1));
}

}  // namespace ibrdf
