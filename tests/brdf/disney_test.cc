#include "ibrdf/brdf/disney.h"

#include <gtest/gtest.h>

#include <cmath>
#include <random>

#include "ibrdf/base/pi.h"
#include "ibrdf/geometry/half_diff.h"
#include "tests/brdf/direction.h"

namespace ibrdf {
namespace {

Eigen::Array3d Between(const Disney& brdf, const Eigen::Vector3d& wi,
                       const Eigen::Vector3d& wo) {
  const HalfDiff a = ToHalfDiff(wi, wo);
  return brdf.Evaluate(a.theta_h, a.theta_d, a.phi_d);
}

Disney DisneyPaint() {
  Disney brdf;
  brdf.base = {0.8, 0.3, 0.05};
  brdf.roughness = 0.35;
  brdf.metallic = 0.3;
  brdf.specular = 0.7;
  return brdf;
}

TEST(Disney, IsReciprocal) {
  const Disney brdf = DisneyPaint();
  std::mt19937 rng(3);
  std::uniform_real_distribution<double> theta(0.0, 1.5), phi(0.0, 2 * kPi);
  for (int i = 0; i < 200; ++i) {
    const Eigen::Vector3d wi = Direction(theta(rng), phi(rng));
    const Eigen::Vector3d wo = Direction(theta(rng), phi(rng));
    const Eigen::Array3d a = Between(brdf, wi, wo), b = Between(brdf, wo, wi);
    // Rounding of the angles, amplified by the slope of the lobe.
    for (int c = 0; c < 3; ++c) EXPECT_NEAR(1.0, a[c] / b[c], 1e-9);
  }
}

// Walter et al. 2007 and Burley 2012 as printed, from directions.
TEST(Disney, MatchesTheTextbookFormula) {
  const Disney brdf = DisneyPaint();
  const Eigen::Vector3d wi = Direction(0.9, 0.3), wo = Direction(0.7, 2.9);
  const Eigen::Vector3d h = (wi + wo).normalized();
  const double alpha = brdf.roughness * brdf.roughness;
  const double tangent = std::tan(std::acos(h.z()));
  const double d = alpha * alpha /
                   (kPi * std::pow(h.z(), 4) *
                    std::pow(alpha * alpha + tangent * tangent, 2));
  const auto g1 = [&](double cosine) {
    const double t = std::tan(std::acos(cosine));
    return 2 / (1 + std::sqrt(1 + alpha * alpha * t * t));
  };
  const auto bent = [](double cosine) { return std::pow(1 - cosine, 5); };
  const double f90 = 0.5 + 2 * brdf.roughness * wi.dot(h) * wi.dot(h);
  const Eigen::Array3d f = Between(brdf, wi, wo);
  for (int c = 0; c < 3; ++c) {
    const double f0 = 0.7 * 0.08 * brdf.specular + 0.3 * brdf.base[c];
    const double fresnel = f0 + (1 - f0) * bent(wi.dot(h));
    const double expected =
        0.7 * brdf.base[c] / kPi * (1 + (f90 - 1) * bent(wi.z())) *
            (1 + (f90 - 1) * bent(wo.z())) +
        d * fresnel * g1(wi.z()) * g1(wo.z()) / (4 * wi.z() * wo.z());
    EXPECT_NEAR(expected, f[c], 1e-9 * expected);  // rounding of the angles
  }
}

TEST(Disney, IsFiniteAtTheEdgesOfAnglesAndValues) {
  Disney brdf;
  brdf.base = {0.0, 1.0, 50.0};
  for (const double roughness : {0.0, 1.0}) {
    for (const double metallic : {0.0, 1.0}) {
      for (const double specular : {0.0, 12.5}) {
        brdf.roughness = roughness;
        brdf.metallic = metallic;
        brdf.specular = specular;
        for (const double h : {0.0, 0.7, kPi / 2}) {
          for (const double d : {0.0, 0.7, kPi / 2}) {
            for (const double p : {0.0, 1.0, kPi / 2, 3.1}) {
              const Eigen::Array3d f = brdf.Evaluate(h, d, p);
              EXPECT_TRUE(f.allFinite()) << h << " " << d << " " << p;
              EXPECT_GE(f.minCoeff(), 0.0);
            }
          }
        }
      }
    }
  }
}

TEST(Disney, LogParametersAreLogarithmsAndLogits) {
  const Disney brdf = DisneyPaint();
  const auto logit = [](double p) { return std::log(p / (1.0 - p)); };
  DisneyLog parameters;
  parameters << brdf.base.log().matrix(), logit(brdf.roughness),
      logit(brdf.metallic), logit(0.08 * brdf.specular);
  const Disney back = FromLogParameters(parameters);
  for (int c = 0; c < 3; ++c) EXPECT_NEAR(brdf.base[c], back.base[c], 1e-14);
  EXPECT_NEAR(brdf.roughness, back.roughness, 1e-14);
  EXPECT_NEAR(brdf.metallic, back.metallic, 1e-14);
  EXPECT_NEAR(brdf.specular, back.specular, 1e-13);
}

TEST(Disney, GradientMatchesDifferences) {
  std::mt19937 rng(7);
  std::uniform_real_distribution<double> angle(0.0, 1.5), value(-3.0, 3.0);
  for (int i = 0; i < 60; ++i) {
    DisneyLog p;
    // The last third far out: nearly a mirror, or nearly nothing.
    for (int k = 0; k < 6; ++k) p[k] = value(rng) * (i < 40 ? 1.0 : 3.0);
    p[3] = std::max(p[3], -4.0);  // below, the smallest alpha has a kink
    const DisneyGeometry g(angle(rng), angle(rng), 2.0 * angle(rng));
    const int channel = i % 3;
    DisneyLog gradient;
    const double f = EvaluateDisney(p, g, channel, &gradient);
    EXPECT_EQ(f, EvaluateDisney(p, g, channel, nullptr));
    for (int k = 0; k < kDisneyParameters; ++k) {
      constexpr double kStep = 1e-5;
      DisneyLog up = p, down = p;
      up[k] += kStep;
      down[k] -= kStep;
      const double difference = (EvaluateDisney(up, g, channel, nullptr) -
                                 EvaluateDisney(down, g, channel, nullptr)) /
                                (2 * kStep);
      // Second order in the step, with third derivatives up to 1e3 f; and
      // rounding of f over the step.
      EXPECT_NEAR(difference, gradient[k], 1e-7 * f) << i << " " << k;
    }
  }
}

}  // namespace
}  // namespace ibrdf
