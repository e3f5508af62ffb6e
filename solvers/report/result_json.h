// result.json and brdf.json, the documents that other programs read. Key by
// key: docs/programs.md.
#pragma once
#include <string>

#include "ibrdf/solvers/report/material_summary.h"
#include "ibrdf/solvers/report/solved_problem.h"

namespace ibrdf {

// UTF-8 whatever the paths are. Numbers that are not finite are null.
std::string ResultJson(const SolvedProblem& solved,
                       const MaterialSummary& material);

// Needs an estimated reflectance.
std::string BrdfJson(const SolvedProblem& solved);

}  // namespace ibrdf
