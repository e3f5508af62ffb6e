#include <algorithm>
#include <limits>
#include <string>
#include <vector>

#include "experiments/benchmarks/flow_speed/machine_peaks.h"
#include "experiments/benchmarks/render_speed/scenes.h"
#include "experiments/benchmarks/render_speed/studies.h"
#include "ibrdf/transport/transport.h"

namespace ibrdf {
namespace {

constexpr int kRounds = 5;
// Lists of some 60 MB: far beyond the caches.
constexpr int kPoints = 2048;

// Least seconds of each call over rounds that take them in turn.
std::vector<double> Interleaved(
    const std::vector<std::function<void()>>& calls) {
  std::vector<double> least(calls.size(),
                            std::numeric_limits<double>::infinity());
  for (int round = 0; round < kRounds; ++round) {
    for (size_t k = 0; k < calls.size(); ++k) {
      least[k] = std::min(least[k], Seconds(calls[k]));
    }
  }
  return least;
}

}  // namespace

void PairStudy(const std::string& meshes) {
  const Scene scene = LoadShape(meshes, "bunny");
  const std::vector<ShadingPoint> points =
      SpreadPoints(PointsByAngle(scene, 128, 1), kPoints);
  const Image map = Lights()[1].map;
  const BrdfGrid grid = BrdfGrid::FromMerl(Materials()[1].table, {});
  TransportOptions options;
  options.num_threads = 1;
  // Pairs are what the quadrature gives.
  double near = 0.0, far = 0.0;
  const PointQuadrature quadrature(
      MapCells(
          map.height, map.width,
          FarBlockSize(map.height, map.width, options.quadrature.far_width)),
      options.quadrature);
  PointSamples samples;
  for (const ShadingPoint& p : points) {
    quadrature.Sample(p.normal.cast<double>().normalized(),
                      p.wo.cast<double>().normalized(), &samples);
    near += static_cast<double>(samples.near.size());
    far += static_cast<double>(samples.far.size());
  }
  const double pairs = near + far;

  const Transport transport(points, map.height, map.width, options);
  const LightOperator by_light = transport.ByLight(grid);
  const ReflectanceOperator by_reflectance =
      transport.ByReflectance(map.rgb.data());
  std::vector<double> L_o(3 * points.size()), adjoint(L_o.size(), 1.0);
  std::vector<float> lobes(2 * 3 * points.size()), by_grid(grid.values.size()),
      by_map(map.rgb.size()), stream(32 << 20);
  const float* const fields[] = {grid.Channel(0), grid.Channel(1)};
  double streamed = 0.0;
  const std::vector<double> seconds = Interleaved({
      [&] {
        streamed = static_cast<double>(Stream(stream.data(), stream.size()));
      },
      [&] { const Transport t(points, map.height, map.width, options); },
      [&] { transport.Render(grid, map.rgb.data(), L_o.data()); },
      [&] { transport.RenderLobes(fields, 2, map.rgb.data(), lobes.data()); },
      [&] {
        transport.GridGradient(grid, map.rgb.data(), adjoint.data(),
                               by_grid.data());
      },
      [&] { by_light.Apply(map.rgb.data(), L_o.data()); },
      [&] { by_light.ApplyTranspose(adjoint.data(), by_map.data()); },
      [&] { by_reflectance.Apply(fields, 2, lobes.data()); },
  });
  const char* const names[] = {"stream",
                               "build",
                               "render",
                               "render_two_lobes",
                               "grid_gradient",
                               "by_light_apply",
                               "by_light_transpose",
                               "by_reflectance_apply"};
  // What a call must read from memory: its lists.
  const double lists = static_cast<double>(transport.MemoryBytes());
  const double bytes[] = {streamed,
                          lists,
                          lists,
                          lists,
                          lists,
                          static_cast<double>(by_light.MemoryBytes()),
                          static_cast<double>(by_light.MemoryBytes()),
                          static_cast<double>(by_reflectance.MemoryBytes())};
  Row("pairs", "bunny", "near_pairs_per_point", near / kPoints);
  Row("pairs", "bunny", "far_pairs_per_point", far / kPoints);
  for (size_t k = 0; k < seconds.size(); ++k) {
    Row("pairs", names[k], "gigabytes_per_second",
        bytes[k] / seconds[k] * 1e-9);
    Row("pairs", names[k], "share_of_stream",
        bytes[k] / seconds[k] / (streamed / seconds[0]));
    if (k == 0) continue;
    Row("pairs", names[k], "bytes_per_pair", bytes[k] / pairs);
    Row("pairs", names[k], "million_pairs_per_second",
        pairs / seconds[k] * 1e-6);
  }
}

}  // namespace ibrdf
