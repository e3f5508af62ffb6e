#include "ibrdf/metrics/brdf_metrics.h"

#include <gtest/gtest.h>

#include <cmath>
#include <limits>
#include <random>

#include "ibrdf/base/pi.h"

namespace ibrdf {
namespace {

// Rounding of a sum of four million terms.
constexpr double kBrdfSumTolerance = 1e-10;
// Effect of the floor 1e-6 on values of at least 1 scaled by at most 8.
constexpr double kBrdfFloorTolerance = 1e-5;

MerlTable RandomTable(uint32_t seed) {
  std::mt19937 rng(seed);
  std::uniform_real_distribution<double> exponent(0.0, 5.0);
  MerlTable table;
  table.raw.resize(size_t{3} * kMerlBins);
  for (double& v : table.raw) v = std::exp(exponent(rng));
  return table;
}

TEST(BrdfMetrics, SameTablesDifferByNothing) {
  const MerlTable table = RandomTable(1);
  const BrdfMetrics m = CompareBrdfs(table, table).value();
  EXPECT_EQ(0.0, m.log_rmse);
  EXPECT_EQ(0.0, m.log_rmse_aligned);
  EXPECT_EQ(0.0, m.log_rmse_below80);
  EXPECT_EQ(0.0, m.log_rmse_aligned_below80);
  EXPECT_EQ(kMerlBins, m.bins);
}

TEST(BrdfMetrics, ScalesPerChannelAreAlignedAway) {
  const MerlTable reference = RandomTable(2);
  MerlTable estimate = reference;
  const double scales[3] = {2.0, 0.25, 8.0};
  double squares = 0.0;
  for (int c = 0; c < 3; ++c) {
    squares += std::log(scales[c]) * std::log(scales[c]);
    for (int b = 0; b < kMerlBins; ++b) {
      estimate.raw[size_t(c) * kMerlBins + b] *= scales[c];
    }
  }
  const BrdfMetrics m = CompareBrdfs(estimate, reference).value();
  EXPECT_NEAR(std::sqrt(squares / 3), m.log_rmse, kBrdfFloorTolerance);
  EXPECT_NEAR(std::sqrt(squares / 3), m.log_rmse_below80, kBrdfFloorTolerance);
  EXPECT_NEAR(0.0, m.log_rmse_aligned, kBrdfFloorTolerance);
  EXPECT_NEAR(0.0, m.log_rmse_aligned_below80, kBrdfFloorTolerance);
}

// The formulas written down once more. The directions are built as vectors: the
// half-vector h, and the light at theta_d from it, turned by phi_d around it.
TEST(BrdfMetrics, MatchesASlowReference) {
  MerlTable reference = RandomTable(3), estimate = RandomTable(4);
  std::mt19937 rng(5);
  for (size_t i = 0; i < reference.raw.size(); ++i) {
    if (rng() % 10 == 0) reference.raw[i] = rng() % 2 == 0 ? -1.0 : 0.0;
    if (rng() % 10 == 0) estimate.raw[i] = -1.0;
  }
  double squares = 0.0, squares80 = 0.0, means[3] = {}, variance = 0.0;
  double means80[3] = {}, variance80 = 0.0;
  int64_t bins = 0, bins80 = 0;
  std::vector<double> d[3], d80[3];
  for (int h = 0; h < 90; ++h) {
    for (int j = 0; j < 90; ++j) {
      for (int k = 0; k < 180; ++k) {
        const int bin = (h * 90 + j) * 180 + k;
        if (!(reference.raw[bin] > 0)) continue;
        const double th = MerlThetaH(h), td = MerlThetaD(j), pd = MerlPhiD(k);
        const Eigen::Vector3d half(std::sin(th), 0, std::cos(th));
        const Eigen::Vector3d tangent(std::cos(th), 0, -std::sin(th));
        const Eigen::Vector3d binormal(0, 1, 0);
        const Eigen::Vector3d wi =
            std::cos(td) * half +
            std::sin(td) * (std::cos(pd) * tangent + std::sin(pd) * binormal);
        const Eigen::Vector3d wo = 2 * wi.dot(half) * half - wi;
        const double limit = std::cos(80 * kPi / 180);
        const bool below = wi.z() >= limit && wo.z() >= limit;
        ++bins;
        bins80 += below;
        for (int c = 0; c < 3; ++c) {
          const size_t at = size_t(c) * kMerlBins + bin;
          const double x = std::log(std::max(estimate.raw[at], 0.0) + 1e-6) -
                           std::log(std::max(reference.raw[at], 0.0) + 1e-6);
          squares += x * x;
          if (below) {
            squares80 += x * x;
            means80[c] += x;
            d80[c].push_back(x);
          }
          means[c] += x;
          d[c].push_back(x);
        }
      }
    }
  }
  for (int c = 0; c < 3; ++c) {
    for (const double x : d[c]) {
      variance += (x - means[c] / bins) * (x - means[c] / bins);
    }
    for (const double x : d80[c]) {
      variance80 += (x - means80[c] / bins80) * (x - means80[c] / bins80);
    }
  }
  const BrdfMetrics m = CompareBrdfs(estimate, reference).value();
  EXPECT_EQ(bins, m.bins);
  EXPECT_EQ(bins80, m.bins_below80);
  EXPECT_NEAR(std::sqrt(squares / (3 * bins)), m.log_rmse, kBrdfSumTolerance);
  EXPECT_NEAR(std::sqrt(squares80 / (3 * bins80)), m.log_rmse_below80,
              kBrdfSumTolerance);
  EXPECT_NEAR(std::sqrt(variance / (3 * bins)), m.log_rmse_aligned,
              kBrdfSumTolerance);
  EXPECT_NEAR(std::sqrt(variance80 / (3 * bins80)), m.log_rmse_aligned_below80,
              kBrdfSumTolerance);
}

TEST(BrdfMetrics, OnlyBinsWithPositiveRedCount) {
  MerlTable reference = RandomTable(6), estimate = reference;
  for (int b = 0; b < kMerlBins; ++b) {
    if (b % 3 == 0) {
      reference.raw[b] = b % 2 == 0 ? 0.0 : -1.0;
      estimate.raw[size_t{2} * kMerlBins + b] = 1e9;
    }
  }
  const BrdfMetrics m = CompareBrdfs(estimate, reference).value();
  EXPECT_EQ(0.0, m.log_rmse);
  EXPECT_EQ(kMerlBins - kMerlBins / 3, m.bins);
}

TEST(BrdfMetrics, BadTablesAreRefused) {
  const MerlTable good = RandomTable(7);
  MerlTable bad = good;
  bad.raw[5] = std::numeric_limits<double>::quiet_NaN();
  EXPECT_EQ("estimate: bin 5: expected finite values",
            CompareBrdfs(bad, good).status().message());
  EXPECT_EQ("reference: bin 5: expected finite values",
            CompareBrdfs(good, bad).status().message());
  MerlTable black = good;
  for (double& v : black.raw) v = 0.0;
  EXPECT_FALSE(CompareBrdfs(good, black).ok());
  // All black: log(1e-6) against the reference.
  EXPECT_GT(CompareBrdfs(black, good)->log_rmse, 6 * std::log(10.0));
}

}  // namespace
}  // namespace ibrdf
