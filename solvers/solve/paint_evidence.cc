#include "ibrdf/solvers/solve/paint_evidence.h"

#include <glog/logging.h>

#include "ibrdf/solvers/estimation/marginal_search.h"
#include "ibrdf/solvers/estimation/reflectance_given_light.h"

namespace ibrdf {
namespace {

// Nats. A mirror shows more of the world than the coarse resolution holds, and
// that looks like paint: on four mirrors of rooms and woods up to 133. Painted
// balls had 226 and more (docs/notes/paint.md).
constexpr double kLeastEvidence = 180.0;
constexpr double kUnexplained = 0.1;  // misfit

}  // namespace

bool IsProbablyPainted(const SolveSetup& setup, SolveContext* context) {
  if (!setup.light_unknown()) {
    const Estimate one = EstimateReflectanceGivenLight(setup, context);
    return Evaluate("one material", setup, *context, one.iterate,
                    one.pixels.get())
               .misfit > kUnexplained;
  }
  const PaintPrior paint;
  const double evidence =
      CoarseEvidence(setup, context) - CoarseEvidence(setup, context, &paint);
  VLOG(1) << "paint is more probable than one material by " << evidence
          << " nats";
  return evidence > kLeastEvidence;
}

}  // namespace ibrdf
