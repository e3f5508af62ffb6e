#include "ibrdf/brdf/brdf_sampler.h"

#include <gtest/gtest.h>

#include <cmath>
#include <random>
#include <vector>

#include "ibrdf/base/pi.h"
#include "ibrdf/brdf/cook_torrance.h"
#include "ibrdf/brdf/lambertian.h"
#include "ibrdf/metrics/albedo.h"
#include "tests/brdf/direction.h"
#include "tests/support/small_flow.h"
#include "tests/support/statistics.h"

namespace ibrdf {
namespace {

constexpr double kLevel = 1e-3;  // of tests with fixed seeds

CookTorrance Gloss(double roughness, double diffuse) {
  CookTorrance brdf;
  brdf.diffuse.setConstant(diffuse);
  brdf.specular.setConstant(0.7);
  brdf.roughness.setConstant(roughness);
  brdf.f0.setConstant(0.5);
  return brdf;
}

BrdfBatch RandomFlowBrdf() {
  const double lobes[] = {0.5, -0.3, 0.6, 5.0,  4.0, 3.0,
                          0.1, 0.7,  0.2, -1.0, 5.0, 2.0};
  return FlowBrdf(SmallFlowModel(10.0f), lobes, 2, 1).Batch();
}

struct Case {
  const char* name;
  BrdfBatch brdf;
};
std::vector<Case> Cases() {
  Lambertian matte;
  return {{"matte", BatchOf(matte.Function())},
          {"plastic", BatchOf(Gloss(0.15, 0.3).Function())},
          {"metal", BatchOf(Gloss(0.04, 0.0).Function())},
          {"flow", RandomFlowBrdf()}};
}

const double kViews[] = {0.0, 0.5, 30.0, 61.7, 80.0, 88.0, 89.5};

Eigen::Vector3d View(double degrees) {
  return Direction(degrees * kPi / 180.0, 0.9);
}

// Int of pdf over cells of (theta, phi) of the light, [nt][np].
std::vector<double> PdfCells(const BrdfSampler& sampler,
                             const Eigen::Vector3d& wo, int nt, int np,
                             int sub) {
  std::vector<double> cells(static_cast<size_t>(nt) * np, 0.0);
  const double step_t = kPi / 2 / (nt * sub), step_p = 2 * kPi / (np * sub);
  for (int i = 0; i < nt * sub; ++i) {
    const double low = i * step_t, theta = low + 0.5 * step_t;
    const double measure = (std::cos(low) - std::cos(low + step_t)) * step_p;
    for (int j = 0; j < np * sub; ++j) {
      cells[i / sub * np + j / sub] +=
          measure * sampler.Pdf(wo, Direction(theta, (j + 0.5) * step_p));
    }
  }
  return cells;
}

std::vector<int64_t> SampleCells(const BrdfSampler& sampler,
                                 const Eigen::Vector3d& wo, int nt, int np,
                                 int64_t count, uint64_t seed) {
  std::mt19937_64 rng(seed);
  std::uniform_real_distribution<double> u(0.0, 1.0);
  std::vector<int64_t> cells(static_cast<size_t>(nt) * np, 0);
  for (int64_t k = 0; k < count; ++k) {
    const double u1 = u(rng), u2 = u(rng), u3 = u(rng);
    const BrdfSampler::Sample s = sampler.Draw(wo, u1, u2, u3);
    double phi = std::atan2(s.wi.y(), s.wi.x());
    if (phi < 0.0) phi += 2 * kPi;
    const double theta = std::acos(std::min(s.wi.z(), 1.0));
    const int i = std::min(static_cast<int>(theta / (kPi / 2) * nt), nt - 1);
    const int j = std::min(static_cast<int>(phi / (2 * kPi) * np), np - 1);
    ++cells[i * np + j];
  }
  return cells;
}

// A grid of half-vectors, fine enough for a table's narrowest cells: pdf dwi =
// pdf 4 cos_d dwh. Bounds of the pdf's steps are kinks to a midpoint rule.
double PdfIntegral(const BrdfSampler& sampler, double degrees) {
  const Eigen::Vector3d wo = View(degrees);
  const double theta_o = degrees * kPi / 180.0;
  double sum = 0.0;
  constexpr int kPhi = 240, kTheta = 640;
  for (int j = 0; j < kPhi; ++j) {
    const double phi = 2 * kPi * (j + 0.5) / kPhi;
    const double delta =
        std::atan2(std::sin(theta_o) * std::cos(phi), std::cos(theta_o));
    const double bound = 0.5 * (delta + kPi / 2);
    for (int i = 0; i < kTheta; ++i) {
      const double t = (i + 0.5) / kTheta;
      const double theta = bound * t * t;
      const Eigen::Vector3d h = Direction(theta, 0.9 + phi);
      const double cos_d = wo.dot(h);
      sum += sampler.Pdf(wo, 2.0 * cos_d * h - wo) * 4.0 * cos_d *
             std::sin(theta) * 2.0 * bound * t / kTheta * 2 * kPi / kPhi;
    }
  }
  return sum;
}

TEST(BrdfSampler, PdfIntegratesToOne) {
  for (const Case& c : Cases()) {
    const BrdfSampler sampler(c.brdf);
    for (const double degrees : kViews) {
      EXPECT_NEAR(PdfIntegral(sampler, degrees), 1.0, 1e-4)
          << c.name << " " << degrees;
    }
  }
}

TEST(BrdfSampler, DirectionsPassChiSquareAgainstThePdf) {
  constexpr int kT = 20, kP = 24;
  constexpr int64_t kCount = 60000;
  int tested = 0;
  for (const Case& c : Cases()) {
    if (std::string(c.name) == "metal") continue;  // peaks within a cell: below
    const BrdfSampler sampler(c.brdf);
    for (const double degrees : {0.0, 30.0, 61.7, 80.0}) {
      const Eigen::Vector3d wo = View(degrees);
      const std::vector<double> cells = PdfCells(sampler, wo, kT, kP, 24);
      const auto counts = SampleCells(sampler, wo, kT, kP, kCount, 17);
      const ChiSquareResult own = ChiSquareTest(counts, cells);
      EXPECT_GT(own.p_value, kLevel / 12)
          << c.name << " " << degrees << ": " << own.statistic << " with "
          << own.degrees;
      // The test sees a view that is two degrees off.
      const auto wrong =
          SampleCells(sampler, View(degrees + 2.0), kT, kP, kCount, 17);
      if (std::string(c.name) != "matte") {
        EXPECT_LT(ChiSquareTest(wrong, cells).p_value, 1e-6)
            << c.name << " " << degrees;
      }
      ++tested;
    }
  }
  EXPECT_EQ(tested, 12);
}

// The same for half-vectors about the mirror direction, where a metal's are.
TEST(BrdfSampler, HalfVectorsOfAMetalPassChiSquareAgainstThePdf) {
  const BrdfSampler sampler(BatchOf(Gloss(0.04, 0.0).Function()));
  constexpr int kT = 40, kSub = 40, kPhi = 64;
  constexpr int64_t kCount = 100000;
  const double range = 10.0 * kPi / 180.0;
  for (const double degrees : {0.0, 45.0, 80.0}) {
    const Eigen::Vector3d wo = View(degrees);
    std::vector<double> probability(kT + 1, 0.0);
    for (int i = 0; i < kT * kSub; ++i) {
      const double theta = range * (i + 0.5) / (kT * kSub);
      for (int j = 0; j < kPhi; ++j) {
        const Eigen::Vector3d h = Direction(theta, 2 * kPi * (j + 0.5) / kPhi);
        const double cos_d = wo.dot(h);
        if (cos_d <= 0.0) continue;
        probability[i / kSub] += sampler.Pdf(wo, 2.0 * cos_d * h - wo) * 4.0 *
                                 cos_d * std::sin(theta) * range / (kT * kSub) *
                                 2 * kPi / kPhi;
      }
    }
    probability[kT] = 1.0;
    for (int i = 0; i < kT; ++i) probability[kT] -= probability[i];
    std::vector<int64_t> counts(kT + 1, 0);
    std::mt19937_64 rng(5);
    std::uniform_real_distribution<double> u(0.0, 1.0);
    for (int64_t k = 0; k < kCount; ++k) {
      const double u1 = u(rng), u2 = u(rng), u3 = u(rng);
      const Eigen::Vector3d h =
          (sampler.Draw(wo, u1, u2, u3).wi + wo).normalized();
      const double theta = std::atan2(std::hypot(h.x(), h.y()), h.z());
      ++counts[std::min(static_cast<int>(theta / range * kT), kT)];
    }
    EXPECT_GT(ChiSquareTest(counts, probability).p_value, kLevel) << degrees;
  }
}

TEST(BrdfSampler, SamplesCarryThePdfOfTheirDirection) {
  std::mt19937_64 rng(3);
  std::uniform_real_distribution<double> u(0.0, 1.0);
  for (const Case& c : Cases()) {
    const BrdfSampler sampler(c.brdf);
    for (const double degrees : kViews) {
      const Eigen::Vector3d wo = View(degrees);
      int below = 0;
      for (int k = 0; k < 2000; ++k) {
        const double u1 = u(rng), u2 = u(rng), u3 = u(rng);
        const BrdfSampler::Sample s = sampler.Draw(wo, u1, u2, u3);
        ASSERT_NEAR(s.wi.norm(), 1.0, 1e-12);
        ASSERT_TRUE(std::isfinite(s.pdf));
        ASSERT_EQ(s.pdf, sampler.Pdf(wo, s.wi));
        below += s.wi.z() <= 0.0;
        if (s.wi.z() > 0.0) {
          ASSERT_GT(s.pdf, 0.0);
        }
      }
      EXPECT_EQ(below, 0) << c.name << " " << degrees;
    }
  }
}

TEST(BrdfSampler, MonteCarloAlbedoAgreesWithQuadrature) {
  std::mt19937_64 rng(9);
  std::uniform_real_distribution<double> u(0.0, 1.0);
  constexpr int kCount = 20000;
  for (const Case& c : Cases()) {
    const BrdfSampler sampler(c.brdf);
    for (const double degrees : {0.0, 30.0, 61.7, 80.0}) {
      const Eigen::Vector3d wo = View(degrees);
      std::vector<HalfDiff> angles;
      std::vector<double> weight;
      for (int k = 0; k < kCount; ++k) {
        const double u1 = u(rng), u2 = u(rng), u3 = u(rng);
        const BrdfSampler::Sample s = sampler.Draw(wo, u1, u2, u3);
        angles.push_back(ToHalfDiff(s.wi, wo));
        weight.push_back(s.wi.z() / s.pdf);
      }
      const std::vector<Eigen::Array3d> f = c.brdf(angles);
      double sum = 0.0, squares = 0.0;
      for (int k = 0; k < kCount; ++k) {
        const double value = f[k].mean() * weight[k];
        sum += value;
        squares += value * value;
      }
      const double mean = sum / kCount;
      const double deviation = std::sqrt(squares / kCount - mean * mean);
      const double expected =
          AlbedoRule(degrees * kPi / 180.0).Albedo(c.brdf).mean();
      // Four standard errors for sixteen draws, and the quadrature's own error.
      EXPECT_NEAR(mean, expected,
                  4.0 * deviation / std::sqrt(kCount) + 1e-3 * expected)
          << c.name << " " << degrees;
      // What importance sampling is for.
      EXPECT_LT(deviation, 0.8 * mean) << c.name << " " << degrees;
    }
  }
}

TEST(BrdfSampler, ExtremeMaterialsStayFinite) {
  const auto constant = [](double value) {
    return BatchOf([value](double, double, double) {
      return Eigen::Array3d(Eigen::Array3d::Constant(value));
    });
  };
  for (const BrdfBatch& brdf :
       {constant(0.0), constant(1e-300), constant(1e300), constant(-1.0),
        constant(std::nan("")), BatchOf(Gloss(1e-4, 0.0).Function())}) {
    const BrdfSampler sampler(brdf);
    std::mt19937_64 rng(3);
    std::uniform_real_distribution<double> u(0.0, 1.0);
    for (const double degrees : kViews) {
      for (int k = 0; k < 200; ++k) {
        const double u1 = u(rng), u2 = u(rng), u3 = u(rng);
        const BrdfSampler::Sample s = sampler.Draw(View(degrees), u1, u2, u3);
        ASSERT_TRUE(std::isfinite(s.pdf) && s.wi.allFinite());
        ASSERT_GT(s.pdf, 0.0);
      }
    }
  }
  // Corners of the unit cube of random numbers.
  const BrdfSampler sampler(BatchOf(Gloss(0.04, 0.3).Function()));
  const double one = std::nextafter(1.0, 0.0);
  for (int k = 0; k < 8; ++k) {
    const BrdfSampler::Sample s = sampler.Draw(
        View(61.7), k & 1 ? one : 0.0, k & 2 ? one : 0.0, k & 4 ? one : 0.0);
    EXPECT_TRUE(std::isfinite(s.pdf) && s.wi.allFinite());
  }
}

}  // namespace
}  // namespace ibrdf
