#include "ibrdf/solvers/estimation/view_bins.h"

#include <algorithm>
#include <cmath>

namespace ibrdf {
namespace {

// With 4 across, materials were ranked wrongly: the estimate of four views of
// experiments/several_views ended in a false optimum.
constexpr int kFewest = 6;

}  // namespace

int BinsAcrossView(int of_one, size_t num_views) {
  if (num_views < 2) return of_one;
  return std::max(kFewest,
                  static_cast<int>(std::lround(
                      of_one / std::sqrt(static_cast<double>(num_views)))));
}

}  // namespace ibrdf
