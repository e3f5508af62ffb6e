#include "ibrdf/flow/log_linear_spline.h"

#include <gtest/gtest.h>

#include <cmath>
#include <random>
#include <vector>

#include "ibrdf/base/dual.h"

namespace ibrdf {
namespace {

using Spline = LogLinearSpline<double>;

std::vector<double> Parameters(int bins, bool periodic, double scale,
                               uint64_t seed) {
  std::mt19937_64 rng(seed);
  std::normal_distribution<double> normal;
  std::vector<double> p((periodic ? bins : bins + 1) + bins);
  for (double& v : p) v = scale * normal(rng);
  return p;
}

TEST(LogLinearSpline, DensityIntegratesToTheIntegral) {
  // Midpoint rule of 2e5 steps h: h^2 / 24 times the square of log density's
  // slope, which is 1e3 where it is steep.
  constexpr int kSteps = 200000;
  constexpr double kTolerance = 1e-6;
  for (const int bins : {2, 7, 64}) {
    for (const bool periodic : {false, true}) {
      for (const double scale : {0.0, 1e-3, 0.3, 1.0}) {
        const Spline spline(Parameters(bins, periodic, scale, 1).data(), bins,
                            periodic);
        double sum = 0.0;
        for (int i = 0; i < kSteps; ++i) {
          if (i % 20000 == 0) {
            const double x = static_cast<double>(i) / kSteps;
            EXPECT_NEAR(sum / kSteps, spline.Integral(x), kTolerance);
          }
          sum += std::exp(spline.LogDensity((i + 0.5) / kSteps));
        }
        EXPECT_NEAR(1.0, sum / kSteps, kTolerance);
        EXPECT_EQ(0.0, spline.Integral(0.0));
        EXPECT_NEAR(1.0, spline.Integral(1.0), 1e-14);  // 64 additions
      }
    }
  }
}

TEST(LogLinearSpline, EqualParametersAreTheUniformDensity) {
  for (const double p : {-1e6, -3.0, 0.0, 2.0, 1e6}) {
    const std::vector<double> parameters(13, p);
    const Spline spline(parameters.data(), 6, false);
    for (const double x : {0.0, 0.1, 0.5, 0.93, 1.0}) {
      EXPECT_NEAR(0.0, spline.LogDensity(x), 1e-13);  // heights up to 40
      EXPECT_NEAR(x, spline.Integral(x), 1e-14);
      EXPECT_NEAR(x, spline.InverseIntegral(x), 1e-14);
    }
  }
}

TEST(LogLinearSpline, TwoBinsHaveAClosedForm) {
  // Heights 0, h, 0 at knots 0, 1/2, 1: a tent of mass (e^h - 1) / h.
  for (const double h : {-30.0, -2.0, -0.0099, 0.0101, 0.5, 20.0}) {
    const double p = h / (kHeightGain * (1 - std::abs(h) / kHeightRange));
    const double parameters[5] = {0.0, p, 0.0, 0.0, 0.0};
    const Spline spline(parameters, 2, false);
    const double log_mass = std::log(std::expm1(h) / h);
    // Close to |h| = 0.01, e^h - 1 in the spline loses two digits.
    EXPECT_NEAR(-log_mass, spline.LogDensity(0.0), 1e-12);
    EXPECT_NEAR(h - log_mass, spline.LogDensity(0.5), 1e-12);
    EXPECT_NEAR(0.5 * h - log_mass, spline.LogDensity(0.25), 1e-12);
    EXPECT_NEAR(0.5 * h - log_mass, spline.LogDensity(0.75), 1e-12);
    EXPECT_NEAR(0.5, spline.Integral(0.5), 1e-14);
    EXPECT_NEAR(std::expm1(0.5 * h) / std::expm1(h) / 2, spline.Integral(0.25),
                1e-12);
  }
}

TEST(LogLinearSpline, PeriodicEndsMeet) {
  const Spline spline(Parameters(5, true, 1.0, 3).data(), 5, true);
  EXPECT_NEAR(spline.LogDensity(0.0), spline.LogDensity(1.0), 1e-12);
}

TEST(LogLinearSpline, InverseUndoesIntegral) {
  std::mt19937_64 rng(5);
  std::uniform_real_distribution<double> uniform(0.0, 1.0);
  for (const double scale : {0.0, 1e-6, 0.1, 1.0, 10.0, 1e6}) {
    for (int trial = 0; trial < 20; ++trial) {
      const Spline spline(Parameters(9, trial % 2, scale, trial).data(), 9,
                          trial % 2);
      for (int i = 0; i < 50; ++i) {
        const double u = i == 0 ? 0.0 : (i == 1 ? 1.0 : uniform(rng));
        const double x = spline.InverseIntegral(u);
        ASSERT_TRUE(x >= 0.0 && x <= 1.0);
        // A rounding of x times the largest density, 80 / kMinBinWidth.
        EXPECT_NEAR(u, spline.Integral(x), 1e-10);
      }
    }
  }
}

TEST(LogLinearSpline, DerivativesAreThoseOfDifferences) {
  // A knot's rounding, 1e-16, over the narrowest bin, 1e-3, times differences
  // of heights of 50, over the step.
  constexpr double kStep = 1e-5, kTolerance = 1e-6;
  const int bins = 5;
  for (const double scale : {0.0, 1e-4, 0.5, 3.0}) {
    const std::vector<double> p = Parameters(bins, false, scale, 7);
    const int n = static_cast<int>(p.size());
    std::vector<Dual> dual;
    for (int k = 0; k < n; ++k) dual.emplace_back(p[k], n, k);
    for (const double x : {0.0, 0.137, 0.61, 0.94, 1.0}) {
      const Dual value =
          LogLinearSpline<Dual>(dual.data(), bins, false).LogDensity(Dual(x));
      for (int k = 0; k < n; ++k) {
        std::vector<double> up = p, down = p;
        up[k] += kStep;
        down[k] -= kStep;
        const double slope = (Spline(up.data(), bins, false).LogDensity(x) -
                              Spline(down.data(), bins, false).LogDensity(x)) /
                             (2 * kStep);
        EXPECT_NEAR(slope, value.derivatives[k],
                    kTolerance * (1 + std::abs(slope)));
      }
    }
  }
}

}  // namespace
}  // namespace ibrdf
