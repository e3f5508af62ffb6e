#include "ibrdf/solvers/solve/joint_turns.h"

#include <glog/logging.h>

#include <algorithm>
#include <cmath>
#include <utility>
#include <vector>

#include "ibrdf/light/log_map.h"
#include "ibrdf/solvers/estimation/optimum_average.h"
#include "ibrdf/solvers/estimation/reflectance_given_light.h"

namespace ibrdf {
namespace {

// Residuals of neighbouring pixels that correlate less are noise: no turn would
// explain them.
constexpr double kStructured = 0.35;
constexpr int kMostPixels = 2000;  // that correlation is taken of
// As a multiple of the mean: beyond it a residual counts as that.
constexpr double kLargestResidual = 4.0;

Image MapOf(const LogMap& log_map) {
  Image map(log_map.size().width, log_map.size().height);
  log_map.Exp(&map.rgb);
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
  const LogMap log_map = LogMapOf(estimate.iterate);
  std::vector<double> L_o(3 * indices.size());
  const std::vector<BrdfGrid> grids =
      setup.GridsOf(estimate.iterate.state.lobes);
  ObservedPixels(setup, std::move(some))
      .TransportFrom(log_map.size())
      .Render(ByMaterial(grids), MapOf(log_map).rgb.data(), L_o.data());
  for (size_t k = 0; k < L_o.size(); ++k) {
    const RadianceInterval seen =
        setup.pixels.observed.Interval(3 * indices[k / 3] + k % 3);
    const double rendered = std::max(L_o[k], setup.epsilon);
    L_o[k] = std::log(std::clamp(rendered, seen.low, seen.high) / rendered);
  }
  return L_o;
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

JointTurns::JointTurns(const ModelOptima& found, SolveContext* context)
    : setup_(*found.setup),
      gauge_(found.gauge),
      context_(context),
      turns_(1 + setup_.problem->solver.turns, context) {}

StatusOr<std::optional<RevisedReflectance>> JointTurns::Take(
    const Estimate& estimate) {
  std::optional<RevisedReflectance> revised;
  if (!Worthwhile(estimate)) return revised;
  InverseProblem problem = *setup_.problem;
  const LogMap log_map = LogMapOf(estimate.iterate);
  problem.known_map = MapOf(log_map);
  const StatusOr<SolveSetup> known = SetUp(problem);
  if (!known.ok()) return known.status();
  // From the materials, each time: from the lobes at hand, to which the map has
  // been fitted, steps are short.
  ReflectanceEstimate anew =
      EstimateLobesGivenLight(*known, context_).reflectance;
  // What is cut short may be worse than what was.
  if (context_->Interrupted() || context_->Remaining() < 0.0) return revised;
  // The map takes the level and hue that the mean loses.
  anew.light.mode = log_map;
  anew = AverageOptima({{&*known, gauge_, std::move(anew)}}).estimate;
  revised = {std::move(anew.lobes), std::move(anew.light.mode)};
  const auto level = static_cast<float>(gauge_->Fix(revised->lobes.data()));
  for (size_t k = 0; k < revised->log_map.values().size(); ++k) {
    revised->log_map.data()[k] -= level;
  }
  return revised;
}

bool JointTurns::Worthwhile(const Estimate& estimate) {
  if (!context_->IterationsLeft() || context_->Interrupted() ||
      !turns_.Another()) {
    return false;
  }
  const double correlation = ResidualCorrelation(setup_, estimate);
  VLOG(1) << "residuals of neighbouring pixels correlate by " << correlation;
  return correlation >= kStructured;
}

}  // namespace ibrdf
