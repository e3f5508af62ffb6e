// A reflectance of another kind than the one that a search chose.
#pragma once
#include <optional>

#include "ibrdf/base/status.h"
#include "ibrdf/solvers/estimation/light_given_reflectance.h"
#include "ibrdf/solvers/estimation/marginal_search.h"
#include "ibrdf/solvers/estimation/posterior.h"
#include "ibrdf/solvers/estimation/solve_context.h"

namespace ibrdf {

// The first bins of a search are coarse, and a mirror in a smooth light costs
// as much there as a coat in a rough one: it may be given up. A map of 64x32
// tells them apart. The estimate and the few best of the search's coarse
// optima, of those that are far from it and from each other, are held while
// such a map is found, and compared by EvidenceOfMap. Returns the best if it is
// another than the estimate by more than doubt, with its map and light; else
// nothing, as where little of the time is left or the object throws shadows.
// found: what the search found with the model of the estimate's lobes.
StatusOr<std::optional<RevisedReflectance>> FindOtherKind(
    const ModelOptima& found, const Estimate& estimate, SolveContext* context);

}  // namespace ibrdf
