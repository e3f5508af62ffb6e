#include "ibrdf/solvers/solve/painted_known_light.h"

#include <utility>
#include <vector>

#include "ibrdf/solvers/estimation/reflectance_given_light.h"
#include "ibrdf/solvers/paint/albedo_deviation.h"
#include "ibrdf/solvers/paint/albedo_fit.h"
#include "ibrdf/solvers/paint/first_paint.h"
#include "ibrdf/solvers/solve/residual_statistics.h"
#include "ibrdf/solvers/solve/summary.h"
#include "ibrdf/solvers/solve/turns.h"
#include "ibrdf/solvers/solve/unpainted_object.h"

namespace ibrdf {
namespace {

constexpr int kReflectanceTurns = 3;  // of reflectance and paint
// Misfit that neighbours share (ResidualStatistics). Balls with sharp edges of
// paint were left with 0.005 to 0.011 of it, those with wood and fading paint
// with 0.03 to 0.26 (docs/notes/paint.md).
constexpr double kUnexplainedByEdges = 0.02;
// Relative error of the gloss. Its energy was off by 3 % on one ball
// (docs/notes/paint.md); where it lies is known less well.
constexpr double kGlossError = 0.1;

// What the turns leave of the paint apart from light: its edges alone, or all.
struct PaintCues {
  AlbedoFitOptions first, later;
};

// The reflectance given what paint makes of each pixel, and the paint given
// that reflectance.
class Turn {
 public:
  Turn(const SolveSetup& setup, const std::vector<NeighbourPair>& neighbours,
       const AlbedoFitOptions& options)
      : setup_(setup), neighbours_(neighbours), options_(options) {
    options_ = InViews(options_, setup.pixels.points);
    options_.gloss_error = kGlossError;
  }

  StatusOr<Solution> Take(const std::vector<double>& gain,
                          SolveContext* context) {
    const InverseProblem without =
        WithoutPaint(*setup_.problem, gain, setup_.pixels.points);
    const StatusOr<SolveSetup> of_lobes = SetUp(without);
    if (!of_lobes.ok()) return of_lobes.status();
    Solution solution = Summarise(
        *of_lobes, EstimateReflectanceGivenLight(*of_lobes, context), context);
    const UnpaintedReflectance reflectance =
        UnpaintedOf(*setup_.lobes, solution.lobe_parameters.data());
    const UnpaintedRadiance unpainted = RenderUnpainted(
        setup_, reflectance, setup_.known_map, setup_.map_size());
    UnpaintedRadiance with_ambient = unpainted;
    for (size_t i = 0; i < with_ambient.gloss.size(); ++i) {
      with_ambient.gloss[i] += solution.ambient[i % 3];
    }
    const std::vector<PaintedImage> images = {
        {&with_ambient, &setup_.pixels.observed}};
    const std::vector<double> log_albedo =
        FitAlbedo(images, neighbours_, options_);
    gain_ = PaintGain(with_ambient, log_albedo);
    ScalePixels(gain_, setup_.pixels.points, &solution.render);
    SetPaint(setup_, reflectance, unpainted, log_albedo,
             AlbedoLogStd(images, neighbours_, log_albedo, options_),
             &solution);
    return solution;
  }
  // What the paint of the last turn makes of each pixel.
  const std::vector<double>& gain() const { return gain_; }

 private:
  const SolveSetup& setup_;
  const std::vector<NeighbourPair>& neighbours_;
  AlbedoFitOptions options_;
  std::vector<double> gain_;
};

StatusOr<Solution> SolveBy(const PaintCues& cues, const SolveSetup& setup,
                           const std::vector<NeighbourPair>& neighbours,
                           const std::vector<double>& matte_shading,
                           SolveContext* context) {
  const std::vector<double> gain =
      MatteGain(FirstPaintUnder(setup.pixels.points, setup.pixels.observed,
                                neighbours, cues.first, matte_shading));
  Turn turn(setup, neighbours, cues.later);
  Turns turns(kReflectanceTurns, context);
  StatusOr<Solution> solution = turn.Take(gain, context);
  while (solution.ok() && turns.Another()) {
    StatusOr<Solution> next = turn.Take(turn.gain(), context);
    if (!next.ok()) return next;
    solution = std::move(next);
  }
  return solution;
}

bool EdgesExplain(const SolveSetup& setup, const Solution& solution) {
  return ResidualStatisticsOf(setup, solution.render).Structured() <
         kUnexplainedByEdges;
}

}  // namespace

StatusOr<Solution> SolvePaintedUnderKnownLight(const SolveSetup& setup,
                                               SolveContext* context) {
  const std::vector<NeighbourPair> neighbours =
      NeighboursOf(setup.pixels.points, setup.problem->image.width);
  const std::vector<double> shading = MatteShading(setup);
  const double began = context->Elapsed();
  StatusOr<Solution> solution =
      SolveBy({AlbedoFitOptions(), UnderKnownShading()}, setup, neighbours,
              shading, context);
  if (solution.ok() && !EdgesExplain(setup, *solution) &&
      context->IterationsLeft() &&
      context->Remaining() > context->Elapsed() - began) {
    solution = SolveBy({OfPaintThatFades(), OfPaintThatFades()}, setup,
                       neighbours, shading, context);
  }
  if (solution.ok()) solution->seconds = context->Elapsed();
  return solution;
}

}  // namespace ibrdf
