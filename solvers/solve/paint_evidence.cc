#include "ibrdf/solvers/solve/paint_evidence.h"

#include <glog/logging.h>

#include "ibrdf/solvers/estimation/marginal_search.h"

namespace ibrdf {
namespace {

// Nats. A mirror shows more of the world than the coarse resolution holds, and
// that looks like paint: on four mirrors of rooms and woods up to 133. Painted
// balls had 226 and more (docs/notes/paint.md).
constexpr double kLeastEvidence = 180.0;
constexpr double kUnexplained = 0.1;  // misfit

}  // namespace

bool IsProbablyPainted(const SolveSetup& setup, SolveContext* context) {
  const PaintPrior paint;
  const double evidence =
      CoarseEvidence(setup, context) - CoarseEvidence(setup, context, &paint);
  VLOG(1) << "paint is more probable than one material by " << evidence
          << " nats";
  return evidence > kLeastEvidence;
}

bool LeavesPaint(const SolveSetup& setup, const Estimate& one_material,
                 const SolveContext& context) {
  return Evaluate("one material", setup, context, one_material.iterate,
                  one_material.pixels.get())
             .misfit > kUnexplained;
}

}  // namespace ibrdf
