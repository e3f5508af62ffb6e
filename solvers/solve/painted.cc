#include "ibrdf/solvers/solve/painted.h"

#include <glog/logging.h>

#include <utility>
#include <vector>

#include "ibrdf/solvers/estimation/light_given_reflectance.h"
#include "ibrdf/solvers/estimation/marginal_search.h"
#include "ibrdf/solvers/paint/albedo_fit.h"
#include "ibrdf/solvers/paint/first_paint.h"
#include "ibrdf/solvers/solve/summary.h"
#include "ibrdf/solvers/solve/turns.h"
#include "ibrdf/solvers/solve/unpainted_object.h"

namespace ibrdf {
namespace {

constexpr int kLightTurns = 2;  // of light and paint

// What all turns know of the paint.
struct PaintedPixels {
  const UnpaintedReflectance& reflectance;
  const std::vector<NeighbourPair>& neighbours;
  AlbedoFitOptions options;
};

// The paint under the light that gives `unpainted`, and the light and the rest
// given that paint. `unpainted` receives what the light that was found gives.
StatusOr<Solution> TakeTurn(const SolveSetup& setup,
                            const ReflectanceEstimate& found,
                            const PaintedPixels& paint,
                            UnpaintedRadiance* unpainted,
                            SolveContext* context) {
  const std::vector<ShadingPoint>& points = setup.pixels.points;
  const std::vector<double> log_albedo =
      FitAlbedo(*unpainted, setup.pixels.observed, paint.neighbours,
                InViews(paint.options, points));
  const std::vector<double> gain = PaintGain(*unpainted, log_albedo);
  const InverseProblem without = WithoutPaint(*setup.problem, gain, points);
  const StatusOr<SolveSetup> of_light = SetUp(without);
  if (!of_light.ok()) return of_light.status();
  StatusOr<Estimate> estimate = EstimateLight(*of_light, found, context);
  if (!estimate.ok()) return estimate.status();
  // Render and gloss are of the light that was found, not of that before.
  Solution solution = Summarise(*of_light, *std::move(estimate), context,
                                UnpaintedRenders(paint.reflectance, unpainted));
  TakeMatteOff(unpainted);
  ScalePixels(PaintGain(*unpainted, log_albedo), points, &solution.render);
  SetPaint(setup, paint.reflectance, *unpainted, log_albedo, &solution);
  return solution;
}

}  // namespace

StatusOr<Solution> SolvePainted(const SolveSetup& setup,
                                SolveContext* context) {
  const std::vector<NeighbourPair> neighbours =
      NeighboursOf(setup.pixels.points, setup.problem->image.width);
  const FirstPaint first =
      FindFirstPaint(setup.pixels.points, setup.pixels.observed, neighbours);
  const StatusOr<ReflectanceEstimate> found =
      EstimateReflectance(setup, context, &first);
  if (!found.ok() && found.status().code() != StatusCode::kNoImprovement) {
    return found.status();
  }
  if (!found.ok() || found->light.mode.num_texels() == 0) {
    LOG(WARNING) << "no paint was told from the light";
    return Summarise(setup, ConstantLight(setup, MeanMaterial(setup)), context);
  }
  const UnpaintedReflectance reflectance =
      UnpaintedOf(*setup.lobes, found->lobes.data());
  const PaintedPixels paint = {reflectance, neighbours, first.options};
  std::vector<float> map;
  found->light.mode.Exp(&map);
  UnpaintedRadiance unpainted =
      RenderUnpainted(setup, reflectance, map, found->light.mode.size());
  Turns turns(kLightTurns, context);
  StatusOr<Solution> solution =
      TakeTurn(setup, *found, paint, &unpainted, context);
  while (solution.ok() && turns.Another()) {
    StatusOr<Solution> next =
        TakeTurn(setup, *found, paint, &unpainted, context);
    if (!next.ok()) return next;
    if (next->misfit < solution->misfit) solution = std::move(next);
  }
  if (solution.ok()) solution->seconds = context->Elapsed();
  return solution;
}

}  // namespace ibrdf
