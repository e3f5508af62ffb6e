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

// Pairs of a light direction and a BRDF value that the quadrature gives.
struct PairCounts {
  double near = 0.0, far = 0.0;
  double all() const { return near + far; }
};

PairCounts CountPairs(const std::vector<ShadingPoint>& points, const Image& map,
                      const QuadratureOptions& options) {
  const PointQuadrature quadrature(
      MapCells(map.height, map.width,
               FarBlockSize(map.height, map.width, options.far_width)),
      options);
  PairCounts counts;
  PointSamples samples;
  for (const ShadingPoint& p : points) {
    quadrature.Sample(p.normal.cast<double>().normalized(),
                      p.wo.cast<double>().normalized(), &samples);
    counts.near += static_cast<double>(samples.near.size());
    counts.far += static_cast<double>(samples.far.size());
  }
  return counts;
}

// What was timed: bytes that it must read from memory, and its least seconds.
struct Timed {
  std::string name;
  double bytes, seconds;
};

// The stream through memory is the first of them.
std::vector<Timed> TimeAll(const std::vector<ShadingPoint>& points,
                           const Image& map, const BrdfGrid& grid,
                           const TransportOptions& options) {
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
  // A call must read its lists.
  const auto lists = static_cast<double>(transport.MemoryBytes());
  const auto light = static_cast<double>(by_light.MemoryBytes());
  const auto reflectance = static_cast<double>(by_reflectance.MemoryBytes());
  return {{"stream", streamed, seconds[0]},
          {"build", lists, seconds[1]},
          {"render", lists, seconds[2]},
          {"render_two_lobes", lists, seconds[3]},
          {"grid_gradient", lists, seconds[4]},
          {"by_light_apply", light, seconds[5]},
          {"by_light_transpose", light, seconds[6]},
          {"by_reflectance_apply", reflectance, seconds[7]}};
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
  const PairCounts pairs = CountPairs(points, map, options.quadrature);
  const std::vector<Timed> all = TimeAll(points, map, grid, options);
  const Timed& stream = all[0];
  Row("pairs", "bunny", "near_pairs_per_point", pairs.near / kPoints);
  Row("pairs", "bunny", "far_pairs_per_point", pairs.far / kPoints);
  for (const Timed& timed : all) {
    Row("pairs", timed.name, "gigabytes_per_second",
        timed.bytes / timed.seconds * 1e-9);
    Row("pairs", timed.name, "share_of_stream",
        timed.bytes / timed.seconds / (stream.bytes / stream.seconds));
    if (&timed == &stream) continue;
    Row("pairs", timed.name, "bytes_per_pair", timed.bytes / pairs.all());
    Row("pairs", timed.name, "million_pairs_per_second",
        pairs.all() / timed.seconds * 1e-6);
  }
}

}  // namespace ibrdf
