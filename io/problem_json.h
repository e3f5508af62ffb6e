// Problem -> JSON, for result.json.
#pragma once
#include <nlohmann/json.hpp>

#include "ibrdf/io/problem.h"

namespace ibrdf {

// The problem as resolved, with the keys of the problem file, defaults filled
// in and paths resolved. Keys that do not apply to the problem are left out;
// automatic choices are "auto".
nlohmann::json ProblemToJson(const Problem& problem);

}  // namespace ibrdf
