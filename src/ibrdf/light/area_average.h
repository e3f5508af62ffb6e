// Resampling of maps by the areas that texels share.
#pragma once
#include <vector>

#include "ibrdf/image/image.h"

namespace ibrdf {

// The part of an interval that lies in another, `source`.
struct IntervalPart {
  int source;
  double length;
};

// Texel (r, c) is the mean of the map's texels over rows[r] x columns[c], by
// length times length.
Image AverageByArea(const Image& map,
                    const std::vector<std::vector<IntervalPart>>& rows,
                    const std::vector<std::vector<IntervalPart>>& columns,
                    int num_threads);

}  // namespace ibrdf
