#include "ibrdf/uncertainty/band_limit.h"

#include <gtest/gtest.h>

#include <cmath>
#include <vector>

namespace ibrdf {
namespace {

TEST(LeastAlpha, IsWhereALobeHalvesTheHighestDegree) {
  const double alpha = LeastAlpha(400);
  EXPECT_NEAR(0.0416, alpha, 1e-4);
  // Eq. 28 at l* = 20.
  EXPECT_NEAR(0.5, std::exp(-alpha * 20 * alpha * 20), 1e-12);
}

TEST(ViewsForRoughness, IsTheInverse) {
  for (const int views : {1, 7, 60, 400}) {
    EXPECT_EQ(views, ViewsForRoughness(std::sqrt(LeastAlpha(views))));
  }
  EXPECT_GT(ViewsForRoughness(0.1), ViewsForRoughness(0.2));
  EXPECT_GT(ViewsForRoughness(1e-6), 0);
}

TEST(PrefilterAlpha, RoundsTheDegreeDown) {
  EXPECT_DOUBLE_EQ(0.1, PrefilterAlpha(100));
  EXPECT_DOUBLE_EQ(1.0 / 7.0, PrefilterAlpha(60));
  EXPECT_DOUBLE_EQ(1.0, PrefilterAlpha(1));
}

TEST(BelowBandLimit, NeedsEveryChannelToMisfitAndMoreThanNoise) {
  EntropyMaps maps;
  maps.Resize(3);
  maps.misfit = {0.5f, 0.5f, 0.5f, 0.5f, 0.5f, 0.05f, 0.5f, 0.5f, 0.5f};
  maps.deviations = {9.0f, 9.0f, 9.0f, 9.0f, 9.0f, 9.0f, 9.0f, 1.0f, 9.0f};
  EXPECT_EQ((std::vector<uint8_t>{1, 0, 0}), BelowBandLimit(maps));
}

}  // namespace
}  // namespace ibrdf
