#include "solvers/marginal/cell_noise.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>

namespace ibrdf {
namespace {

constexpr double kSigma = 0.03;
const LightProcess kProcess;

// What FitStrength makes least.
double Cost(double u, const Eigen::Vector3d& residual,
            const Eigen::Vector3d& texels) {
  const double y = (u - kProcess.strength_mean) / kProcess.strength_std;
  double cost = 0.5 * y * y;
  for (int c = 0; c < 3; ++c) {
    const double D = kSigma * kSigma + std::exp(u) * texels[c];
    cost += 0.5 * (residual[c] * residual[c] / D + std::log(D));
  }
  return cost;
}

TEST(FitStrength, IsTheLeastOfAFineScan) {
  const double reach = 5.0 * kProcess.strength_std;
  for (const double r : {0.0, 0.003, 0.03, 0.3, 3.0, 100.0}) {
    for (const double t : {1e-12, 1e-6, 1e-3, 0.05, 3.0}) {
      const Eigen::Vector3d residual(r, -0.7 * r, 1.2 * r), texels(t, t / 2, t);
      const NoiseStrength fit = FitStrength(residual, texels, kSigma, kProcess);
      double least = Cost(kProcess.strength_mean, residual, texels);
      for (int i = -20000; i <= 20000; ++i) {
        const double u = kProcess.strength_mean + reach * i / 20000;
        least = std::min(least, Cost(u, residual, texels));
      }
      // Within its precision of 0.01; at the ends of its reach a slope of up to
      // r^2 / (2 D) would lead further.
      const double there = Cost(fit.log_strength, residual, texels);
      EXPECT_LT(there, least + 1e-4 * (1.0 + std::abs(least))) << r << " " << t;
      const double y =
          (fit.log_strength - kProcess.strength_mean) / kProcess.strength_std;
      EXPECT_NEAR(0.5 * y * y, fit.cost, 1e-12);
      EXPECT_LE(std::abs(y), 5.0 + 0.01);
    }
  }
}

TEST(FitStrength, OfACellWithoutSuchNoiseIsThePriors) {
  const NoiseStrength fit =
      FitStrength(Eigen::Vector3d(0.5, 0.1, -2.0), Eigen::Vector3d::Zero(),
                  kSigma, kProcess);
  EXPECT_EQ(kProcess.strength_mean, fit.log_strength);
  EXPECT_EQ(0.0, fit.cost);
}

TEST(FitStrength, GrowsWithTheResidual) {
  const Eigen::Vector3d texels = Eigen::Vector3d::Constant(0.05);
  double last = -1e300;
  for (const double r : {0.0, 0.05, 0.1, 0.3, 1.0}) {
    const double u =
        FitStrength(Eigen::Vector3d::Constant(r), texels, kSigma, kProcess)
            .log_strength;
    EXPECT_GT(u, last);
    last = u;
  }
  // A quiet cell's light is smoother than most, a loud one's rougher.
  EXPECT_LT(FitStrength(Eigen::Vector3d::Zero(), texels, kSigma, kProcess)
                .log_strength,
            kProcess.strength_mean - 0.5);
  EXPECT_GT(last, kProcess.strength_mean + 1.0);
}

}  // namespace
}  // namespace ibrdf
