#include "ibrdf/solvers/effects/describe_plan.h"

#include <gtest/gtest.h>

namespace ibrdf {
namespace {

TEST(DescribePlan, SaysWhatIsSimulatedAndWhy) {
  EffectsPlan plan;
  plan.shape = ShapeKind::kMesh;
  plan.visibility = true;
  plan.bounces = 1;
  plan.threshold = 0.005;
  plan.probe.hidden_mean = 0.055;
  plan.probe.shadowed_share = 0.33;
  plan.omission.unshadowed = 0.0091;
  plan.omission.bounces[0] = 0.0418;
  plan.omission.shadow_seconds = 0.1;
  plan.omission.bounce_seconds = 0.2;
  EXPECT_EQ(
      "visibility, interreflection (1 bounce): the object hides 5.5 % of the "
      "light from itself, from 33 % of its points some; log radiance, mean "
      "over the image, would change by 0.0091 without shadows and bounces, and "
      "by 0.0418 with shadows alone (shadows are simulated if the first is "
      "above 0.005, bounces if both are); rays take about 0.1 s for shadows, "
      "0.2 s for bounces",
      Describe(plan));
}

TEST(DescribePlan, TellsWhoOverrulesWhatIsLeftOut) {
  EffectsPlan plan;
  plan.shape = ShapeKind::kMesh;
  plan.mode = EffectsMode::kNone;
  plan.error = 0.0264;
  const std::string text = Describe(plan);
  EXPECT_EQ(0u, text.find("none, as asked: "));
  EXPECT_NE(std::string::npos,
            text.find("; reflectance and light absorb the 0.0264 that is left "
                      "out"));
  // No ray met the object.
  EXPECT_EQ(std::string::npos, text.find("rays take"));
  plan.error = 0.0;
  EXPECT_EQ(std::string::npos, Describe(plan).find("absorb"));
}

TEST(DescribePlan, NamesShapesThatNeedNoProbe) {
  EffectsPlan plan;
  EXPECT_EQ("none: the sphere is convex, no point shadows or lights another",
            Describe(plan));
  plan.shape = ShapeKind::kNormalMap;
  EXPECT_EQ(0u, Describe(plan).find("none: a normal map has no positions"));
}

}  // namespace
}  // namespace ibrdf
