#include "ibrdf/metrics/illumination_metrics.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <limits>

#include "ibrdf/base/pi.h"
#include "ibrdf/metrics/image_checks.h"
#include "ibrdf/metrics/log_difference.h"

namespace ibrdf {
namespace {

// Solid angle of a texel of the row but for a factor common to all rows.
double RowWeight(int row, int height) {
  return std::cos(kPi * row / height) - std::cos(kPi * (row + 1) / height);
}

}  // namespace

StatusOr<IlluminationMetrics> CompareIlluminations(const Image& estimate,
                                                   const Image& reference) {
  IBRDF_RETURN_IF_ERROR(CheckSameSize(estimate, reference));
  double largest = 0.0, smallest = std::numeric_limits<double>::infinity();
  for (size_t i = 0; i < reference.rgb.size(); ++i) {
    for (const Image* image : {&reference, &estimate}) {
      if (!std::isfinite(image->rgb[i])) {
        return InvalidInput(
            std::string(image == &reference ? "reference" : "estimate") +
                ": pixel " + PixelName(*image, i / 3),
            "expected finite radiance");
      }
    }
    const double value = std::fmax(reference.rgb[i], 0.0);
    largest = std::max(largest, value);
    smallest = std::min(smallest, value);
  }
  const double floor = kRelativeFloor * largest;
  if (!(largest > smallest)) {
    return InvalidInput("reference: range",
                        "expected a map that is not constant");
  }
  const double range = std::log(largest + floor) - std::log(smallest + floor);

  LogDifferences weighted, unweighted;
  weighted.Reserve(reference.num_pixels());
  unweighted.Reserve(reference.num_pixels());
  for (int y = 0; y < reference.height; ++y) {
    const double weight = RowWeight(y, reference.height);
    for (int x = 0; x < reference.width; ++x) {
      std::array<double, 3> difference;
      for (size_t c = 0; c < 3; ++c) {
        difference[c] =
            LogDifference(estimate.At(x, y)[c], reference.At(x, y)[c], floor);
      }
      weighted.Add(difference, weight);
      unweighted.Add(difference, 1.0);
    }
  }
  IlluminationMetrics metrics;
  metrics.relative_log_rmse = weighted.Rms(/*aligned=*/false) / range;
  metrics.relative_log_rmse_aligned = weighted.Rms(/*aligned=*/true) / range;
  metrics.relative_log_rmse_unweighted =
      unweighted.Rms(/*aligned=*/false) / range;
  return metrics;
}

}  // namespace ibrdf
