// The look before a solve, for other programs. Key by key: docs/programs.md.
#pragma once
#include <nlohmann/json.hpp>
#include <string>
#include <vector>

#include "ibrdf/solvers/photograph_check/photograph_check.h"

namespace ibrdf {

// The value of `check` in result.json. Numbers that are not known are null.
nlohmann::ordered_json CheckToJson(const PhotographCheck& check);

// check.json, with the warnings of the load; UTF-8 whatever the paths are.
std::string CheckJson(const PhotographCheck& check,
                      const std::vector<std::string>& warnings);

}  // namespace ibrdf
