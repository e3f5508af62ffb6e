#include "ibrdf/solvers/estimation/view_bins.h"

#include <algorithm>
#include <cmath>
#include <cstdlib>

namespace ibrdf {

int BinsAcrossView(int of_one, size_t num_views) {
  if (num_views < 2) return of_one;
  static const double power =
      getenv("VIEW_POWER") ? atof(getenv("VIEW_POWER")) : 0.5;
  const double share = std::pow(static_cast<double>(num_views), -power);
  return std::max(4, static_cast<int>(std::lround(of_one * share)));
}

}  // namespace ibrdf
