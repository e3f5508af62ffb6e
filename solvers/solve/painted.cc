#include "ibrdf/solvers/solve/painted.h"

#include <glog/logging.h>

#include <algorithm>
#include <utility>
#include <vector>

#include "ibrdf/base/pi.h"
#include "ibrdf/brdf/matte_split.h"
#include "ibrdf/solvers/estimation/light_given_reflectance.h"
#include "ibrdf/solvers/estimation/marginal_search.h"
#include "ibrdf/solvers/estimation/pixel_renders.h"
#include "ibrdf/solvers/paint/albedo_fit.h"
#include "ibrdf/solvers/paint/first_paint.h"
#include "ibrdf/solvers/solve/summary.h"

namespace ibrdf {
namespace {

// Light and paint in turns.
constexpr int kTurns = 2;
// Another turn is taken where this many times the last one's time is left.
constexpr double kTurnMargin = 1.5;

// Matte and gloss of lobes, a = 1.
struct Unpainted {
  BrdfGrid whole, matte;
  Eigen::Array3d albedo;  // of the matte part
};

Unpainted UnpaintedOf(const LobeModel& lobes, const double* parameters) {
  Unpainted out;
  out.whole = lobes.Grid(parameters);
  out.matte = lobes.Combine(parameters, MatteShapes(lobes, parameters), 1);
  const int nodes = out.matte.shape.num_nodes();
  for (int c = 0; c < 3; ++c) {
    const float* f = out.matte.Channel(c);
    out.albedo[c] = kPi * *std::max_element(f, f + nodes);
  }
  return out;
}

UnpaintedRadiance Render(const SolveSetup& setup, const Unpainted& reflectance,
                         const std::vector<float>& map, MapSize size) {
  UnpaintedRadiance out;
  RenderPixels(setup, size,
               {{&reflectance.matte, map.data(), &out.matte},
                {&reflectance.whole, map.data(), &out.gloss}});
  for (size_t i = 0; i < out.gloss.size(); ++i) {
    out.gloss[i] = std::max(out.gloss[i] - out.matte[i], 0.0);
  }
  return out;
}

// Radiance divided by, or times, factors > 0 [points * 3].
void ScalePixels(const std::vector<double>& factors, bool divide,
                 const std::vector<ShadingPoint>& points, Image* image) {
  for (size_t i = 0; i < points.size(); ++i) {
    for (int c = 0; c < 3; ++c) {
      float& v = image->rgb[size_t{3} * points[i].pixel + c];
      const double factor = factors[3 * i + c];
      v = static_cast<float>(divide ? v / factor : v * factor);
    }
  }
}

InverseProblem WithoutPaint(const InverseProblem& problem,
                            const std::vector<double>& gain,
                            const std::vector<ShadingPoint>& points) {
  InverseProblem out = problem;
  ScalePixels(gain, true, points, &out.image);
  if (out.bounds) {
    ScalePixels(gain, true, points, &out.bounds->low);
    ScalePixels(gain, true, points, &out.bounds->high);
  }
  return out;
}

// What all turns know of the paint.
struct PaintedPixels {
  std::vector<NeighbourPair> neighbours;
  AlbedoFitOptions options;
};

// The paint under a map, and the light and the rest given that paint.
StatusOr<Solution> TakeTurn(const SolveSetup& setup,
                            const ReflectanceEstimate& found,
                            const Unpainted& reflectance,
                            const std::vector<float>& map, MapSize size,
                            const PaintedPixels& paint, SolveContext* context) {
  const std::vector<ShadingPoint>& points = setup.pixels.points;
  const UnpaintedRadiance unpainted = Render(setup, reflectance, map, size);
  const std::vector<double> log_albedo = FitAlbedo(
      unpainted, setup.pixels.observed, paint.neighbours, paint.options);
  const std::vector<double> gain = PaintGain(unpainted, log_albedo);
  const InverseProblem without = WithoutPaint(*setup.problem, gain, points);
  const StatusOr<SolveSetup> of_light = SetUp(without);
  if (!of_light.ok()) return of_light.status();
  StatusOr<Estimate> estimate = EstimateLight(*of_light, found, context);
  if (!estimate.ok()) return estimate.status();
  Solution solution = Summarise(*of_light, *std::move(estimate), context);
  ScalePixels(gain, false, points, &solution.render);
  std::vector<double> albedo(log_albedo.size());
  for (size_t i = 0; i < albedo.size(); ++i) {
    albedo[i] = reflectance.albedo[i % 3] * std::exp(log_albedo[i]);
  }
  solution.albedo = AtPixels(setup, albedo);
  solution.gloss = AtPixels(setup, unpainted.gloss);
  return solution;
}

}  // namespace

StatusOr<Solution> SolvePainted(const SolveSetup& setup,
                                SolveContext* context) {
  PaintedPixels paint;
  paint.neighbours =
      NeighboursOf(setup.pixels.points, setup.problem->image.width);
  const FirstPaint first = FindFirstPaint(
      setup.pixels.points, setup.pixels.observed, paint.neighbours);
  paint.options.chroma_drifts = first.natural_light;
  const StatusOr<ReflectanceEstimate> found =
      EstimateReflectance(setup, context, &first);
  if (!found.ok() && found.status().code() != StatusCode::kNoImprovement) {
    return found.status();
  }
  if (!found.ok() || found->light.mode.num_texels() == 0) {
    LOG(WARNING) << "no paint was told from the light";
    return Summarise(setup, ConstantLight(setup, MeanMaterial(setup)), context);
  }
  const Unpainted reflectance = UnpaintedOf(*setup.lobes, found->lobes.data());
  std::vector<float> map;
  found->light.mode.Exp(&map);
  double began = context->Elapsed();
  StatusOr<Solution> solution =
      TakeTurn(setup, *found, reflectance, map, found->light.mode.size(), paint,
               context);
  for (int turn = 1; turn < kTurns && solution.ok(); ++turn) {
    // A turn that is cut short would undo the last.
    const double seconds = context->Elapsed() - began;
    if (context->Remaining() < kTurnMargin * seconds) break;
    began = context->Elapsed();
    const MapSize size = {solution->map.width, solution->map.height};
    StatusOr<Solution> next = TakeTurn(setup, *found, reflectance,
                                       solution->map.rgb, size, paint, context);
    if (!next.ok()) return next;
    if (next->misfit < solution->misfit) solution = std::move(next);
  }
  return solution;
}

}  // namespace ibrdf
