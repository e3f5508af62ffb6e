#include "ibrdf/brdf/matte_split.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>

namespace ibrdf {
namespace {

constexpr BrdfGridShape kShape = {24, 12, 6};

BrdfGrid GlossOn(double matte, double gloss) {
  return BrdfGrid::FromFunction(
      [&](double theta_h, double, double) -> Eigen::Array3d {
        const double lobe = gloss * std::exp(-theta_h * theta_h / 0.02);
        return {matte + lobe, 0.5 * matte + lobe, lobe};
      },
      kShape);
}

TEST(MattePart, IsWhatLiesUnderAHighlight) {
  const BrdfGrid brdf = GlossOn(0.2, 3.0);
  const BrdfGrid matte = MattePart(brdf);
  for (int i = 0; i < kShape.num_nodes(); ++i) {
    EXPECT_NEAR(matte.Channel(0)[i], 0.2f, 1e-5);
    EXPECT_NEAR(matte.Channel(1)[i], 0.1f, 1e-5);
    EXPECT_NEAR(matte.Channel(2)[i], 0.0f, 1e-5);
  }
}

// Light that cloth throws back whence it came is the paint's too.
TEST(MattePart, RisesWhereAllHalfVectorsDo) {
  const BrdfGrid brdf = BrdfGrid::FromFunction(
      [](double theta_h, double theta_d, double) -> Eigen::Array3d {
        const double back = 0.3 * std::exp(-theta_d * theta_d / 0.1);
        const double gloss = std::exp(-theta_h * theta_h / 0.02);
        return Eigen::Array3d::Constant(0.2 + back + gloss);
      },
      kShape);
  const BrdfGrid matte = MattePart(brdf);
  for (int i = 0; i < kShape.num_nodes(); ++i) {
    const double theta_d = kShape.NodeAngles(i)[1];
    if (theta_d > 0.4) continue;
    EXPECT_NEAR(matte.Channel(0)[i],
                0.2 + 0.3 * std::exp(-theta_d * theta_d / 0.1), 0.01)
        << theta_d;
  }
}

TEST(MattePart, NeverExceedsTheWhole) {
  const BrdfGrid brdf = GlossOn(0.0, 1e6);
  const BrdfGrid matte = MattePart(brdf);
  for (size_t i = 0; i < brdf.values.size(); ++i) {
    EXPECT_GE(matte.values[i], 0.0f);
    EXPECT_LE(matte.values[i], brdf.values[i]);
  }
}

TEST(MattePart, OfPlasterIsAll) {
  BrdfGrid white(kShape);
  std::fill(white.values.begin(), white.values.end(), 0.3f);
  EXPECT_EQ(MattePart(white).values, white.values);
}

TEST(MattePart, OfAGridTooCoarseForItsAnglesIsOfAllNodes) {
  const BrdfGridShape shape = {2, 2, 1};
  const float field[] = {5.0f, 1.0f, 1.0f, 1.0f};
  const std::vector<float> matte = MattePart(shape, field);
  EXPECT_EQ(matte, std::vector<float>(4, 1.0f));
}

}  // namespace
}  // namespace ibrdf
