#include "ibrdf/metrics/image_metrics.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <limits>
#include <vector>

#include "ibrdf/metrics/image_checks.h"
#include "ibrdf/metrics/log_difference.h"

namespace ibrdf {
namespace {

constexpr int kWindowRadius = 5;
constexpr double kWindowSigma = 1.5;

// 1 where a pixel is compared, else 0.
StatusOr<std::vector<double>> Compared(const Image& estimate,
                                       const Image& reference,
                                       const Mask& mask) {
  IBRDF_RETURN_IF_ERROR(CheckSameSize(estimate, reference));
  IBRDF_RETURN_IF_ERROR(CheckMaskSize(mask, reference));
  std::vector<double> compared(reference.num_pixels(), 0.0);
  const auto finite = [](const Image& image, size_t i) {
    return std::isfinite(image.rgb[3 * i]) &&
           std::isfinite(image.rgb[3 * i + 1]) &&
           std::isfinite(image.rgb[3 * i + 2]);
  };
  bool any = false;
  for (size_t i = 0; i < compared.size(); ++i) {
    if (!mask.empty() && mask.inside[i] == 0) continue;
    if (!finite(reference, i)) continue;
    if (!finite(estimate, i)) {
      return InvalidInput("estimate: pixel " + PixelName(estimate, i),
                          "expected finite radiance");
    }
    compared[i] = 1.0;
    any = true;
  }
  if (!any) {
    return InvalidInput(mask.empty() ? "reference" : "mask",
                        "expected at least one finite pixel to compare");
  }
  return compared;
}

// Separable Gaussian, zero outside the image.
std::vector<double> Blur(const std::vector<double>& values, int width,
                         int height) {
  std::array<double, 2 * kWindowRadius + 1> window;
  for (int k = -kWindowRadius; k <= kWindowRadius; ++k) {
    window[k + kWindowRadius] =
        std::exp(-0.5 * k * k / (kWindowSigma * kWindowSigma));
  }
  const auto pass = [&](const std::vector<double>& in, int dx, int dy) {
    std::vector<double> out(in.size(), 0.0);
    for (int y = 0; y < height; ++y) {
      for (int x = 0; x < width; ++x) {
        double sum = 0.0;
        for (int k = -kWindowRadius; k <= kWindowRadius; ++k) {
          const int u = x + k * dx, v = y + k * dy;
          if (u < 0 || u >= width || v < 0 || v >= height) continue;
          sum += window[k + kWindowRadius] *
                 in[static_cast<size_t>(v) * width + u];
        }
        out[static_cast<size_t>(y) * width + x] = sum;
      }
    }
    return out;
  };
  return pass(pass(values, 1, 0), 0, 1);
}

// Sum of SSIM over the compared pixels of one channel; a and b are 0 elsewhere.
double SumSsim(const std::vector<double>& a, const std::vector<double>& b,
               const std::vector<double>& compared,
               const std::vector<double>& weights, int width, int height,
               double range) {
  const auto blurred_product = [&](const std::vector<double>& u,
                                   const std::vector<double>& v) {
    std::vector<double> product(u.size());
    for (size_t i = 0; i < u.size(); ++i) product[i] = u[i] * v[i];
    return Blur(product, width, height);
  };
  const std::vector<double> mean_a = Blur(a, width, height);
  const std::vector<double> mean_b = Blur(b, width, height);
  const std::vector<double> aa = blurred_product(a, a);
  const std::vector<double> bb = blurred_product(b, b);
  const std::vector<double> ab = blurred_product(a, b);
  const double c1 = 0.01 * range * 0.01 * range;
  const double c2 = 0.03 * range * 0.03 * range;
  double sum = 0.0;
  for (size_t i = 0; i < a.size(); ++i) {
    if (compared[i] == 0.0) continue;
    const double w = weights[i];
    const double ma = mean_a[i] / w, mb = mean_b[i] / w;
    const double variance_a = std::max(aa[i] / w - ma * ma, 0.0);
    const double variance_b = std::max(bb[i] / w - mb * mb, 0.0);
    const double covariance = ab[i] / w - ma * mb;
    // Wang et al. 2004, Eq. 13.
    sum += (2 * ma * mb + c1) * (2 * covariance + c2) /
           ((ma * ma + mb * mb + c1) * (variance_a + variance_b + c2));
  }
  return sum;
}

double Dssim(const Image& estimate, const Image& reference,
             const std::vector<double>& compared, int64_t pixels,
             double largest) {
  const int width = reference.width, height = reference.height;
  const std::vector<double> weights = Blur(compared, width, height);
  std::vector<double> a(compared.size()), b(compared.size());
  double sum = 0.0;
  for (size_t c = 0; c < 3; ++c) {
    for (size_t i = 0; i < compared.size(); ++i) {
      const bool use = compared[i] != 0.0;
      a[i] = use ? std::log1p(std::fmax(estimate.rgb[3 * i + c], 0.0)) : 0.0;
      b[i] = use ? std::log1p(std::fmax(reference.rgb[3 * i + c], 0.0)) : 0.0;
    }
    sum += SumSsim(a, b, compared, weights, width, height, std::log1p(largest));
  }
  return std::clamp(0.5 * (1.0 - sum / (3.0 * pixels)), 0.0, 1.0);
}

}  // namespace

StatusOr<ImageMetrics> CompareImages(const Image& estimate,
                                     const Image& reference, const Mask& mask) {
  const StatusOr<std::vector<double>> compared =
      Compared(estimate, reference, mask);
  if (!compared.ok()) return compared.status();
  double largest = 0.0, dot_er = 0.0, dot_ee = 0.0;
  ImageMetrics metrics;
  for (size_t i = 0; i < compared->size(); ++i) {
    if ((*compared)[i] == 0.0) continue;
    ++metrics.pixels;
    for (size_t k = 3 * i; k < 3 * i + 3; ++k) {
      const double e = estimate.rgb[k], r = reference.rgb[k];
      largest = std::max(largest, r);
      dot_er += e * r;
      dot_ee += e * e;
    }
  }
  if (!(largest > 0.0)) {
    return InvalidInput("reference", "expected a positive pixel to compare");
  }
  const double scale = dot_ee > 0.0 ? std::max(dot_er / dot_ee, 0.0) : 0.0;

  LogDifferences differences;
  double squares = 0.0, magnitudes = 0.0;
  for (size_t i = 0; i < compared->size(); ++i) {
    if ((*compared)[i] == 0.0) continue;
    std::array<double, 3> difference;
    for (size_t c = 0; c < 3; ++c) {
      const double e = estimate.rgb[3 * i + c], r = reference.rgb[3 * i + c];
      difference[c] = LogDifference(e, r, kRelativeFloor * largest);
      squares += (scale * e - r) * (scale * e - r);
      magnitudes += std::abs(difference[c]);
    }
    differences.Add(difference, 1.0);
  }
  metrics.log_rmse = differences.Rms(/*aligned=*/false);
  metrics.mean_abs_log =
      magnitudes / (3.0 * static_cast<double>(metrics.pixels));
  const double mean_square =
      squares / (3.0 * static_cast<double>(metrics.pixels));
  metrics.psnr = mean_square > 0.0
                     ? 10.0 * std::log10(largest * largest / mean_square)
                     : std::numeric_limits<double>::infinity();
  metrics.dssim =
      Dssim(estimate, reference, *compared, metrics.pixels, largest);
  return metrics;
}

}  // namespace ibrdf
