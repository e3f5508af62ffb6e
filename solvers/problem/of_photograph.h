// One of several photographs of a view by itself.
#pragma once
#include <cstddef>

#include "ibrdf/solvers/problem/inverse_problem.h"

namespace ibrdf {

// The problem with the image of other_photographs[k], < their number, and
// without the rest.
InverseProblem OfPhotograph(const InverseProblem& problem, size_t k);

}  // namespace ibrdf
