#include "ibrdf/geometry/half_diff.h"

#include <gtest/gtest.h>

#include <Eigen/Geometry>
#include <algorithm>
#include <cmath>
#include <random>

#include "ibrdf/base/pi.h"

namespace ibrdf {
namespace {
// Rounding of the two chains of double trigonometry.
constexpr double kAngleRounding = 1e-12;

// Distance of two values of phi_d on the circle of length pi.
double PhiDistance(double a, double b) {
  const double d = std::abs(a - b);
  return std::min(d, kPi - d);
}

Eigen::Vector3d Direction(double theta, double phi) {
  return {std::sin(theta) * std::cos(phi), std::sin(theta) * std::sin(phi),
          std::cos(theta)};
}

TEST(HalfDiff, AnglesSurviveTheRoundTripUpToGrazing) {
  std::mt19937 rng(3);
  std::uniform_real_distribution<double> u(0.0, 1.0);
  for (int i = 0; i < 5000; ++i) {
    HalfDiff a{};
    a.theta_d = 0.01 + (kPi / 2 - 0.011) * u(rng);
    a.phi_d = kPi * u(rng);
    // Every other one sits within 1e-4 of the horizon.
    const double share = i % 2 == 0 ? u(rng) : 1.0 - 1e-4 * u(rng);
    a.theta_h = share * ThetaHBound(a.theta_d, a.phi_d);
    if (a.theta_h < 1e-3) continue;  // phi_d is not defined at theta_h = 0
    Eigen::Vector3d wi, wo;
    FromHalfDiff(a, &wi, &wo);
    EXPECT_NEAR(1.0, wi.norm(), kAngleRounding);
    EXPECT_NEAR(1.0, wo.norm(), kAngleRounding);
    EXPECT_GT(wi.z(), -kAngleRounding);
    EXPECT_GT(wo.z(), -kAngleRounding);
    const HalfDiff b = ToHalfDiff(wi, wo);
    // phi_d's condition number is 1 / (sin theta_h sin theta_d) and the
    // half-vector's 1 / cos theta_d.
    const double tolerance =
        kAngleRounding / std::min({std::sin(a.theta_h), std::sin(a.theta_d),
                                   std::cos(a.theta_d)});
    EXPECT_NEAR(a.theta_h, b.theta_h, tolerance);
    EXPECT_NEAR(a.theta_d, b.theta_d, tolerance);
    EXPECT_LT(PhiDistance(a.phi_d, b.phi_d), 100 * tolerance);
  }
}

TEST(HalfDiff, ExchangeAndRotationKeepTheAngles) {
  std::mt19937 rng(4);
  std::uniform_real_distribution<double> u(0.0, 1.0);
  for (int i = 0; i < 5000; ++i) {
    // Up to 0.001 degrees from the horizon.
    const double top = (90 - 1e-3) * kPi / 180;
    const Eigen::Vector3d wi = Direction(top * std::sqrt(u(rng)), 7 * u(rng));
    const Eigen::Vector3d wo = Direction(top * std::sqrt(u(rng)), 7 * u(rng));
    const HalfDiff a = ToHalfDiff(wi, wo);
    const HalfDiff swapped = ToHalfDiff(wo, wi);
    const Eigen::AngleAxisd turn(6 * u(rng), Eigen::Vector3d::UnitZ());
    const HalfDiff turned = ToHalfDiff(turn * wi, turn * wo);
    const double tolerance =
        1e-10 / std::min(std::sin(a.theta_h), std::sin(a.theta_d));
    for (const HalfDiff& b : {swapped, turned}) {
      EXPECT_NEAR(a.theta_h, b.theta_h, 1e-9);
      EXPECT_NEAR(a.theta_d, b.theta_d, 1e-9);
      EXPECT_LT(PhiDistance(a.phi_d, b.phi_d), tolerance);
    }
    EXPECT_LE(a.theta_h, ThetaHBound(a.theta_d, a.phi_d) + 1e-9);
  }
}

TEST(HalfDiff, DegeneratePairsStayInRange) {
  const Eigen::Vector3d z = Eigen::Vector3d::UnitZ();
  const Eigen::Vector3d x = Eigen::Vector3d::UnitX();
  for (const auto& [wi, wo] :
       {std::pair<Eigen::Vector3d, Eigen::Vector3d>{z, z},
        {x, x},
        {x, -x},
        {z, x},
        {Direction(0.5, 0), Direction(0.5, kPi)}}) {
    const HalfDiff a = ToHalfDiff(wi, wo);
    EXPECT_TRUE(a.theta_h >= 0 && a.theta_h <= kPi / 2 + kAngleRounding);
    EXPECT_TRUE(a.theta_d >= 0 && a.theta_d <= kPi / 2 + kAngleRounding);
    EXPECT_TRUE(a.phi_d >= 0 && a.phi_d < kPi);
  }
  EXPECT_NEAR(0.5, ToHalfDiff(Direction(0.5, 0), Direction(0.5, kPi)).theta_d,
              kAngleRounding);
}

TEST(HalfDiff, BoundIsWhereADirectionMeetsTheHorizon) {
  for (double theta_d = 0.05; theta_d < 1.55; theta_d += 0.1) {
    for (double phi_d = 0.0; phi_d < kPi; phi_d += 0.17) {
      Eigen::Vector3d wi, wo;
      FromHalfDiff({ThetaHBound(theta_d, phi_d), theta_d, phi_d}, &wi, &wo);
      EXPECT_NEAR(0.0, std::min(wi.z(), wo.z()), kAngleRounding);
    }
  }
}

}  // namespace
}  // namespace ibrdf
