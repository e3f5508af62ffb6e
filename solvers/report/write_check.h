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

// Writes check.json and check.png into `folder`, which exists; each whole or
// absent.
Status WriteCheck(const Problem& problem, const PhotographedObject& object,
                  const std::string& folder);

}  // namespace ibrdf
