// What a reader should know before trusting a result.
#pragma once
#include <string>
#include <vector>

#include "ibrdf/solvers/report/solved_problem.h"

namespace ibrdf {

// Sentences, those of the inputs first; none: nothing stands out.
std::vector<std::string> ResultWarnings(const SolvedProblem& solved);

// What the report adds where no shadows were simulated; empty for a sphere,
// which is convex.
std::string EffectsNote(const SolvedProblem& solved);

}  // namespace ibrdf
