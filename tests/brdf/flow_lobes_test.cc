#include "ibrdf/brdf/flow_lobes.h"

#include <gtest/gtest.h>

#include <cmath>
#include <vector>

#include "ibrdf/base/pi.h"
#include "ibrdf/brdf/flow_brdf.h"
#include "ibrdf/brdf/merl_columns.h"
#include "ibrdf/geometry/half_diff.h"
#include "tests/support/tiny_model.h"

namespace ibrdf {
namespace {

const double kFirst = MerlThetaH(0), kLast = MerlThetaD(kMerlThetaD - 1);

// Angles of a point of the cube.
HalfDiff AnglesOf(const Eigen::Vector3d& x) {
  const double theta_d = x[1] * (kPi / 2), phi_d = x[2] * kPi;
  return {x[0] * x[0] * ThetaHBound(theta_d, phi_d), theta_d, phi_d};
}

TEST(WithinMerlBins, KeepsThePointsThatATableHas) {
  for (const double theta_h : {kFirst, 0.1, 0.5}) {
    for (const double theta_d : {0.0, 0.3, kLast}) {
      const double phi_d = theta_d > 1.0 ? 1.5 : 0.7;
      const Eigen::Vector3d x = ToUnitCube(theta_h, theta_d, phi_d);
      EXPECT_TRUE(WithinMerlBins(x).isApprox(x, 1e-12)) << x.transpose();
    }
  }
}

TEST(WithinMerlBins, MovesTheOthersToTheNearestBin) {
  for (const double x_h : {0.0, 1e-4}) {
    for (const double x_d : {0.0, 0.4, 0.97, 1.0}) {
      for (const double x_p : {0.0, 0.3, 0.5}) {
        const HalfDiff a = AnglesOf(WithinMerlBins({x_h, x_d, x_p}));
        EXPECT_NEAR(kFirst, a.theta_h, 1e-9 * kFirst) << x_d << " " << x_p;
        EXPECT_NEAR(std::min(x_d * kPi / 2, kLast), a.theta_d, 1e-12);
        EXPECT_NEAR(x_p * kPi, a.phi_d, 1e-12);
      }
    }
  }
  // Where light and view are grazing, theta_h is kept relative to its bound.
  const Eigen::Vector3d grazing = WithinMerlBins({0.6, 1.0, 0.25});
  EXPECT_EQ(0.6, grazing[0]);
  EXPECT_NEAR(kLast / (kPi / 2), grazing[1], 1e-12);
  EXPECT_EQ(0.25, grazing[2]);
}

// Strongly curved: the density changes by a multiple beyond the bins.
class FlowBeyondTheBinsTest : public ::testing::Test {
 protected:
  const NeuralBrdfModel model_ = TinyModel(1, 3, 40.0f);
  const std::vector<double> lobes_ = MaterialLobes(model_, 0);
  const FlowBrdf brdf_{model_, lobes_.data(), 3, 1};

  Eigen::Array3d At(double theta_h, double theta_d, double phi_d) const {
    return brdf_.Evaluate({{theta_h, theta_d, phi_d}})[0];
  }
};

TEST_F(FlowBeyondTheBinsTest, IsConstant) {
  for (const double theta_d : {0.0, 0.5, 1.2}) {
    const Eigen::Array3d first = At(kFirst, theta_d, 1.0);
    EXPECT_TRUE(At(0.0, theta_d, 1.0).isApprox(first, 1e-5)) << theta_d;
    EXPECT_TRUE(At(0.1 * kFirst, theta_d, 1.0).isApprox(first, 1e-5));
  }
}

TEST_F(FlowBeyondTheBinsTest, GridsHaveTheSameNodes) {
  const BrdfGridShape shape = {9, 6, 4};
  const FlowLobes lobes(model_, 3, shape, 1);
  const BrdfGrid grid = lobes.Grid(lobes_.data());
  for (int node = 0; node < shape.num_nodes(); ++node) {
    const Eigen::Vector3d x = shape.NodePoint(node);
    // There theta_h has no room: the bound is 0.
    if (x[1] == 1.0 && x[0] > 0.0) continue;
    const HalfDiff a = AnglesOf(x);
    const Eigen::Array3d f = At(a.theta_h, a.theta_d, a.phi_d);
    for (int c = 0; c < 3; ++c) {
      EXPECT_NEAR(f[c], grid.Channel(c)[node], 2e-3 * f[c]) << node;
    }
  }
}

}  // namespace
}  // namespace ibrdf
