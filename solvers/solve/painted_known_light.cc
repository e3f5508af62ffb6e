#include "ibrdf/solvers/solve/painted_known_light.h"

#include <utility>
#include <vector>

#include "ibrdf/base/pi.h"
#include "ibrdf/solvers/estimation/pixel_renders.h"
#include "ibrdf/solvers/estimation/reflectance_given_light.h"
#include "ibrdf/solvers/paint/albedo_deviation.h"
#include "ibrdf/solvers/paint/albedo_fit.h"
#include "ibrdf/solvers/paint/first_paint.h"
#include "ibrdf/solvers/solve/summary.h"
#include "ibrdf/solvers/solve/turns.h"
#include "ibrdf/solvers/solve/unpainted_object.h"

namespace ibrdf {
namespace {

constexpr int kReflectanceTurns = 3;  // of reflectance and paint
// Relative error of the gloss. Its energy was off by 3 % on one ball
// (docs/notes/paint.md); where it lies is known less well.
constexpr double kGlossError = 0.1;

// What a white matte object shows at each pixel under the known map.
std::vector<double> MatteShading(const SolveSetup& setup) {
  BrdfGrid white(setup.lobes->grid_shape());
  for (float& f : white.values) f = static_cast<float>(1.0 / kPi);
  std::vector<double> shading;
  RenderPixels(setup, setup.map_size(),
               {{{&white}, setup.known_map.data(), &shading}});
  return shading;
}

// The reflectance given what paint makes of each pixel, and the paint given
// that reflectance.
class Turn {
 public:
  Turn(const SolveSetup& setup, const std::vector<NeighbourPair>& neighbours)
      : setup_(setup), neighbours_(neighbours) {}

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
    AlbedoFitOptions options =
        InViews(UnderKnownShading(), setup_.pixels.points);
    options.gloss_error = kGlossError;
    const std::vector<double> log_albedo =
        FitAlbedo(images, neighbours_, options);
    gain_ = PaintGain(with_ambient, log_albedo);
    ScalePixels(gain_, setup_.pixels.points, &solution.render);
    SetPaint(setup_, reflectance, unpainted, log_albedo,
             AlbedoLogStd(images, neighbours_, log_albedo, options), &solution);
    return solution;
  }
  // What the paint of the last turn makes of each pixel.
  const std::vector<double>& gain() const { return gain_; }

 private:
  const SolveSetup& setup_;
  const std::vector<NeighbourPair>& neighbours_;
  std::vector<double> gain_;
};

}  // namespace

StatusOr<Solution> SolvePaintedUnderKnownLight(const SolveSetup& setup,
                                               SolveContext* context) {
  const std::vector<NeighbourPair> neighbours =
      NeighboursOf(setup.pixels.points, setup.problem->image.width);
  const std::vector<double> gain =
      MatteGain(FirstPaintUnder(setup.pixels.points, setup.pixels.observed,
                                neighbours, MatteShading(setup)));
  Turn turn(setup, neighbours);
  Turns turns(kReflectanceTurns, context);
  StatusOr<Solution> solution = turn.Take(gain, context);
  while (solution.ok() && turns.Another()) {
    StatusOr<Solution> next = turn.Take(turn.gain(), context);
    if (!next.ok()) return next;
    solution = std::move(next);
  }
  if (solution.ok()) solution->seconds = context->Elapsed();
  return solution;
}

}  // namespace ibrdf
