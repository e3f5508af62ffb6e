// How far two labellings say the same, whatever their labels are called.
#pragma once
#include "ibrdf/solvers/segmentation/region_merging.h"

namespace ibrdf {

// The largest share of the pixels that have the same label once those of one
// are renamed, each to another, in [0, 1]. Labellings of the same pixels, all
// labels >= 0; at most 8 materials each.
double Agreement(const Labelling& a, const Labelling& b);

}  // namespace ibrdf
