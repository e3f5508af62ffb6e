// Outer iterations of scale continuation: steps at a scale b of the likelihood
// that falls with the misfit.
#pragma once
#include <limits>
#include <string>

#include "ibrdf/base/status.h"
#include "ibrdf/solvers/estimation/posterior.h"
#include "ibrdf/solvers/estimation/solve_context.h"
#include "ibrdf/solvers/estimation/solve_setup.h"
#include "ibrdf/solvers/joint/joint_method.h"

namespace ibrdf {

struct OuterIterationOptions {
  std::string stage;  // for the trace
  JointMethod method = JointMethod::kGaussNewton;
  JointBlocks blocks = JointBlocks::kLight;  // that move
  double share = 1.0;  // of the time that remains, at most
  // > 0: a result is of no use above this misfit, and the iterations end once
  // it is out of reach in the time that remains.
  double most_misfit = 0.0;
  // Numbers of the first and the last iteration.
  int first = 1;
  int last = std::numeric_limits<int>::max();
};

// Lowers the posterior's cost over the blocks until a share of the time is
// spent or an iteration gains less than the tolerance. Where both blocks move,
// the scale ambiguity is settled after each iteration. Returns whether it ended
// for options.last alone, so that more iterations would gain more. Those that
// begin with the next number then are as if there had been no end.
StatusOr<bool> RunOuterIterations(const OuterIterationOptions& options,
                                  const SolveSetup& setup,
                                  ObservedPixels* pixels, SolveContext* context,
                                  Iterate* iterate);

// The scale of the next iteration. The Laplacian's maximum-likelihood scale is
// the mean magnitude of the residuals, the misfit. It only falls, and not at
// once: with a small scale too early the robust loss holds on to wrong pixels.
double NextScale(const SolveSetup& setup, double scale, double misfit);

// Whether another iteration is not worth its time.
bool Settled(const SolveSetup& setup, double scale, const TraceEntry& before,
             const TraceEntry& after);

}  // namespace ibrdf
