// The reference of problem files, as ibrdf_solve --keys prints it and as
// docs/problem_file.md has it.
#pragma once
#include <string>

#include "ibrdf/io/problem_schema.h"

namespace ibrdf {

// Markdown. Links are relative to docs/.
std::string ProblemReference(const ProblemSchema& schema);

// The two files at its top. The first is a joint problem with every key that
// such a problem can have beside the others, at its default where it has one.
std::string ExampleProblem(const ProblemSchema& schema);
std::string ExampleScene();

}  // namespace ibrdf
