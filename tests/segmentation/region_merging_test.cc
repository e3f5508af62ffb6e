#include "ibrdf/solvers/segmentation/region_merging.h"

#include <gtest/gtest.h>

#include "ibrdf/solvers/segmentation/label_overlap.h"
#include "labelled_ball.h"

namespace ibrdf {
namespace {

TEST(MergeRegions, BringsPatchesOfOneMaterialTogether) {
  const LabelledBall ball = MakeLabelledBall(
      64, 0.01, [](int x, int y) { return (x / 16 + y / 16) % 2; });
  const MaterialPixels pixels =
      GatherPixels(ball.points, ball.Observed(), ball.width, 1);
  const std::vector<Labelling> merged = MergeRegions(pixels, MergeSetting(), 3);
  ASSERT_EQ(2u, merged.size());
  EXPECT_EQ(3, merged[0].count);
  EXPECT_EQ(2, merged[1].count);
  Labelling truth{std::vector<int>(pixels.count()), 2};
  for (size_t i = 0; i < ball.points.size(); ++i) {
    const int pixel = pixels.pixel_of_point[i];
    if (pixel >= 0) truth.labels[pixel] = ball.labels[i];
  }
  // All but small regions, which have no label yet.
  Labelling seen = merged[1], true_of_seen = truth;
  seen.labels.clear();
  true_of_seen.labels.clear();
  for (int i = 0; i < pixels.count(); ++i) {
    if (merged[1].labels[i] < 0) continue;
    seen.labels.push_back(merged[1].labels[i]);
    true_of_seen.labels.push_back(truth.labels[i]);
  }
  EXPECT_GT(seen.labels.size(), 0.9 * pixels.count());
  EXPECT_EQ(1.0, Agreement(seen, true_of_seen));
}

TEST(MergeRegions, OneRegionIsNoLabelling) {
  const LabelledBall ball =
      MakeLabelledBall(32, 0.005, [](int, int) { return 0; });
  const MaterialPixels pixels =
      GatherPixels(ball.points, ball.Observed(), ball.width, 1);
  EXPECT_TRUE(MergeRegions(pixels, {0.5, 2, 0.15}, 5).empty());
}

}  // namespace
}  // namespace ibrdf
