// How finely the normals of each of several views are binned.
#pragma once
#include <cstddef>

namespace ibrdf {

// Bins across the disc of a view's normals, at least 4, of an estimate that
// takes `of_one` across that of one photograph. Several views have more bins
// together than one has, by the square root of their number at most: costs that
// grow with the square or the cube of the bins stay bounded, and views from
// elsewhere say more than finer bins of one.
int BinsAcrossView(int of_one, size_t num_views);

}  // namespace ibrdf
