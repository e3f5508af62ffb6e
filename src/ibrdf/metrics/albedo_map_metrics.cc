#include "ibrdf/metrics/albedo_map_metrics.h"

#include <Eigen/Core>
#include <algorithm>
#include <cmath>
#include <vector>

#include "ibrdf/metrics/image_checks.h"
#include "ibrdf/metrics/image_metrics.h"

namespace ibrdf {
namespace {

constexpr int kWindow = 20, kWindowStep = 10;

bool IsAlbedo(const float* rgb) {
  return std::all_of(rgb, rgb + 3,
                     [](float v) { return v > 0.0f && std::isfinite(v); });
}

// The pixels that are compared.
Mask PixelsOfBoth(const Image& estimate, const Image& reference,
                  const Mask& mask) {
  Mask compared(reference.width, reference.height, 0);
  for (size_t p = 0; p < compared.inside.size(); ++p) {
    compared.inside[p] = mask.Holds(p) && IsAlbedo(&estimate.rgb[3 * p]) &&
                         IsAlbedo(&reference.rgb[3 * p]);
  }
  return compared;
}

double Grey(const Image& image, size_t pixel) {
  const float* rgb = &image.rgb[3 * pixel];
  return (static_cast<double>(rgb[0]) + rgb[1] + rgb[2]) / 3.0;
}

double LocalError(const Image& estimate, const Image& reference,
                  const Mask& mask) {
  double error = 0.0, all = 0.0;
  for (int top = 0; top < mask.height; top += kWindowStep) {
    for (int left = 0; left < mask.width; left += kWindowStep) {
      double ee = 0.0, er = 0.0, rr = 0.0;
      for (int y = top; y < std::min(top + kWindow, mask.height); ++y) {
        for (int x = left; x < std::min(left + kWindow, mask.width); ++x) {
          const size_t p = static_cast<size_t>(y) * mask.width + x;
          if (mask.inside[p] == 0) continue;
          const double e = Grey(estimate, p), r = Grey(reference, p);
          ee += e * e;
          er += e * r;
          rr += r * r;
        }
      }
      if (!(ee > 0.0)) continue;
      error += std::max(rr - er * er / ee, 0.0);
      all += rr;
    }
  }
  return all > 0.0 ? error / all : 0.0;
}

}  // namespace

StatusOr<AlbedoMapMetrics> CompareAlbedoMaps(const Image& estimate,
                                             const Image& reference,
                                             const Mask& mask) {
  IBRDF_RETURN_IF_ERROR(CheckSameSize(estimate, reference));
  IBRDF_RETURN_IF_ERROR(CheckMaskSize(mask, reference));
  const Mask compared = PixelsOfBoth(estimate, reference, mask);
  AlbedoMapMetrics metrics;
  Eigen::Array3d mean = Eigen::Array3d::Zero(), square = mean;
  for (size_t p = 0; p < compared.inside.size(); ++p) {
    if (compared.inside[p] == 0) continue;
    for (int c = 0; c < 3; ++c) {
      const double d = std::log(static_cast<double>(estimate.rgb[3 * p + c]) /
                                reference.rgb[3 * p + c]);
      mean[c] += d;
      square[c] += d * d;
    }
    ++metrics.pixels;
  }
  if (metrics.pixels == 0) {
    return InvalidInput("estimate",
                        "expected a pixel with an albedo > 0 in all channels "
                        "where the reference has one");
  }
  const auto count = static_cast<double>(metrics.pixels);
  mean /= count;
  square /= count;
  metrics.log_rmse = std::sqrt(square.mean());
  metrics.log_rmse_aligned =
      std::sqrt((square - mean.square()).max(0.0).mean());
  Image aligned = estimate;
  for (size_t i = 0; i < aligned.rgb.size(); ++i) {
    aligned.rgb[i] *= static_cast<float>(std::exp(-mean[i % 3]));
  }
  const StatusOr<ImageMetrics> images =
      CompareImages(aligned, reference, compared);
  if (!images.ok()) return images.status();
  metrics.psnr = images->psnr;
  metrics.dssim = images->dssim;
  metrics.lmse = LocalError(aligned, reference, compared);
  return metrics;
}

}  // namespace ibrdf
