// The files that the look before a solve leaves for its user.
#pragma once
#include <string>
#include <vector>

#include "ibrdf/base/status.h"
#include "ibrdf/io/problem.h"
#include "ibrdf/solvers/problem/load_object.h"

namespace ibrdf {

// What WriteCheck may write.
std::vector<std::string> CheckPaths(const std::string& folder);

// Writes check.json and check.png into `folder`, which exists, and
// check_light.png where the light is known: which directions its map stands
// for. Each whole or absent. Fails where that map cannot be read.
Status WriteCheck(const Problem& problem, const PhotographedObject& object,
                  const std::string& folder);

}  // namespace ibrdf
