// result.json of a map of uncertainty.
#pragma once
#include <string>

#include "ibrdf/io/problem.h"
#include "ibrdf/solvers/uncertainty_map/map_uncertainty.h"

namespace ibrdf {

// UTF-8, with a line feed at the end.
std::string UncertaintyJsonText(const Problem& problem,
                                const UncertaintyOptions& options,
                                const UncertaintyResult& result);

}  // namespace ibrdf
