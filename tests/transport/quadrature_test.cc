#include "ibrdf/transport/quadrature.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>

#include "ibrdf/base/simd_dispatch.h"
#include "ibrdf/brdf/brdf_grid.h"
#include "tests/support/render_testing.h"

namespace ibrdf {
namespace {

TEST(Quadrature, NearShareIsASmoothStep) {
  const QuadratureOptions options;
  EXPECT_EQ(1.0, NearShare(8 * kPi / 180, options));
  EXPECT_EQ(0.0, NearShare(16.001 * kPi / 180, options));
  EXPECT_NEAR(0.5, NearShare(12 * kPi / 180, options), 1e-12);
  double last = 1.0;
  for (double d = 8; d < 16; d += 0.1) {
    const double share = NearShare(d * kPi / 180, options);
    EXPECT_LE(share, last);
    last = share;
  }
}

TEST(Quadrature, MeanClippedCosineMatchesItsIntegral) {
  for (const double a : {0.0, 0.05, 0.3}) {
    for (double c = -0.5; c < 0.6; c += 0.07) {
      double sum = 0.0;
      constexpr int kSteps = 20000;
      for (int i = 0; i < kSteps; ++i) {
        sum += std::max(c + a * (2.0 * (i + 0.5) / kSteps - 1.0), 0.0);
      }
      EXPECT_NEAR(sum / kSteps, MeanClippedCosine(c, a), 1e-8);
    }
  }
}

TEST(Quadrature, BlocksDivideTheMap) {
  EXPECT_EQ(1, FarBlockSize(32, 64, 64));
  EXPECT_EQ(2, FarBlockSize(64, 128, 64));
  EXPECT_EQ(8, FarBlockSize(256, 512, 64));
  EXPECT_EQ(1, FarBlockSize(65, 130, 64));
  EXPECT_EQ(2, FarBlockSize(50, 100, 64));
  EXPECT_EQ(32 * 64, NumFarCells(256, 512, 64));
  EXPECT_EQ(65 * 130, NumFarCells(65, 130, 64));
  EXPECT_EQ(225 * 450, NumFarCells(1800, 3600, 64));
  double sum = 0.0;
  for (const FarCell& cell : MapCells(64, 128, 4)) sum += cell.solid_angle;
  EXPECT_NEAR(4 * kPi, sum, 1e-11);
}

TEST(Quadrature, CosineWeightsAddToPiAtEveryViewAngle) {
  const std::vector<FarCell> cells = MapCells(32, 64, 1);
  const PointQuadrature quadrature(cells, {});
  PointSamples samples;
  for (double degrees = 0; degrees < 90; degrees += 0.5) {
    const ShadingPoint p = testing::PointAt(degrees * kPi / 180, 0.3);
    quadrature.Sample(p.normal.cast<double>().normalized(), p.wo.cast<double>(),
                      &samples);
    double sum = 0.0;
    for (const NearSample& s : samples.near) sum += s.weight;
    for (const FarSample& s : samples.far) {
      sum += s.weight * cells[s.cell].solid_angle;
    }
    EXPECT_NEAR(kPi, sum, 1e-9) << degrees;
    // The rule itself, before it is made exact: 20 rings and cells of 5.6
    // degrees are good to 1 % far; near to 1 % until its cap of half-vectors
    // meets the horizon.
    EXPECT_NEAR(1.0, samples.far_correction, 0.01) << degrees;
    if (degrees <= 85) {
      EXPECT_NEAR(1.0, samples.near_correction, 0.01) << degrees;
    }
  }
}

TEST(Quadrature, SamplesAgreeWithHalfDiffAngles) {
  const std::vector<FarCell> cells = MapCells(32, 64, 1);
  const PointQuadrature quadrature(cells, {});
  PointSamples samples;
  for (const double degrees : {0.0, 3.0, 40.0, 75.0, 89.0}) {
    const ShadingPoint p = testing::PointAt(degrees * kPi / 180, 1.1);
    const Eigen::Vector3d n = p.normal.cast<double>().normalized();
    const Eigen::Vector3d wo = p.wo.cast<double>();
    quadrature.Sample(n, wo, &samples);
    const Eigen::Quaterniond to_local =
        Eigen::Quaterniond::FromTwoVectors(n, Eigen::Vector3d::UnitZ());
    for (const NearSample& s : samples.near) {
      const HalfDiff a = ToHalfDiff(to_local * s.wi, to_local * wo);
      ASSERT_NEAR(a.theta_h, s.theta_h, 1e-8);
      ASSERT_NEAR(a.theta_d, s.theta_d, 1e-8);
      ASSERT_NEAR(ToUnitCube(a.theta_h, a.theta_d, a.phi_d)[0], s.x_h, 1e-6);
      // phi_d turns freely where theta_h or theta_d vanishes.
      const double dphi = std::abs(a.phi_d - s.phi_d);
      ASSERT_LT(std::min(dphi, kPi - dphi) * std::sin(a.theta_h) *
                    std::sin(a.theta_d),
                1e-8);
    }
    for (const FarSample& s : samples.far) {
      const Eigen::Vector3d wi = cells[s.cell].direction;
      if (n.dot(wi) < 0.3) continue;  // moved above the horizon
      const HalfDiff a = ToHalfDiff(to_local * wi, to_local * wo);
      ASSERT_NEAR(a.theta_h, s.theta_h, 1e-7);
      ASSERT_NEAR(a.theta_d, s.theta_d, 1e-7);
      ASSERT_NEAR(ToUnitCube(a.theta_h, a.theta_d, a.phi_d)[0], s.x_h, 1e-6);
      const double dphi = std::abs(a.phi_d - s.phi_d);
      ASSERT_LT(std::min(dphi, kPi - dphi) * std::sin(a.theta_d), 1e-6);
    }
  }
}

// Every version of the kernel against the formulas of its header, cells that
// the horizon cuts among them, and blocks of any length.
TEST(Quadrature, LevelsOfTheFarKernelAgreeWithPlainFormulas) {
  std::vector<SampleFarFunction> levels = {portable::SampleFar};
#if defined(IBRDF_HAVE_X86_KERNELS)
  if (SimdLevelSupported(SimdLevel::kAvx2)) levels.push_back(avx2::SampleFar);
  if (SimdLevelSupported(SimdLevel::kAvx512)) {
    levels.push_back(avx512::SampleFar);
  }
#endif
  const QuadratureOptions options;
  const std::vector<FarCell> cells = MapCells(16, 32, 1);
  const FarDirections directions(cells);
  const Eigen::Vector3d n = Eigen::Vector3d(0.2, 0.5, 0.8).normalized();
  FarView view{};
  view.near_begin = options.near_begin_degrees * kPi / 180;
  view.near_end = options.near_end_degrees * kPi / 180;
  Eigen::Map<Eigen::Vector3d>(view.n) = n;
  for (const double degrees : {0.0, 30.0, 89.0}) {
    const double angle = degrees * kPi / 180;
    const Eigen::Vector3d wo =
        std::cos(angle) * n + std::sin(angle) * n.unitOrthogonal();
    Eigen::Map<Eigen::Vector3d>(view.wo) = wo;
    int counted = 0, cut = 0;
    for (const SampleFarFunction level : levels) {
      for (int begin = 0; begin < directions.count(); begin += 37) {
        const int count = std::min(37, directions.count() - begin);
        FarBlock block;
        level(directions.columns(), begin, count, view, &block);
        for (int i = 0; i < count; ++i) {
          const FarCell& cell = cells[begin + i];
          const double c = n.dot(cell.direction);
          const double a =
              std::hypot(n.dot(cell.half_theta), n.dot(cell.half_phi));
          if (c <= -a) {
            ASSERT_EQ(0.0, block.weight[i]);
            continue;
          }
          if (c < 4.0 * a) {
            ++cut;
            ASSERT_TRUE(std::isfinite(block.weight[i]));
            continue;  // moved above the horizon
          }
          const Eigen::Vector3d h = (cell.direction + wo).normalized();
          const double theta_h = std::acos(std::min(n.dot(h), 1.0));
          ASSERT_NEAR(
              MeanClippedCosine(c, a) * (1.0 - NearShare(theta_h, options)),
              block.weight[i], 1e-7);
          if (block.weight[i] == 0.0) continue;
          ++counted;
          ASSERT_NEAR(theta_h, block.theta_h[i], 1e-7);
          ASSERT_NEAR(std::acos(wo.dot(h)), block.theta_d[i], 1e-7);
        }
      }
    }
    EXPECT_GT(counted, 50);
    EXPECT_GT(cut, 10);
  }
}

}  // namespace
}  // namespace ibrdf
