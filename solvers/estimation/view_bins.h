// How finely the normals of each of several views are binned.
#pragma once
#include <cstddef>

namespace ibrdf {

// Bins across the disc of a view's normals of an estimate that takes `of_one`
// across that of one photograph: as many bins of all views together as of one,
// but not so few that a view's highlight is lost among them. Costs grow with
// the square or the cube of the bins, and another view says more than finer
// bins of one.
int BinsAcrossView(int of_one, size_t num_views);

}  // namespace ibrdf
