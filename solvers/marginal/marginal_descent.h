// Gauss-Newton descent on the marginal posterior of a reflectance.
#pragma once
#include <functional>
#include <vector>

#include "ibrdf/solvers/marginal/marginal_objective.h"

namespace ibrdf {

struct MarginalDescentOptions {
  int max_iterations = 12;
  // Ends where two steps in a row gain less, nats, and promised little more.
  double least_gain = 0.05;
  // Checked before each iteration; true ends with the best so far.
  std::function<bool()> should_stop;
};

struct MarginalDescent {
  bool ok = false;  // false: no value at the start, y is as it was
  double cost = 0.0;
  int iterations = 0;
};

// Lowers the objective from y, which receives the lowest point. Each direction
// is that of MarginalObjective::Information at its point; how far to go along
// it, a line search tells, as the log determinant is not in it. The cost has
// curved valleys whose narrow sides it knows: quasi-Newton methods, which have
// to learn them, need two to three times as many evaluations.
MarginalDescent Descend(const MarginalObjective& objective,
                        const MarginalDescentOptions& options,
                        std::vector<double>* y);

}  // namespace ibrdf
