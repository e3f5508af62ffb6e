#include <algorithm>
#include <cmath>
#include <cstdlib>
#include <string>
#include <vector>

#include "experiments/benchmarks/render_speed/scenes.h"
#include "experiments/benchmarks/render_speed/studies.h"
#include "ibrdf/approximation/reflectance_map.h"
#include "ibrdf/render/reference_radiance.h"
#include "ibrdf/render/reference_renderer.h"

namespace ibrdf {
namespace {

// Points that are rendered together; solvers/render_scene takes 2048.
constexpr size_t kStep = 512;
// Steps that are rendered point by point: all of a small image, evenly spread
// ones of a large image.
constexpr size_t kSteps = 4;

void Compare(const std::string& name, const std::vector<ShadingPoint>& points,
             const ReferenceRenderer& renderer, const MerlTable& table) {
  const size_t all = (points.size() + kStep - 1) / kStep;
  const size_t some = std::min(all, kSteps);
  std::vector<double> truth, guess, L_o(3 * points.size());
  double direct = 0.0, by_normal = 0.0;
  size_t timed = 0;
  std::vector<size_t> where;
  const auto render_steps = [&](size_t first, size_t last) {
    for (size_t k = first; k < last; ++k) {
      const size_t begin = (2 * k + 1) * all / (2 * some) * kStep;
      const size_t end = std::min(begin + kStep, points.size());
      const std::vector<ShadingPoint> step(points.begin() + begin,
                                           points.begin() + end);
      std::vector<double> out(3 * step.size());
      direct += Seconds([&] { renderer.Render(step, table, out.data()); });
      truth.insert(truth.end(), out.begin(), out.end());
      timed += step.size();
      for (size_t i = begin; i < end; ++i) where.push_back(i);
    }
  };
  ReflectanceMapReport report;
  render_steps(0, some / 2);
  by_normal = Seconds([&] {
    report = RenderByNormal(points, ReferenceRadiance(renderer, table), {}, {},
                            L_o.data())
                 .value();
  });
  render_steps(some / 2, some);
  for (const size_t i : where) {
    for (int c = 0; c < 3; ++c) guess.push_back(L_o[3 * i + c]);
  }
  direct *= static_cast<double>(points.size()) / static_cast<double>(timed);
  Row("maps", name, "points", static_cast<double>(points.size()));
  Row("maps", name, "rendered", report.rendered);
  Row("maps", name, "seconds_direct", direct);
  Row("maps", name, "seconds_by_normal", by_normal);
  Row("maps", name, "times_faster", direct / by_normal);
  Row("maps", name, "log_error", LogError(guess, truth));
  Row("maps", name, "log_error_estimate", report.log_error);
}

}  // namespace

void MapStudy(const std::string& meshes) {
  const std::vector<Light> lights = Lights();
  for (const Look& look : Materials()) {
    for (const char* shape : {"sphere", "bunny"}) {
      const Scene scene = LoadShape(meshes, shape);
      for (const int size : {128, 256, 512}) {
        const std::vector<ShadingPoint> points = PointsByAngle(scene, size, 2);
        for (const Light& light : lights) {
          std::string name = shape;
          name += " " + std::to_string(size) + " " + look.name;
          Compare(name + " " + light.name, points,
                  ReferenceRenderer(light.map, {}), look.table);
        }
      }
    }
  }
}

}  // namespace ibrdf
