#include "ibrdf/brdf/cook_torrance.h"

#include <gtest/gtest.h>

#include <cmath>
#include <random>

#include "ibrdf/base/pi.h"
#include "ibrdf/brdf/sample_merl.h"
#include "ibrdf/geometry/half_diff.h"
#include "tests/brdf/direction.h"

namespace ibrdf {
namespace {

Eigen::Array3d Between(const CookTorrance& brdf, const Eigen::Vector3d& wi,
                       const Eigen::Vector3d& wo) {
  const HalfDiff a = ToHalfDiff(wi, wo);
  return brdf.Evaluate(a.theta_h, a.theta_d, a.phi_d);
}

// int f cos_i dwi, over half-vectors so that a narrow lobe is resolved.
Eigen::Array3d Albedo(const CookTorrance& brdf, double theta_o) {
  const Eigen::Vector3d wo = Direction(theta_o, 0.0);
  const int rings = 400, samples = 400;
  Eigen::Array3d sum = Eigen::Array3d::Zero();
  for (int i = 0; i < rings; ++i) {
    const double inner = std::pow(static_cast<double>(i) / rings, 2) * kPi / 2;
    const double outer = std::pow((i + 1.0) / rings, 2) * kPi / 2;
    const double area = (std::cos(inner) - std::cos(outer)) * 2 * kPi / samples;
    for (int k = 0; k < samples; ++k) {
      const Eigen::Vector3d h =
          Direction(0.5 * (inner + outer), 2 * kPi * (k + 0.5) / samples);
      const double oh = h.dot(wo);
      const Eigen::Vector3d wi = 2 * oh * h - wo;
      if (oh <= 0.0 || wi.z() <= 0.0) continue;
      sum += 4 * oh * wi.z() * area * Between(brdf, wi, wo);
    }
  }
  return sum;
}

TEST(CookTorrance, IsReciprocal) {
  CookTorrance brdf;
  brdf.roughness = {0.05, 0.2, 0.6};
  std::mt19937 rng(3);
  std::uniform_real_distribution<double> theta(0.0, 1.5), phi(0.0, 2 * kPi);
  for (int i = 0; i < 200; ++i) {
    const Eigen::Vector3d wi = Direction(theta(rng), phi(rng));
    const Eigen::Vector3d wo = Direction(theta(rng), phi(rng));
    const Eigen::Array3d a = Between(brdf, wi, wo), b = Between(brdf, wo, wi);
    // Rounding of the angles, amplified by the slope of the exponent.
    for (int c = 0; c < 3; ++c) EXPECT_NEAR(1.0, a[c] / b[c], 1e-9);
  }
}

TEST(CookTorrance, MatchesTheTextbookFormula) {
  CookTorrance brdf;
  brdf.diffuse = {0.1, 0.2, 0.3};
  brdf.specular = {0.9, 0.5, 0.2};
  brdf.roughness = {0.1, 0.3, 0.5};
  brdf.f0 = {0.04, 0.5, 0.9};
  const Eigen::Vector3d wi = Direction(0.9, 0.3), wo = Direction(0.7, 2.9);
  const Eigen::Vector3d h = (wi + wo).normalized();
  const double g = std::min(
      {1.0, 2 * h.z() * wi.z() / wi.dot(h), 2 * h.z() * wo.z() / wi.dot(h)});
  const Eigen::Array3d f = Between(brdf, wi, wo);
  for (int c = 0; c < 3; ++c) {
    const double m = brdf.roughness[c];
    const double tangent = std::tan(std::acos(h.z()));
    const double d = std::exp(-tangent * tangent / (m * m)) /
                     (kPi * m * m * std::pow(h.z(), 4));
    const double fresnel =
        brdf.f0[c] + (1 - brdf.f0[c]) * std::pow(1 - wi.dot(h), 5);
    EXPECT_NEAR(brdf.diffuse[c] / kPi +
                    brdf.specular[c] * d * fresnel * g / (4 * wi.z() * wo.z()),
                f[c], 1e-9 * f[c]);
  }
}

TEST(CookTorrance, ReflectsNoMoreThanItReceives) {
  CookTorrance brdf;
  brdf.diffuse.setZero();
  brdf.f0.setOnes();
  brdf.roughness = {0.05, 0.3, 0.7};
  for (const double degrees : {0.0, 30.0, 60.0, 80.0}) {
    const Eigen::Array3d albedo = Albedo(brdf, degrees * kPi / 180);
    // The quadrature's error at the lobe of slope 0.05.
    EXPECT_LT(albedo.maxCoeff(), 1.0 + 2e-3) << degrees;
  }
  // Slopes of 0.05 seen from above: neither masked nor scattered below.
  EXPECT_NEAR(1.0, Albedo(brdf, 0.0)[0], 5e-3);
}

TEST(CookTorrance, IsFiniteAndPositiveAtTheEdgesOfTheAngles) {
  CookTorrance brdf;
  brdf.roughness = {1e-3, 0.1, 1.0};
  for (const double h : {0.0, 0.7, kPi / 2}) {
    for (const double d : {0.0, 0.7, kPi / 2}) {
      for (const double p : {0.0, 1.0, kPi / 2, 3.1}) {
        const Eigen::Array3d f = brdf.Evaluate(h, d, p);
        EXPECT_TRUE(f.allFinite()) << h << " " << d << " " << p;
        EXPECT_GT(f.minCoeff(), 0.0);
      }
    }
  }
}

TEST(CookTorrance, KeepsItsDigitsInTheLobeOfAMirror) {
  // 1 - cos^2(theta_h) would have four digits here.
  CookTorrance brdf;
  brdf.diffuse.setZero();
  brdf.roughness.setConstant(1e-6);
  const Eigen::Array3d peak = brdf.Evaluate(0.0, 0.8, 1.1);
  const Eigen::Array3d f = brdf.Evaluate(1e-6, 0.8, 1.1);
  for (int c = 0; c < 3; ++c) {
    EXPECT_NEAR(std::exp(-1.0), f[c] / peak[c], 1e-11);
  }
}

TEST(CookTorrance, LogParametersRoundTripAndGradientMatchesDifferences) {
  CookTorrance brdf;
  brdf.diffuse = {0.1, 0.2, 0.3};
  brdf.roughness = {0.1, 0.3, 0.5};
  brdf.f0 = {0.04, 0.5, 0.9};
  for (int c = 0; c < 3; ++c) {
    const CookTorranceLog p = ToLogParameters(brdf, c);
    CookTorrance back;
    FromLogParameters(p, c, &back);
    EXPECT_NEAR(brdf.diffuse[c], back.diffuse[c], 1e-14);
    EXPECT_NEAR(brdf.specular[c], back.specular[c], 1e-14);
    EXPECT_NEAR(brdf.roughness[c], back.roughness[c], 1e-14);
    EXPECT_NEAR(brdf.f0[c], back.f0[c], 1e-14);
    Eigen::Vector4d gradient;
    const double f = EvaluateCookTorrance(p, 0.15, 0.8, 1.1, &gradient);
    EXPECT_NEAR(brdf.Evaluate(0.15, 0.8, 1.1)[c], f, 1e-13 * f);
    constexpr double kStep = 1e-5;
    for (int k = 0; k < 4; ++k) {
      CookTorranceLog up = p, down = p;
      up[k] += kStep;
      down[k] -= kStep;
      const double difference =
          (EvaluateCookTorrance(up, 0.15, 0.8, 1.1, nullptr) -
           EvaluateCookTorrance(down, 0.15, 0.8, 1.1, nullptr)) /
          (2 * kStep);
      // Second order in the step, with third derivatives up to 1e3 f.
      EXPECT_NEAR(difference, gradient[k], 1e-6 * f);
    }
  }
}

TEST(CookTorrance, GradientIsFiniteWhateverTheRoughness) {
  for (const double roughness : {-1e4, -400.0, -100.0, 99.0, 400.0, 1e4}) {
    for (const double theta_h : {0.0, 0.3, 1.57}) {
      const CookTorranceLog p(-1.0, 0.0, roughness, -3.0);
      Eigen::Vector4d gradient;
      const double f = EvaluateCookTorrance(p, theta_h, 0.8, 1.1, &gradient);
      EXPECT_TRUE(std::isfinite(f)) << roughness << " " << theta_h;
      EXPECT_TRUE(gradient.allFinite()) << roughness << " " << theta_h;
      // Constant beyond the clamp.
      if (std::abs(roughness) > 100.0) {
        EXPECT_EQ(0.0, gradient[2]);
      }
    }
  }
}

TEST(CookTorrance, SampledTableReturnsItsValuesAtBinCentres) {
  const CookTorrance brdf;
  const MerlTable table = SampleMerl(brdf.Function());
  const Eigen::Array3d f =
      InterpolateMerl(table, MerlThetaH(7), MerlThetaD(20), MerlPhiD(33));
  const Eigen::Array3d exact =
      brdf.Evaluate(MerlThetaH(7), MerlThetaD(20), MerlPhiD(33));
  for (int c = 0; c < 3; ++c) EXPECT_NEAR(exact[c], f[c], 1e-9 * exact[c]);
  EXPECT_EQ(-1.0, table.Raw(0, MerlTable::Bin(89, 89, 0)));
}

}  // namespace
}  // namespace ibrdf
