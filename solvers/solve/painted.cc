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

// Under a light: what the unpainted object shows, and the paint.
struct Paint {
  UnpaintedRadiance unpainted;
  std::vector<double> log_albedo;

  std::vector<double> Gain() const { return PaintGain(unpainted, log_albedo); }
};

void FitPaint(const SolveSetup& setup, const PaintedPixels& pixels,
              Paint* paint) {
  paint->log_albedo = FitAlbedo(paint->unpainted, setup.pixels.observed,
                                pixels.neighbours, pixels.options);
}

// The light and the rest given the paint, and the paint under that light.
StatusOr<Solution> TakeTurn(const SolveSetup& setup,
                            const ReflectanceEstimate& found,
                            const PaintedPixels& pixels, Paint* paint,
                            SolveContext* context) {
  const std::vector<ShadingPoint>& points = setup.pixels.points;
  const InverseProblem without =
      WithoutPaint(*setup.problem, paint->Gain(), points);
  const StatusOr<SolveSetup> of_light = SetUp(without);
  if (!of_light.ok()) return of_light.status();
  StatusOr<Estimate> estimate = EstimateLight(*of_light, found, context);
  if (!estimate.ok()) return estimate.status();
  Solution solution =
      Summarise(*of_light, *std::move(estimate), context,
                UnpaintedRenders(pixels.reflectance, &paint->unpainted));
  TakeMatteOff(&paint->unpainted);
  FitPaint(setup, pixels, paint);
  ScalePixels(paint->Gain(), points, &solution.render);
  SetPaint(setup, pixels.reflectance, paint->unpainted, paint->log_albedo,
           &solution);
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
  const PaintedPixels pixels = {reflectance, neighbours,
                                InViews(first.options, setup.pixels.points)};
  std::vector<float> map;
  found->light.mode.Exp(&map);
  Paint paint;
  paint.unpainted =
      RenderUnpainted(setup, reflectance, map, found->light.mode.size());
  FitPaint(setup, pixels, &paint);
  Turns turns(kLightTurns, context);
  StatusOr<Solution> solution =
      TakeTurn(setup, *found, pixels, &paint, context);
  while (solution.ok() && turns.Another()) {
    StatusOr<Solution> next = TakeTurn(setup, *found, pixels, &paint, context);
    if (!next.ok()) return next;
    if (next->misfit < solution->misfit) solution = std::move(next);
  }
  if (solution.ok()) solution->seconds = context->Elapsed();
  return solution;
}

}  // namespace ibrdf
