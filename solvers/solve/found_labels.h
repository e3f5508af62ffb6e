// Labels of materials where nobody gave them.
#pragma once
#include "ibrdf/solvers/estimation/solution.h"
#include "ibrdf/solvers/estimation/solve_context.h"
#include "ibrdf/solvers/problem/inverse_problem.h"

namespace ibrdf {

// The materials of an unlabelled problem's points: labels that the photograph
// alone proposes (ProposeLabels), of as many materials as make the image more
// probable (LabelEvidence). It begins with one; another is added while the best
// proposal of as many gains enough. Takes a part of the time that remains at
// most, and then has the best so far.
FoundLabels FindLabels(const InverseProblem& problem, SolveContext* context);

}  // namespace ibrdf
