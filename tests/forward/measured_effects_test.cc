#include "ibrdf/solvers/forward/measured_effects.h"

#include <gtest/gtest.h>

#include "ibrdf/light/environment_map.h"
#include "tests/support/render_testing.h"
#include "tests/support/shadow_testing.h"

namespace ibrdf {
namespace {
using namespace testing;  // NOLINT

// A mirror-like torus in itself.
class MeasuredEffects : public ::testing::Test {
 protected:
  MeasuredEffects() {
    scene_.view.scene = Scene::FromMesh(UnitTorusMesh(48, 24)).value();
    scene_.view.points =
        FindShadingPoints(scene_.view.scene, TorusCamera(), 16, 16, Mask(), 1)
            .value();
    scene_.map = SmoothMap(32, 64);
    scene_.brdf.function = Glossy(0.0, 0.9, 2.0);
    scene_.grid = scene_.brdf.Grid();
    all_.visibility = true;
    all_.bounces = kMostBounces;
  }
  SceneRadiance With(const EffectsPlan& effects,
                     RenderQuality quality = RenderQuality::kPreview) const {
    return SceneRadiance(scene_, points_, effects,
                         SceneRadianceOptions::Of(quality, 2));
  }
  std::vector<double> Render(const SceneRadiance& radiance) const {
    std::vector<double> L_o(3 * points_.size());
    EXPECT_TRUE(radiance.Render(points_, nullptr, L_o.data()));
    return L_o;
  }

  ForwardScene scene_;
  const std::vector<ShadingPoint>& points_ = scene_.view.points;
  EffectsPlan all_;
};

TEST_F(MeasuredEffects, WorthIsTheDifferenceOfWholeImages) {
  SceneRadiance all = With(all_);
  const SceneRadiance bare = With({});
  const OmissionErrors omission = MeasureEffects(bare, points_, &all);
  EXPECT_EQ(kMostBounces, all.bounces());
  // All points are looked at here.
  ASSERT_LE(points_.size(), 384u);
  const std::vector<double> full = Render(all);
  EXPECT_NEAR(MeanAbsLogRatio(Render(bare), full), omission.unshadowed, 1e-12);
  for (int b = 0; b < kMostBounces; ++b) {
    all.set_bounces(b);
    EXPECT_NEAR(MeanAbsLogRatio(Render(all), full), omission.bounces[b], 1e-12);
  }
  EXPECT_GT(omission.bounces[0], omission.bounces[1]);
}

// A map of more cells than a transport takes lights the object like a smaller
// one.
TEST_F(MeasuredEffects, MapsWhoseSidesDoNotHalveLightTheObject) {
  all_.bounces = 1;
  const Image large = SmoothMap(450, 900);
  const Image small = ResizeMap(large, 256, 512);
  const auto render = [&](const Image& map) {
    scene_.map = map;
    return Render(With(all_));
  };
  EXPECT_LT(MeanAbsLogRatio(render(large), render(small)), 1e-3);
}

TEST_F(MeasuredEffects, RaysAreAsManyAsTheErrorAsksFor) {
  all_.bounces = 1;
  SceneRadiance few = With(all_);
  const int first = few.lobe_rays();
  ASSERT_LT(first, SceneRadiance::kMostLobeRays);
  const double change = ChooseLobeRays(points_, 1e9, &few);
  EXPECT_EQ(first, few.lobe_rays());
  const std::vector<double> with_few = Render(few);

  SceneRadiance many = With(all_);
  ChooseLobeRays(points_, 0.0, &many);
  EXPECT_EQ(SceneRadiance::kMostLobeRays, many.lobe_rays());
  const std::vector<double> with_many = Render(many);
  if (2 * first == SceneRadiance::kMostLobeRays) {
    EXPECT_NEAR(MeanAbsLogRatio(with_few, with_many), change, 1e-12);
  }
  // What it says is about what the image is off by.
  const SceneRadiance reference = With(all_, RenderQuality::kReference);
  const double error = MeanAbsLogRatio(with_few, Render(reference));
  EXPECT_LT(MeanAbsLogRatio(with_many, Render(reference)), error);
  EXPECT_LT(change, 2.0 * error);
  EXPECT_GT(change, 0.3 * error);
}

}  // namespace
}  // namespace ibrdf
