#include "ibrdf/brdf/brdf_grid.h"

#include <gtest/gtest.h>

#include <Eigen/Geometry>
#include <cmath>
#include <random>

#include "ibrdf/base/pi.h"
#include "ibrdf/geometry/half_diff.h"

namespace ibrdf {
namespace {

// f = 0.1 (c + 1) (1 + theta_h) in every valid bin, invalid ones marked.
MerlTable RampTable() {
  MerlTable table;
  table.raw.resize(size_t{3} * kMerlBins);
  for (int i = 0; i < kMerlThetaH; ++i) {
    for (int j = 0; j < kMerlThetaD; ++j) {
      for (int k = 0; k < kMerlPhiD; ++k) {
        for (int c = 0; c < 3; ++c) {
          table.raw[static_cast<size_t>(c) * kMerlBins +
                    MerlTable::Bin(i, j, k)] =
              MerlBinAboveHorizon(i, j, k)
                  ? 0.1 * (c + 1) * (1 + MerlThetaH(i)) / kMerlScale[c]
                  : -1.0;
        }
      }
    }
  }
  return table;
}

TEST(MerlTable, InterpolationReturnsBinCentresAndIsReciprocal) {
  const MerlTable table = RampTable();
  std::mt19937 rng(5);
  std::uniform_real_distribution<double> u(0.0, 1.0);
  for (int i = 0; i < kMerlThetaH; i += 7) {
    for (int j = 0; j < kMerlThetaD; j += 5) {
      for (int k = 0; k < kMerlPhiD; k += 11) {
        if (!MerlBinAboveHorizon(i, j, k)) continue;
        const Eigen::Array3d f =
            InterpolateMerl(table, MerlThetaH(i), MerlThetaD(j), MerlPhiD(k));
        EXPECT_NEAR(0.2 * (1 + MerlThetaH(i)), f[1], 1e-10);
      }
    }
  }
  for (int n = 0; n < 500; ++n) {
    const auto direction = [&] {
      const double t = 1.5 * u(rng), p = 2 * kPi * u(rng);
      return Eigen::Vector3d(std::sin(t) * std::cos(p),
                             std::sin(t) * std::sin(p), std::cos(t));
    };
    const Eigen::Vector3d wi = direction(), wo = direction();
    const HalfDiff a = ToHalfDiff(wi, wo), b = ToHalfDiff(wo, wi);
    EXPECT_NEAR(InterpolateMerl(table, a.theta_h, a.theta_d, a.phi_d)[0],
                InterpolateMerl(table, b.theta_h, b.theta_d, b.phi_d)[0], 1e-9);
  }
}

TEST(BrdfGrid, NodeAnglesAndCubeCoordinatesAreInverse) {
  const BrdfGridShape shape;
  for (int node = 0; node < shape.num_nodes(); node += 37) {
    const Eigen::Vector3d x = shape.NodePoint(node);
    if (x[1] > 0.999) continue;  // theta_h's range is empty at theta_d = pi/2
    const Eigen::Vector3d a = shape.NodeAngles(node);
    const Eigen::Vector3d y = ToUnitCube(a[0], a[1], a[2]);
    EXPECT_LT((x - y).norm(), 1e-10);
    const BrdfGridTaps taps = GridTaps(shape, y);
    double own = 0.0, sum = 0.0;
    for (int k = 0; k < 8; ++k) {
      sum += taps.weight[k];
      if (taps.node[k] == node) own += taps.weight[k];
    }
    EXPECT_NEAR(1.0, sum, 1e-12);
    EXPECT_NEAR(1.0, own, 1e-8);
  }
}

TEST(BrdfGrid, InterpolatesTrilinearFunctionsExactlyAndWrapsPhi) {
  const BrdfGridShape shape{9, 5, 6};
  const auto f = [](const Eigen::Vector3d& x) {
    return (1 + x[0]) * (2 - x[1]) + x[0] * x[1];
  };
  BrdfGrid grid(shape);
  for (int node = 0; node < shape.num_nodes(); ++node) {
    const double v = f(shape.NodePoint(node));
    for (int c = 0; c < 3; ++c) {
      grid.Channel(c)[node] = static_cast<float>(v * (c + 1));
    }
  }
  std::mt19937 rng(6);
  std::uniform_real_distribution<double> u(0.0, 1.0);
  for (int i = 0; i < 1000; ++i) {
    const double theta_d = 1.57 * u(rng), phi_d = kPi * u(rng);
    const double theta_h = u(rng) * ThetaHBound(theta_d, phi_d);
    const Eigen::Array3d e = grid.Evaluate(theta_h, theta_d, phi_d);
    const double expected = f(ToUnitCube(theta_h, theta_d, phi_d));
    EXPECT_NEAR(expected, e[0], 1e-6);  // float nodes
    EXPECT_NEAR(3 * expected, e[2], 3e-6);
    EXPECT_NEAR(e[1], grid.Evaluate(theta_h, theta_d, phi_d + kPi)[1], 1e-6);
  }
  // Halfway between the last and the first node of phi.
  BrdfGrid ramp(shape);
  for (int node = 0; node < shape.num_nodes(); ++node) {
    ramp.Channel(0)[node] = static_cast<float>(node % shape.p);
  }
  EXPECT_NEAR(2.5, ramp.Evaluate(0.1, 0.3, (5.5 / 6) * kPi)[0], 1e-6);
}

TEST(BrdfGrid, TakesMerlTablesAndFillsBinsBelowTheHorizon) {
  const MerlTable table = RampTable();
  const BrdfGrid grid = BrdfGrid::FromMerl(table, {});
  for (int node = 0; node < grid.shape.num_nodes(); ++node) {
    const Eigen::Vector3d a = grid.shape.NodeAngles(node);
    const double f = grid.Channel(0)[node];
    // Invalid bins are replaced by smaller theta_h, so a growing f is
    // underestimated; the first bin's centre clamps.
    EXPECT_LT(f, 0.1 * (1 + a[0]) + 1e-5);
    EXPECT_GE(f, 0.1);
    // Two bins of theta_h, 0.07 rad, are lost at most, but beside
    // phi_d = pi/2, where the bound is a cusp narrower than a bin of phi_d.
    if (std::abs(std::cos(a[2])) > 0.1) {
      EXPECT_NEAR(0.1 * (1 + a[0]), f, 0.1 * 0.07);
    }
    EXPECT_GT(grid.Channel(2)[node], 0.29f);
  }
}

}  // namespace
}  // namespace ibrdf
