#include "ibrdf/solvers/solve/solve.h"

#include <glog/logging.h>

#include <optional>
#include <utility>
#include <vector>

#include "ibrdf/solvers/estimation/light_given_reflectance.h"
#include "ibrdf/solvers/estimation/marginal_search.h"
#include "ibrdf/solvers/estimation/scale_ambiguity.h"
#include "ibrdf/solvers/estimation/solve_setup.h"
#include "ibrdf/solvers/problem/of_material.h"
#include "ibrdf/solvers/problem/with_labels.h"
#include "ibrdf/solvers/published/joint_maximum.h"
#include "ibrdf/solvers/solve/curve_search.h"
#include "ibrdf/solvers/solve/exposure.h"
#include "ibrdf/solvers/solve/found_labels.h"
#include "ibrdf/solvers/solve/joint.h"
#include "ibrdf/solvers/solve/known_light.h"
#include "ibrdf/solvers/solve/labelled.h"
#include "ibrdf/solvers/solve/map_turns.h"
#include "ibrdf/solvers/solve/paint_evidence.h"
#include "ibrdf/solvers/solve/paint_turns.h"
#include "ibrdf/solvers/solve/painted.h"
#include "ibrdf/solvers/solve/painted_known_light.h"
#include "ibrdf/solvers/solve/summary.h"

namespace ibrdf {
namespace {

StatusOr<Estimate> EstimateLightOfKnownReflectance(const SolveSetup& setup,
                                                   SolveContext* context) {
  ReflectanceEstimate known;
  known.light = EstimateLightPosterior(setup, context);
  return EstimateLight(setup, std::move(known), context);
}

// A misfit from which on other frames of the map are tried. Of 42 balls under a
// map in a wrong frame the least was 0.052.
constexpr double kWorthTurning = 0.04;

void SetBetterTurn(const MapTurns& turns, bool of_paint, Solution* solution) {
  solution->better_map_turn = turns.best;
  solution->misfit_of_given_map = turns.as_given;
  solution->map_turn_of_paint = of_paint;
}

// Paint explains much of what a map in a wrong frame leaves: whether it does is
// asked of the image.
StatusOr<Solution> SolvePaintedUnderAnyFrame(const SolveSetup& setup,
                                             SolveContext* context) {
  StatusOr<Solution> solution = SolvePaintedUnderKnownLight(setup, context);
  if (!solution.ok()) return solution;
  const std::optional<MapTurns> turns = FindPaintTurns(setup);
  if (turns.has_value() && IsBetterOfPaint(*turns)) {
    SetBetterTurn(*turns, true, &*solution);
    DoubtAlbedo(setup, turns->best, &*solution);
  }
  return solution;
}

StatusOr<Solution> SolveUnderKnownLight(const SolveSetup& setup,
                                        bool may_be_painted,
                                        SolveContext* context) {
  StatusOr<KnownLightEstimate> found = EstimateUnderKnownLight(setup, context);
  if (!found.ok()) return found.status();
  const SolveSetup& of_model = found->SetupOr(setup);
  const LeftByOneMaterial left = LeftBy(of_model, found->estimate, *context);
  MapTurns turns;
  if (left.misfit > kWorthTurning) turns = FindMapTurns(setup);
  if (may_be_painted && left.MayBePaint() && !IsFarBetter(turns)) {
    StatusOr<Solution> painted = SolvePaintedUnderAnyFrame(setup, context);
    if (painted.ok() && left.IsExplainedBy(painted->misfit)) return painted;
    if (!painted.ok()) {
      LOG(WARNING) << "the object is taken for one of one material, as no "
                      "paint could be estimated: "
                   << painted.status().message();
    }
  }
  Solution solution = Summarise(of_model, std::move(found->estimate), context);
  solution.models = std::move(found->models);
  solution.model_weights = std::move(found->model_weights);
  solution.mirrored_share = left.mirrored;
  if (IsFarBetter(turns)) SetBetterTurn(turns, false, &solution);
  return solution;
}

StatusOr<Estimate> EstimateUnknowns(const SolveSetup& setup,
                                    SolveContext* context) {
  if (!setup.lobes_unknown()) {
    return EstimateLightOfKnownReflectance(setup, context);
  }
  return EstimateJointMaximum(setup, context);
}

StatusOr<Solution> SolveOneMaterial(const SolveSetup& setup,
                                    bool may_be_painted,
                                    SolveContext* context) {
  if (!setup.light_unknown()) {
    return SolveUnderKnownLight(setup, may_be_painted, context);
  }
  if (setup.lobes_unknown() && !setup.joint_maximum()) {
    return SolveJoint(setup, context);
  }
  StatusOr<Estimate> estimate = EstimateUnknowns(setup, context);
  if (!estimate.ok()) return estimate.status();
  return Summarise(setup, *std::move(estimate), context);
}

// In units in which radiance is near 1.
StatusOr<Solution> Solve(const InverseProblem& problem, SolveContext* context) {
  const StatusOr<SolveSetup> setup = SetUp(problem);
  if (!setup.ok()) return setup.status();
  IBRDF_RETURN_IF_ERROR(CheckMethod(*setup));
  context->Reserve(PredictSummarySeconds(*setup, *context));
  const bool may_be_painted = problem.variation == ReflectanceVariation::kAuto;
  const bool light_unknown = setup->light_unknown();
  if (problem.variation == ReflectanceVariation::kAlbedo ||
      (may_be_painted && light_unknown && IsProbablyPainted(*setup, context))) {
    return light_unknown ? SolvePainted(*setup, context)
                         : SolvePaintedUnderAnyFrame(*setup, context);
  }
  if (problem.materials.size() > 1) return SolveLabelled(*setup, context);
  StatusOr<Solution> solution =
      SolveOneMaterial(*setup, may_be_painted, context);
  if (solution.ok() && !problem.materials.empty() && !solution->has_paint()) {
    solution->materials.push_back(solution->reflectance());
  }
  return solution;
}

StatusOr<Solution> FindLabelsAndSolve(const InverseProblem& problem,
                                      SolveContext* context) {
  FoundLabels found = FindLabels(problem, context);
  StatusOr<Solution> solution =
      Solve(WithLabels(problem, found.labels), context);
  if (solution.ok()) solution->found_labels = std::move(found);
  return solution;
}

// Solves an image whose radiance, or its bounds, are known.
StatusOr<Solution> SolveDeveloped(const InverseProblem& problem,
                                  SolveContext* context) {
  const double exposure = ExposureOf(problem);
  const InverseProblem scaled = InUnitsOf(exposure, problem);
  const bool find_labels = problem.variation == ReflectanceVariation::kLabels &&
                           problem.materials.empty();
  StatusOr<Solution> solution = find_labels
                                    ? FindLabelsAndSolve(scaled, context)
                                    : Solve(scaled, context);
  if (!solution.ok()) return solution;
  RestoreUnits(exposure, &*solution);
  if (problem.solver.gauge != SolverGauge::kPrior &&
      !problem.known_map.has_value() && !problem.known_brdf.has_value()) {
    SetGauge(problem.solver.gauge,
             ModelOf(problem, *solution).model->shape.code_size(), &*solution);
  }
  return solution;
}

}  // namespace

StatusOr<Solution> SolveInverseRendering(const InverseProblem& problem,
                                         const SolveProgress& progress,
                                         const std::atomic<bool>* stop) {
  SolveContext context(problem, progress, stop);
  if (!problem.unknown_curve.has_value()) {
    return SolveDeveloped(problem, &context);
  }
  // One material says enough of a curve.
  StatusOr<std::vector<CurveEstimate>> curves =
      FindCurves(problem.materials.empty()
                     ? problem
                     : OfMaterial(problem, MainMaterial(problem.materials)),
                 &context);
  if (!curves.ok()) {
    // The first guess fails as well, or says how little there is to see.
    LOG(INFO) << curves.status().message();
    return SolveDeveloped(problem, &context);
  }
  StatusOr<Solution> solution =
      SolveDeveloped(WithCurve(problem, curves->front().curve), &context);
  if (solution.ok()) solution->curves = *std::move(curves);
  return solution;
}

}  // namespace ibrdf
