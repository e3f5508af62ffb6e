// Results of photographs of one view, each under its own light.
#pragma once
#include <string>
#include <vector>

#include "ibrdf/base/status.h"
#include "ibrdf/solvers/report/solved_problem.h"

namespace ibrdf {

// The folder of the k-th photograph beside the first: folder/images/2 of k = 0.
std::string PhotographFolder(const std::string& folder, size_t k);

// What WriteOtherLights may write for those from `begin` to before `end`.
std::vector<std::string> OtherLightPaths(size_t begin, size_t end,
                                         const std::string& folder);

// Writes illumination.exr, render.exr, residual.exr and the pictures of them
// (WriteResultPreviews) of each photograph beside the first.
Status WriteOtherLights(const SolvedProblem& solved, const std::string& folder);

// Those that fit far worse than the first, with their misfits, in words; empty:
// none does. They may be of another view.
std::string OddPhotographs(const SolvedProblem& solved);

}  // namespace ibrdf
