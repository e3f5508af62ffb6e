#include "ibrdf/solvers/solve/joint_turns.h"

#include <glog/logging.h>

#include <algorithm>
#include <cmath>
#include <utility>
#include <vector>

#include "ibrdf/light/log_map.h"
#include "ibrdf/solvers/estimation/light_given_reflectance.h"
#include "ibrdf/solvers/estimation/reflectance_given_light.h"
#include "ibrdf/solvers/solve/turns.h"

namespace ibrdf {
namespace {

// A turn is kept that lowers the misfit by this share.
constexpr double kLeastGain = 0.02;
// Residuals of neighbouring pixels that correlate less are noise: no turn would
// explain them.
constexpr double kStructured = 0.3;
constexpr int kMostPixels = 2000;  // that correlation is taken of
// Of the mean: beyond it a residual counts as that.
constexpr double kLargestResidual = 4.0;

std::vector<float> MapOf(const Estimate& estimate, MapSize* size) {
  LogMap log_map;
  estimate.iterate.light.map->Forward(estimate.iterate.state.light.data(),
                                      &log_map);
  *size = log_map.size();
  std::vector<float> map;
  log_map.Exp(&map);
  return map;
}

// Whole rows of the image, evenly spread: indices of pixels.
std::vector<size_t> SomeRows(const Observation& pixels, int width) {
  const size_t stride = pixels.points.size() / kMostPixels + 1;
  std::vector<size_t> out;
  for (size_t i = 0; i < pixels.points.size(); ++i) {
    const size_t row = pixels.points[i].pixel / width;
    if (row % stride == stride / 2 && pixels.observed.valid[i]) {
      out.push_back(i);
    }
  }
  return out;
}

// What the log radiance of these pixels lacks [indices * 3].
std::vector<double> ResidualsOf(const Estimate& estimate,
                                const std::vector<size_t>& indices,
                                const SolveSetup& setup) {
  Observation some;
  for (const size_t i : indices) {
    some.points.push_back(setup.pixels.points[i]);
  }
  MapSize size;
  const std::vector<float> map = MapOf(estimate, &size);
  std::vector<double> L_o(3 * indices.size());
  const std::vector<BrdfGrid> grids =
      setup.GridsOf(estimate.iterate.state.lobes);
  ObservedPixels(setup, std::move(some))
      .TransportFrom(size)
      .Render(ByMaterial(grids), map.data(), L_o.data());
  for (size_t k = 0; k < L_o.size(); ++k) {
    const RadianceInterval seen =
        setup.pixels.observed.Interval(3 * indices[k / 3] + k % 3);
    const double rendered = std::max(L_o[k], setup.epsilon);
    L_o[k] = std::log(std::clamp(rendered, seen.low, seen.high) / rendered);
  }
  return L_o;
}

InverseProblem UnderLightOf(const Estimate& estimate,
                            const InverseProblem& problem) {
  MapSize size;
  std::vector<float> map = MapOf(estimate, &size);
  InverseProblem out = problem;
  out.known_map = Image(size.width, size.height);
  out.known_map->rgb = std::move(map);
  return out;
}

// The reflectance under the estimate's map; its light begins where the search
// left it.
StatusOr<ReflectanceEstimate> ReflectanceAnew(const SolveSetup& setup,
                                              const LevelGauge& gauge,
                                              const Estimate& estimate,
                                              SolveContext* context) {
  const InverseProblem problem = UnderLightOf(estimate, *setup.problem);
  const StatusOr<SolveSetup> known = SetUp(problem);
  if (!known.ok()) return known.status();
  ReflectanceEstimate out = estimate.reflectance;
  out.lobes = EstimateReflectanceGivenLight(*known, context).reflectance.lobes;
  const auto level = static_cast<float>(gauge.Fix(out.lobes.data()));
  for (size_t k = 0; k < out.light.mode.values().size(); ++k) {
    out.light.mode.data()[k] -= level;
  }
  return out;
}

double MisfitOf(const Estimate& estimate, const SolveSetup& setup,
                const SolveContext& context) {
  return Evaluate("turn", setup, context, estimate.iterate,
                  estimate.pixels.get())
      .misfit;
}

}  // namespace

double ResidualCorrelation(const SolveSetup& setup, const Estimate& estimate) {
  const std::vector<size_t> indices =
      SomeRows(setup.pixels, setup.problem->image.width);
  if (indices.empty()) return 0.0;
  std::vector<double> r = ResidualsOf(estimate, indices, setup);
  double mean = 0.0;
  for (const double v : r) mean += std::abs(v) / static_cast<double>(r.size());
  const double largest = kLargestResidual * mean;
  for (double& v : r) v = std::clamp(v, -largest, largest);
  double products = 0.0, squares = 0.0;
  for (size_t k = 0; k + 1 < indices.size(); ++k) {
    const ShadingPoint& here = setup.pixels.points[indices[k]];
    const ShadingPoint& next = setup.pixels.points[indices[k + 1]];
    if (next.pixel != here.pixel + 1) continue;
    for (size_t c = 3 * k; c < 3 * k + 3; ++c) {
      products += r[c] * r[c + 3];
      squares += 0.5 * (r[c] * r[c] + r[c + 3] * r[c + 3]);
    }
  }
  return squares > 0.0 ? products / squares : 0.0;
}

StatusOr<Estimate> TakeJointTurns(const SolveSetup& setup,
                                  const LevelGauge& gauge, Estimate estimate,
                                  SolveContext* context) {
  const int most = setup.problem->solver.turns;
  if (most == 0) return estimate;
  const double correlation = ResidualCorrelation(setup, estimate);
  VLOG(1) << "residuals of neighbouring pixels correlate by " << correlation;
  if (correlation < kStructured) return estimate;
  Turns turns(1 + most, context);
  double misfit = MisfitOf(estimate, setup, *context);
  while (context->IterationsLeft() && !context->Interrupted() &&
         turns.Another()) {
    StatusOr<ReflectanceEstimate> reflectance =
        ReflectanceAnew(setup, gauge, estimate, context);
    if (!reflectance.ok()) return reflectance.status();
    StatusOr<Estimate> next =
        EstimateLight(setup, *std::move(reflectance), context);
    if (!next.ok()) return next.status();
    const double now = MisfitOf(*next, setup, *context);
    VLOG(1) << "a turn of reflectance and light: misfit " << misfit << " -> "
            << now;
    if (!(now < (1.0 - kLeastGain) * misfit)) break;
    estimate = *std::move(next);
    misfit = now;
  }
  return estimate;
}

}  // namespace ibrdf
