#include "ibrdf/solvers/optim/line_search.h"

#include <algorithm>
#include <cmath>

namespace ibrdf {

double LineSearch(double longest, double shortest, double slope,
                  const std::function<LineSearchTrial(double)>& trial) {
  double length = longest;
  while (length > shortest) {
    const LineSearchTrial found = trial(length);
    if (found.accepted) return length;
    const double lowest =
        std::isfinite(found.gain)
            ? 0.5 * length * length * slope / (length * slope - found.gain)
            : 0.0;
    length = std::clamp(lowest, 0.1 * length, 0.5 * length);
  }
  return 0.0;
}

}  // namespace ibrdf
