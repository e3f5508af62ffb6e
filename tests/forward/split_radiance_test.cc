#include "ibrdf/solvers/forward/split_radiance.h"

#include <gtest/gtest.h>

#include <vector>

#include "tests/support/render_testing.h"

namespace ibrdf {
namespace {
using namespace testing;  // NOLINT

// A mirror-like sphere that is matte beneath, in light with detail.
class SplitRadianceTest : public ::testing::Test {
 protected:
  SplitRadianceTest() {
    scene_.view.points =
        FindShadingPoints(scene_.view.scene, Camera(), 64, 64, Mask(), 1)
            .value();
    scene_.map = RandomMap(32, 64, 1);
    scene_.brdf.function = Glossy(0.3, 0.05, 2.0);
    radiance_.emplace(scene_, points_, EffectsPlan(),
                      SceneRadianceOptions::Of(RenderQuality::kPreview, 2));
  }
  std::vector<double> Render(const RadianceRenderer& renderer,
                             const std::vector<ShadingPoint>& points) const {
    std::vector<double> L_o(3 * points.size());
    EXPECT_TRUE(renderer.Render(points, nullptr, L_o.data()));
    return L_o;
  }

  ForwardScene scene_;
  const std::vector<ShadingPoint>& points_ = scene_.view.points;
  std::optional<SceneRadiance> radiance_;
};

TEST_F(SplitRadianceTest, IsTheRadianceWithinTheErrorAskedFor) {
  const std::vector<double> whole = Render(*radiance_, points_);
  SplitRadiance split(*radiance_, scene_.brdf);
  EXPECT_EQ(whole, Render(split, points_));
  for (const double log_error : {1e-2, 1e-3}) {
    ASSERT_TRUE(split.Fit(points_, nullptr, log_error).ok());
    ASSERT_TRUE(split.fitted());
    const std::vector<double> L_o = Render(split, points_);
    EXPECT_NE(whole, L_o);  // something was interpolated
    EXPECT_LE(MeanAbsLogRatio(L_o, whole), log_error);
  }
}

// A mirror's detail is not in what is interpolated: other normals have it too.
TEST_F(SplitRadianceTest, ServesOtherPoints) {
  SplitRadiance split(*radiance_, scene_.brdf);
  ASSERT_TRUE(split.Fit(points_, nullptr, 1e-3).ok());
  std::vector<ShadingPoint> others;
  for (const double theta : {0.0, 0.3, 0.8, 1.2, 1.4}) {
    for (int k = 0; k < 12; ++k)
      others.push_back(PointAt(theta, 0.1 + 0.5 * k));
  }
  EXPECT_LE(MeanAbsLogRatio(Render(split, others), Render(*radiance_, others)),
            2e-3);
}

TEST_F(SplitRadianceTest, AFitThatIsStoppedLeavesItWhole) {
  SplitRadiance split(*radiance_, scene_.brdf);
  int calls = 0;
  const Status fit = split.Fit(
      points_, [&calls](double) { return ++calls < 2; }, 1e-3);
  EXPECT_EQ(StatusCode::kInterrupted, fit.code());
  EXPECT_EQ(2, calls);
  EXPECT_FALSE(split.fitted());
  EXPECT_EQ(Render(*radiance_, points_), Render(split, points_));
  ASSERT_TRUE(split.Fit(points_, nullptr, 1e-3).ok());
  std::vector<double> L_o(3 * points_.size());
  EXPECT_FALSE(split.Render(
      points_, [](double) { return false; }, L_o.data()));
}

}  // namespace
}  // namespace ibrdf
