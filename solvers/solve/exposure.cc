#include "ibrdf/solvers/solve/exposure.h"

#include <algorithm>
#include <cmath>
#include <limits>
#include <memory>
#include <optional>
#include <utility>

#include "ibrdf/solvers/costs/observations.h"
#include "ibrdf/solvers/observation/observation.h"

namespace ibrdf {
namespace {

void Scale(double factor, Image* image) {
  constexpr double kMost = std::numeric_limits<float>::max();
  for (float& v : image->rgb) {
    if (!std::isfinite(v)) continue;  // bad pixels stay bad
    v = static_cast<float>(std::clamp(v * factor, -kMost, kMost));
  }
}

void Scale(double factor, std::optional<RadianceBounds>* bounds) {
  if (!bounds->has_value()) return;
  Scale(factor, &(*bounds)->low);
  Scale(factor, &(*bounds)->high);
}

}  // namespace

double ExposureOf(const InverseProblem& problem) {
  const Observations observed =
      Observe(problem.image, nullptr, problem.points).observed;
  if (observed.num_valid == 0) return 1.0;
  double sum = 0.0;
  for (size_t i = 0; i < observed.radiance.size(); ++i) {
    if (observed.valid[i / 3]) sum += std::log2(observed.radiance[i]);
  }
  return std::exp2(std::round(sum / (3.0 * observed.num_valid)));
}

InverseProblem InUnitsOf(double exposure, const InverseProblem& problem) {
  InverseProblem out = problem;
  Scale(1.0 / exposure, &out.image);
  Scale(1.0 / exposure, &out.bounds);
  if (out.known_map) Scale(1.0 / exposure, &*out.known_map);
  if (out.epsilon) *out.epsilon /= exposure;
  for (auto& other : out.other_photographs) {
    OtherPhotograph scaled = *other;
    Scale(1.0 / exposure, &scaled.image);
    Scale(1.0 / exposure, &scaled.bounds);
    other = std::make_shared<const OtherPhotograph>(std::move(scaled));
  }
  out.dark.ambient /= exposure;
  out.dark.ambient_deviation /= exposure;
  return out;
}

void RestoreUnits(double exposure, Solution* estimate) {
  Scale(exposure, &estimate->map);
  Scale(exposure, &estimate->render);
  Scale(exposure, &estimate->gloss);
  for (OtherLight& other : estimate->other_lights) {
    Scale(exposure, &other.map);
    Scale(exposure, &other.render);
  }
  estimate->epsilon *= exposure;
  estimate->ambient *= exposure;
}

}  // namespace ibrdf
