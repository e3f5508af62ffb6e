#include "ibrdf/solvers/solve/joint_turns.h"

#include <glog/logging.h>

#include <utility>

#include "ibrdf/light/log_map.h"
#include "ibrdf/solvers/estimation/optimum_average.h"
#include "ibrdf/solvers/estimation/reflectance_given_light.h"
#include "ibrdf/solvers/solve/other_kind.h"
#include "ibrdf/solvers/solve/residual_statistics.h"

namespace ibrdf {
namespace {

// Residuals of neighbouring pixels that correlate less are noise: no turn would
// explain them.
constexpr double kStructured = 0.35;
// Where pixels leave so many times what means over bins leave, before the first
// turn, they show detail that texels cannot: a turn would take it for a sharper
// lobe.
constexpr double kDetailed = 1.65;

Observation BinsOf(const ObservedPixels& pixels) {
  return {pixels.points(), pixels.observed()};
}

Image MapOf(const LogMap& log_map) {
  Image map(log_map.size().width, log_map.size().height);
  log_map.Exp(&map.rgb);
  return map;
}

}  // namespace

JointTurns::JointTurns(const ModelOptima& found, SolveContext* context)
    : setup_(*found.setup),
      gauge_(found.gauge),
      context_(context),
      turns_(1 + setup_.problem->solver.turns, context) {
  if (setup_.problem->solver.search == SolverSearch::kThorough) {
    of_search_ = found;
  }
}

StatusOr<std::optional<RevisedReflectance>> JointTurns::Take(
    const Estimate& estimate) {
  std::optional<RevisedReflectance> revised;
  if (!Worthwhile(estimate)) return revised;
  if (of_search_.has_value()) {
    StatusOr<std::optional<RevisedReflectance>> other = TakeOtherKind(estimate);
    if (!other.ok() || other->has_value()) return other;
  }
  InverseProblem problem = *setup_.problem;
  const LogMap log_map = LogMapOf(estimate.iterate);
  problem.known_map = MapOf(log_map);
  const StatusOr<SolveSetup> known = SetUp(problem);
  if (!known.ok()) return known.status();
  // From the materials, each time: from the lobes at hand, to which the map has
  // been fitted, steps are short.
  ReflectanceEstimate anew =
      EstimateLobesGivenLight(
          *known, *beyond_texels_ ? BinsOf(*estimate.pixels) : known->pixels,
          context_)
          .reflectance;
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

StatusOr<std::optional<RevisedReflectance>> JointTurns::TakeOtherKind(
    const Estimate& estimate) {
  const ModelOptima found = *std::move(of_search_);
  of_search_.reset();
  StatusOr<std::optional<RevisedReflectance>> other =
      FindOtherKind(found, estimate, context_);
  if (other.ok() && other->has_value()) {
    turns_.Restart();
    beyond_texels_.reset();
  }
  return other;
}

bool JointTurns::Worthwhile(const Estimate& estimate) {
  if (!context_->IterationsLeft() || context_->Interrupted() ||
      !turns_.Another()) {
    return false;
  }
  const ResidualStatistics left = ResidualStatisticsOf(setup_, estimate);
  if (!beyond_texels_.has_value()) {
    const double of_bins = Evaluate("map", setup_, *context_, estimate.iterate,
                                    estimate.pixels.get())
                               .misfit;
    beyond_texels_ = left.misfit > kDetailed * of_bins;
    VLOG(1) << "pixels leave " << left.misfit << ", bins " << of_bins
            << "; neighbours correlate by " << left.correlation;
  }
  return left.correlation >= kStructured;
}

}  // namespace ibrdf
