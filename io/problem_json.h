// Problem -> JSON, for result.json; and as a list, for the report.
#pragma once
#include <nlohmann/json.hpp>
#include <string>
#include <vector>

#include "ibrdf/io/problem.h"

namespace ibrdf {

// The problem as resolved, with the keys of the problem file, defaults filled
// in and paths resolved. Keys that do not apply to the problem are left out;
// automatic choices are "auto".
nlohmann::json ProblemToJson(const Problem& problem);

struct ProblemSetting {
  std::string key;  // as --set names it, e.g. "solver.seconds"
  std::string value;
};

// One for each leaf of ProblemToJson, in its order.
std::vector<ProblemSetting> ListSettings(const Problem& problem);

}  // namespace ibrdf
