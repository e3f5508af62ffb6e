#include "ibrdf/metrics/brdf_metrics.h"

#include <glog/logging.h>

#include <cmath>
#include <limits>

#include "ibrdf/base/pi.h"
#include "ibrdf/metrics/log_difference.h"

namespace ibrdf {
namespace {

constexpr double kFloor = 1e-6;  // raw units
constexpr size_t kEntries = size_t{3} * kMerlBins;

}  // namespace

bool MerlBinBelow80(int theta_h, int theta_d, int phi_d) {
  static const double kCos80 = std::cos(80.0 / 180.0 * kPi);
  return MerlBinLowestCosine(theta_h, theta_d, phi_d) >= kCos80;
}

StatusOr<BrdfMetrics> CompareBrdfs(const MerlTable& estimate,
                                   const MerlTable& reference) {
  CHECK_EQ(kEntries, estimate.raw.size());
  CHECK_EQ(kEntries, reference.raw.size());
  BrdfMetrics metrics;
  LogDifferences all, below80;
  for (int h = 0; h < kMerlThetaH; ++h) {
    for (int d = 0; d < kMerlThetaD; ++d) {
      for (int p = 0; p < kMerlPhiD; ++p) {
        const int bin = MerlTable::Bin(h, d, p);
        std::array<double, 3> difference;
        for (int c = 0; c < 3; ++c) {
          const double t = estimate.Raw(c, bin), r = reference.Raw(c, bin);
          if (!std::isfinite(t) || !std::isfinite(r)) {
            return InvalidInput(
                std::string(std::isfinite(r) ? "estimate" : "reference") +
                    ": bin " + std::to_string(bin),
                "expected finite values");
          }
        }
        if (!(reference.Raw(0, bin) > 0.0)) continue;
        for (int c = 0; c < 3; ++c) {
          difference[c] = LogDifference(estimate.Raw(c, bin),
                                        reference.Raw(c, bin), kFloor);
        }
        all.Add(difference, 1.0);
        ++metrics.bins;
        if (MerlBinBelow80(h, d, p)) {
          below80.Add(difference, 1.0);
          ++metrics.bins_below80;
        }
      }
    }
  }
  if (all.empty()) {
    return InvalidInput("reference: red",
                        "expected a bin with a positive value");
  }
  metrics.log_rmse = all.Rms(/*aligned=*/false);
  metrics.log_rmse_aligned = all.Rms(/*aligned=*/true);
  if (below80.empty()) {
    metrics.log_rmse_below80 = metrics.log_rmse_aligned_below80 =
        std::numeric_limits<double>::quiet_NaN();
  } else {
    metrics.log_rmse_below80 = below80.Rms(/*aligned=*/false);
    metrics.log_rmse_aligned_below80 = below80.Rms(/*aligned=*/true);
  }
  return metrics;
}

}  // namespace ibrdf
