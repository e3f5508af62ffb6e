#include "ibrdf/metrics/albedo.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <vector>

#include "ibrdf/base/gauss_legendre.h"
#include "ibrdf/base/pi.h"
#include "ibrdf/brdf/cook_torrance.h"
#include "ibrdf/brdf/lambertian.h"
#include "ibrdf/brdf/merl_table.h"
#include "ibrdf/brdf/sample_merl.h"

namespace ibrdf {
namespace {

constexpr double kRounding = 1e-12;
// Smooth integrands, of which the rule resolves the horizon.
constexpr double kSpectral = 1e-8;

double Radians(double degrees) { return degrees * kPi / 180.0; }

Eigen::Vector3d View(double theta) {
  return {std::sin(theta), 0.0, std::cos(theta)};
}

// Midpoints of a fine lattice of light directions, which knows nothing of
// half-vectors.
Eigen::Array3d SlowAlbedo(const BrdfFunction& brdf, double theta_o, int n) {
  const Eigen::Vector3d wo = View(theta_o);
  Eigen::Array3d sum = Eigen::Array3d::Zero();
  for (int i = 0; i < n; ++i) {
    const double theta = kPi / 2 * (i + 0.5) / n;
    for (int j = 0; j < n; ++j) {
      const double phi = 2.0 * kPi * (j + 0.5) / n;
      const Eigen::Vector3d wi(std::sin(theta) * std::cos(phi),
                               std::sin(theta) * std::sin(phi),
                               std::cos(theta));
      const HalfDiff a = ToHalfDiff(wi, wo);
      sum += brdf(a.theta_h, a.theta_d, a.phi_d) * wi.z() * std::sin(theta);
    }
  }
  return sum * (kPi / 2 / n) * (2.0 * kPi / n);
}

CookTorrance Chrome() {
  CookTorrance brdf;
  brdf.diffuse.setZero();
  brdf.specular = {0.6, 0.7, 0.8};
  brdf.roughness = {0.02, 0.03, 0.05};
  brdf.f0 = {0.9, 0.8, 0.6};
  return brdf;
}

TEST(Albedo, WhiteLambertianIsOneAtAllViews) {
  Lambertian white;
  white.albedo = {1.0, 0.5, 0.25};
  for (const double degrees : {0.0, 1.0, 30.0, 60.0, 80.0, 85.0, 89.0, 89.9}) {
    const AlbedoRule rule(Radians(degrees));
    const Eigen::Array3d albedo = rule.Albedo(BatchOf(white.Function()));
    EXPECT_LT((albedo - white.albedo).abs().maxCoeff(), kRounding) << degrees;
    // It would be without the scale, too.
    if (degrees <= 85.0) {
      EXPECT_NEAR(rule.correction(), 1.0, kSpectral) << degrees;
    }
  }
}

// f = cos(theta_i) cos(theta_o) has a = 2 pi / 3 cos(theta_o).
TEST(Albedo, ProductOfCosinesIsItsClosedForm) {
  const auto product = [](double theta_h, double theta_d, double phi_d) {
    Eigen::Vector3d wi, wo;
    FromHalfDiff({theta_h, theta_d, phi_d}, &wi, &wo);
    return Eigen::Array3d(Eigen::Array3d::Constant(wi.z() * wo.z()));
  };
  for (const double degrees : {0.0, 45.0, 80.0}) {
    const double expected = 2.0 * kPi / 3.0 * std::cos(Radians(degrees));
    EXPECT_NEAR(AlbedoRule(Radians(degrees)).Albedo(BatchOf(product))[0],
                expected, kSpectral)
        << degrees;
  }
  const FurnaceFigures figures = FurnaceRules().Measure(BatchOf(product));
  EXPECT_NEAR(figures.hemispherical[1], 4.0 * kPi / 9.0, kSpectral);
  EXPECT_NEAR(figures.largest[2], 2.0 * kPi / 3.0, kSpectral);
}

// Isotropic and reciprocal, but not its own mirror image in the plane of view:
// what one side gains the other loses.
TEST(Albedo, BothSidesOfThePlaneOfViewCount) {
  const auto lopsided = [](double, double theta_d, double phi_d) {
    const double f = 1.0 + std::sin(theta_d) * std::sin(2.0 * phi_d);
    return Eigen::Array3d(Eigen::Array3d::Constant(f / kPi));
  };
  for (const double degrees : {20.0, 70.0}) {
    EXPECT_NEAR(AlbedoRule(Radians(degrees)).Albedo(BatchOf(lopsided))[0], 1.0,
                kRounding);
  }
}

TEST(Albedo, ChromeAgreesWithASlowReference) {
  const CookTorrance chrome = Chrome();
  for (const double degrees : {0.0, 75.0}) {
    const Eigen::Array3d slow =
        SlowAlbedo(chrome.Function(), Radians(degrees), 1200);
    const Eigen::Array3d fast =
        AlbedoRule(Radians(degrees)).Albedo(BatchOf(chrome.Function()));
    // Masking has kinks.
    EXPECT_LT((fast / slow - 1.0).abs().maxCoeff(), 1e-3)
        << degrees << ": " << fast.transpose() << " / " << slow.transpose();
    EXPECT_TRUE((fast <= chrome.diffuse + chrome.specular).all());
  }
}

// A table is linear between its bins: kinks everywhere.
TEST(Albedo, TableAgreesWithASlowReference) {
  const MerlTable table = SampleMerl(Chrome().Function());
  const BrdfFunction brdf = [&](double h, double d, double p) {
    return InterpolateMerl(table, h, d, p);
  };
  for (const double degrees : {0.0, 60.0}) {
    const Eigen::Array3d slow = SlowAlbedo(brdf, Radians(degrees), 1000);
    const Eigen::Array3d fast =
        AlbedoRule(Radians(degrees)).Albedo(BatchOf(brdf));
    EXPECT_LT((fast / slow - 1.0).abs().maxCoeff(), 3e-3)
        << degrees << ": " << fast.transpose() << " / " << slow.transpose();
  }
}

TEST(Albedo, IntegralsAreReciprocal) {
  // int int f cos_i cos_o g(wi) dwi dwo with g = cos_i and with g = cos_o.
  CookTorrance brdf = Chrome();
  brdf.roughness = {0.1, 0.2, 0.4};
  brdf.diffuse = {0.1, 0.2, 0.3};
  std::vector<double> s, ds;
  GaussLegendre(24, &s, &ds);
  Eigen::Array3d in = Eigen::Array3d::Zero(), out = in;
  for (size_t v = 0; v < s.size(); ++v) {
    const double theta_o = std::asin(std::sqrt(s[v]));
    const AlbedoRule rule(theta_o);
    const std::vector<Eigen::Array3d> f =
        BatchOf(brdf.Function())(rule.angles());
    for (size_t i = 0; i < f.size(); ++i) {
      in += ds[v] * rule.weights()[i] * rule.cos_i()[i] * f[i];
      out += ds[v] * rule.weights()[i] * std::cos(theta_o) * f[i];
    }
  }
  // Masking has kinks, and 24 views meet Fresnel's rise at grazing angles.
  EXPECT_LT((in / out - 1.0).abs().maxCoeff(), 1e-3);
}

TEST(Albedo, OfAMattePartByFewNodes) {
  BrdfGrid matte({24, 12, 8});
  for (int c = 0; c < 3; ++c) {
    std::fill_n(matte.Channel(c), matte.shape.num_nodes(),
                static_cast<float>((0.2 + 0.3 * c) / kPi));
  }
  const Eigen::Array3d albedo = MatteAlbedo(matte);
  // The nodes are floats.
  for (int c = 0; c < 3; ++c) EXPECT_NEAR(0.2 + 0.3 * c, albedo[c], 1e-6);
}

TEST(Furnace, CountsViewsThatMakeEnergy) {
  const FurnaceRules rules;
  Lambertian brdf;
  brdf.albedo.setOnes();
  FurnaceFigures figures = rules.Measure(BatchOf(brdf.Function()));
  EXPECT_EQ(figures.albedo.size(), size_t{FurnaceRules::kNumViews});
  EXPECT_EQ(figures.views, 54);
  EXPECT_EQ(figures.above_one, 0);
  EXPECT_NEAR(figures.hemispherical[0], 1.0, kRounding);
  EXPECT_NEAR(figures.largest[0], 1.0, kRounding);
  brdf.albedo = {1.01, 0.9, 1.01};
  figures = rules.Measure(BatchOf(brdf.Function()));
  EXPECT_EQ(figures.above_one, 36);
}

}  // namespace
}  // namespace ibrdf
