#include "ibrdf/solvers/solve/paint_evidence.h"

#include <glog/logging.h>

#include <cmath>

#include "ibrdf/solvers/estimation/marginal_search.h"
#include "ibrdf/solvers/solve/mirrored_light.h"
#include "ibrdf/solvers/solve/residual_statistics.h"
#include "ibrdf/solvers/solve/unpainted_object.h"

namespace ibrdf {
namespace {

// Nats. A mirror shows more of the world than the coarse resolution holds, and
// that looks like paint: on four mirrors of rooms and woods up to 133. Painted
// balls had 226 and more (docs/notes/paint.md).
constexpr double kLeastEvidence = 180.0;
constexpr double kUnexplained = 0.1;  // misfit
// Paint scales what is matte as each pixel wants it. What it leaves of a
// painted ball was a fifth of what one material left, or less.
constexpr double kMostLeftByPaint = 0.5;

// In the mean over pixels and channels.
double MatteShare(const SolveSetup& setup, const std::vector<double>& lobes) {
  const UnpaintedRadiance radiance =
      RenderUnpainted(setup, UnpaintedOf(*setup.lobes, lobes.data()),
                      setup.known_map, setup.map_size());
  double sum = 0.0;
  for (size_t i = 0; i < radiance.matte.size(); ++i) {
    const double whole = radiance.matte[i] + radiance.gloss[i];
    if (whole > 0.0) sum += radiance.matte[i] / whole;
  }
  return sum / static_cast<double>(radiance.matte.size());
}

}  // namespace

bool IsProbablyPainted(const SolveSetup& setup, SolveContext* context) {
  const PaintPrior paint;
  const double evidence =
      CoarseEvidence(setup, context) - CoarseEvidence(setup, context, &paint);
  VLOG(1) << "paint is more probable than one material by " << evidence
          << " nats";
  return evidence > kLeastEvidence;
}

bool LeftByOneMaterial::IsMuch() const { return misfit > kUnexplained; }

bool LeftByOneMaterial::MayBePaint() const {
  return misfit * std::sqrt(1.0 - mirrored) > kUnexplained &&
         matte > PaintPrior().least_matte_share;
}

bool LeftByOneMaterial::IsExplainedBy(double painted_misfit) const {
  return painted_misfit < kMostLeftByPaint * misfit;
}

LeftByOneMaterial LeftBy(const SolveSetup& setup, const Estimate& one_material,
                         const SolveContext& context) {
  LeftByOneMaterial left;
  left.misfit = Evaluate("one material", setup, context, one_material.iterate,
                         one_material.pixels.get())
                    .misfit;
  if (!left.IsMuch()) return left;
  const InverseProblem& problem = *setup.problem;
  left.mirrored =
      MirroredShare(problem.fine_known_map != nullptr ? *problem.fine_known_map
                                                      : *problem.known_map,
                    setup.pixels.points, problem.image.width,
                    ResidualRowsOf(setup, one_material));
  left.matte = MatteShare(setup, one_material.iterate.state.lobes);
  VLOG(1) << "one material leaves " << left.misfit << ", of which "
          << left.mirrored << " is mirrored light; " << left.matte
          << " of it is matte";
  return left;
}

}  // namespace ibrdf
