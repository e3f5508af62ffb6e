// Tests of samples against a distribution.
#pragma once
#include <glog/logging.h>

#include <algorithm>
#include <cmath>
#include <cstdint>
#include <numeric>
#include <vector>

namespace ibrdf {

// Upper tail of the chi-square distribution: the regularised incomplete gamma
// function Q(degrees / 2, statistic / 2), by series or continued fraction.
inline double ChiSquareTail(double statistic, int degrees) {
  const double a = 0.5 * degrees, x = 0.5 * statistic;
  if (x <= 0.0) return 1.0;
  const double front = std::exp(a * std::log(x) - x - std::lgamma(a));
  if (x < a + 1.0) {
    double term = 1.0 / a, sum = term;
    for (int n = 1; n < 10000 && term > 1e-17 * sum; ++n) {
      term *= x / (a + n);
      sum += term;
    }
    return 1.0 - front * sum;
  }
  // Lentz's method.
  double b = x + 1.0 - a, c = 1e300, d = 1.0 / b, h = d;
  for (int n = 1; n < 10000; ++n) {
    const double an = -n * (n - a);
    b += 2.0;
    d = 1.0 / (an * d + b);
    c = b + an / c;
    h *= d * c;
    if (std::abs(d * c - 1.0) < 1e-15) break;
  }
  return front * h;
}

// Upper tail of the largest distance sup |F_n - F| of n samples (Kolmogorov's
// limit with Stephens' correction for finite n).
inline double KolmogorovTail(double distance, int64_t n) {
  const double root = std::sqrt(static_cast<double>(n));
  const double t = (root + 0.12 + 0.11 / root) * distance;
  if (t < 0.2) return 1.0;
  double sum = 0.0;
  for (int k = 1; k <= 100; ++k) {
    sum += (k % 2 == 1 ? 2.0 : -2.0) * std::exp(-2.0 * k * k * t * t);
  }
  return std::clamp(sum, 0.0, 1.0);
}

// p value of samples that should be uniform on [0, 1].
inline double UniformityPValue(std::vector<double> samples) {
  std::sort(samples.begin(), samples.end());
  const double n = static_cast<double>(samples.size());
  double distance = 0.0;
  for (size_t i = 0; i < samples.size(); ++i) {
    distance =
        std::max({distance, samples[i] - i / n, (i + 1) / n - samples[i]});
  }
  return KolmogorovTail(distance, static_cast<int64_t>(samples.size()));
}

struct ChiSquareResult {
  double statistic = 0.0;
  int degrees = 0;
  double p_value = 1.0;
};

// Pearson's test of counts against probabilities that sum to 1. Cells, in order
// of expectation, are merged until each expects at least `min_expected`.
inline ChiSquareResult ChiSquareTest(const std::vector<int64_t>& counts,
                                     const std::vector<double>& probabilities,
                                     double min_expected = 10.0) {
  CHECK_EQ(counts.size(), probabilities.size());
  const double n = static_cast<double>(
      std::accumulate(counts.begin(), counts.end(), int64_t{0}));
  std::vector<size_t> order(counts.size());
  std::iota(order.begin(), order.end(), size_t{0});
  std::stable_sort(order.begin(), order.end(), [&](size_t a, size_t b) {
    return probabilities[a] > probabilities[b];
  });
  std::vector<std::pair<double, double>> cells;  // expected, counted
  double expected = 0.0, counted = 0.0;
  for (const size_t i : order) {
    expected += n * probabilities[i];
    counted += static_cast<double>(counts[i]);
    if (expected < min_expected) continue;
    cells.emplace_back(expected, counted);
    expected = counted = 0.0;
  }
  CHECK_GT(cells.size(), 1u);
  cells.back().first += expected;
  cells.back().second += counted;
  ChiSquareResult result;
  for (const auto& [e, c] : cells) result.statistic += (c - e) * (c - e) / e;
  result.degrees = static_cast<int>(cells.size()) - 1;
  result.p_value = ChiSquareTail(result.statistic, result.degrees);
  return result;
}

}  // namespace ibrdf
