// How far an estimated BRDF table is from a reference.
#pragma once
#include <cstdint>

#include "ibrdf/base/status.h"
#include "ibrdf/brdf/merl_table.h"

namespace ibrdf {

// Root mean squares of log(max(t, 0) + 1e-6) - log(max(r, 0) + 1e-6), natural
// logarithm, raw units, t the estimate and r the reference, over the three
// channels and the bins where the reference's red value is > 0.
struct BrdfMetrics {
  double log_rmse = 0.0;
  // The mean difference of each channel taken off first: the best scale per
  // channel but for the floor, which is not scaled.
  double log_rmse_aligned = 0.0;
  // As they are, over the bins whose centre has both directions within 80
  // degrees of the normal; NaN where the reference has no such bin.
  double log_rmse_below80 = 0.0;
  // The mean differences over those bins taken off first.
  double log_rmse_aligned_below80 = 0.0;
  int64_t bins = 0;
  int64_t bins_below80 = 0;
};

// Whether both directions of the bin's centre are within 80 degrees of the
// normal.
bool MerlBinBelow80(int theta_h, int theta_d, int phi_d);

// Refuses a reference without a positive red value and non-finite values. The
// message starts with "reference" or "estimate". Both tables are complete.
StatusOr<BrdfMetrics> CompareBrdfs(const MerlTable& estimate,
                                   const MerlTable& reference);

}  // namespace ibrdf
