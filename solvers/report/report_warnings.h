// What a reader should know before trusting a result.
#pragma once
#include <string>
#include <vector>

#include "ibrdf/solvers/report/solved_problem.h"

namespace ibrdf {

// Sentences; none: nothing stands out.
std::vector<std::string> ResultWarnings(const SolvedProblem& solved);

}  // namespace ibrdf
