// Several searches of one image, which begin differently, as one.
#pragma once
#include <vector>

#include "ibrdf/solvers/marginal/reflectance_search.h"

namespace ibrdf {

// What two searches among the same models found: of each model, in the models'
// order, the optimum of less cost, and each material's candidate of less cost.
// What a ranking found of a material stays the first search's, as costs of
// rankings of other tolerance do not compare. A search that ended at a coarser
// resolution than the other counts for nothing.
std::vector<ReflectanceSearchResult> BestOfSearches(
    std::vector<ReflectanceSearchResult> first,
    std::vector<ReflectanceSearchResult> second);

}  // namespace ibrdf
