#include "ibrdf/transport/lobe_bundles.h"

#include <gtest/gtest.h>

#include <cmath>
#include <random>

#include "tests/support/render_testing.h"

namespace ibrdf {
namespace {
using testing::Glossy;
using testing::Lambertian;

// Lobes exp(-tan^2 / (2 w^2)) fall to half at tan = w sqrt(2 log 2).
TEST(LobeBundles, HalfWidthOfGaussianSlopesIsTheClosedForm) {
  for (const double degrees : {0.3, 2.0, 10.0}) {
    const double width = degrees * kPi / 180;
    const double expected = std::atan(width * std::sqrt(2 * std::log(2.0)));
    EXPECT_NEAR(expected, LobeHalfWidth(Glossy(0.0, 1.0, degrees)),
                0.02 * expected);
  }
}

TEST(LobeBundles, MatteAndBlackNeverFall) {
  EXPECT_GT(LobeHalfWidth(Glossy(3.0, 1.0, 10)),
            LobeHalfWidth(Glossy(0.0, 1.0, 10)));
  EXPECT_DOUBLE_EQ(kPi / 2, LobeHalfWidth(Lambertian(0.5)));
  EXPECT_DOUBLE_EQ(kPi / 2, LobeHalfWidth(Lambertian(0.0)));
}

// Directions of a lobe around +z with weights that differ a thousandfold.
TEST(LobeBundles, AreCompactAndOfEqualWeight) {
  std::mt19937 rng(1);
  std::normal_distribution<float> normal(0.0f, 0.05f);
  std::vector<Eigen::Vector3f> directions;
  std::vector<float> weights;
  double all = 0.0;
  for (int i = 0; i < 4000; ++i) {
    const Eigen::Vector3f d(normal(rng), normal(rng), 1.0f);
    directions.push_back(d.normalized());
    weights.push_back(std::exp(-50.0f * d.head<2>().norm()));
    all += weights.back();
  }
  constexpr int kCount = 16;
  const LobeBundles bundles = BundleDirections(directions, weights, kCount);
  ASSERT_EQ(size_t{kCount}, bundles.means.size());
  std::vector<double> sum(kCount);
  std::vector<Eigen::Vector3d> mean(kCount, Eigen::Vector3d::Zero());
  double spread = 0.0, whole = 0.0;
  for (size_t i = 0; i < directions.size(); ++i) {
    const int b = bundles.of[i];
    sum[b] += weights[i];
    mean[b] += weights[i] * directions[i].cast<double>();
    spread += weights[i] * (directions[i] - bundles.means[b]).squaredNorm();
    whole +=
        weights[i] * (directions[i] - Eigen::Vector3f::UnitZ()).squaredNorm();
  }
  for (int b = 0; b < kCount; ++b) {
    EXPECT_NEAR(1.0 / kCount, sum[b] / all, 0.1 / kCount) << b;
    EXPECT_LT((mean[b].normalized() - bundles.means[b].cast<double>()).norm(),
              1e-5);
  }
  // Sixteen slices across one axis would leave half.
  EXPECT_LT(spread, whole / 4);
}

TEST(LobeBundles, FewDirectionsAndNoWeightsAreDefined) {
  const std::vector<Eigen::Vector3f> one = {Eigen::Vector3f::UnitX()};
  const LobeBundles lone = BundleDirections(one, {1.0f}, 4);
  ASSERT_EQ(4u, lone.means.size());
  EXPECT_EQ(one[0], lone.means[lone.of[0]]);
  int empty = 0;
  for (const Eigen::Vector3f& m : lone.means) empty += m.isZero() ? 1 : 0;
  EXPECT_EQ(3, empty);
  const LobeBundles dark = BundleDirections(one, {0.0f}, 1);
  EXPECT_LT((dark.means[0] - one[0]).norm(), 1e-6f);
  EXPECT_TRUE(BundleDirections({}, {}, 2).means[1].isZero());
}

}  // namespace
}  // namespace ibrdf
