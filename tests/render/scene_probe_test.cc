#include "ibrdf/render/scene_probe.h"

#include <gtest/gtest.h>

#include <cmath>

#include "tests/render/render_testing.h"
#include "tests/render/shadow_testing.h"

namespace ibrdf {
namespace {
using namespace testing;  // NOLINT

TEST(SceneProbe, SphereCastsNoRay) {
  const SceneProbe probe =
      ProbeScene(Scene::UnitSphere(), SpherePoints(20), {});
  EXPECT_EQ(0, probe.rays);
  EXPECT_EQ(0.0, probe.hidden_max);
  const Image map = SmoothMap(16, 32);
  const BrdfGrid matte = BrdfGrid::FromFunction(Lambertian(0.5), {24, 12, 8});
  EXPECT_EQ(0.0, PredictShadowWorth(Scene::UnitSphere(), SpherePoints(20),
                                    {{&map, &matte}}, {})
                     .log_error);
}

TEST(SceneProbe, BallOfTrianglesIsConvex) {
  const Scene scene = Scene::FromMesh(BallMesh(24, 0.8)).value();
  const auto points =
      FindShadingPoints(scene, Camera(), 30, 30, Mask(), 1).value();
  const SceneProbe probe = ProbeScene(scene, points, {});
  EXPECT_EQ(384, probe.points);
  // Normals turned to the viewer at the silhouette may see a facet.
  EXPECT_LT(probe.hidden_mean, 1e-3);
}

// Every point of the floor beside an endless wall of height 1 at distance 1.
TEST(SceneProbe, HiddenShareOfAWallIsTheClosedForm) {
  TriangleMesh mesh;
  AddQuad({{0, -500, 0}, {0, 500, 0}, {0, 500, 1}, {0, -500, 1}}, &mesh);
  const Scene scene = Scene::FromMesh(mesh).value();
  std::vector<ShadingPoint> points;
  for (int i = 0; i < 20; ++i) {
    ShadingPoint p = PointAt(0, 0);
    p.position = {i % 4 == 0 ? 5000.0 : 1.0, 0.1 * i, 0};
    p.index = i;
    points.push_back(p);
  }
  SceneProbeOptions options;
  options.rays_per_point = 2000;
  const SceneProbe probe = ProbeScene(scene, points, options);
  const double hidden = 0.5 - 0.5 / std::sqrt(2.0);
  EXPECT_EQ(40000, probe.rays);
  EXPECT_NEAR(hidden, probe.hidden_max, 5e-3);
  EXPECT_NEAR(hidden, probe.hidden_90, 5e-3);
  EXPECT_NEAR(0.75 * hidden, probe.hidden_mean, 5e-3);
  EXPECT_NEAR(0.75, probe.shadowed_share, 1e-12);
  // Constant light on a matte floor: the hidden share is lost.
  const Image map = ConstantMap(16, 32, 2.0f);
  const BrdfGrid matte = BrdfGrid::FromFunction(Lambertian(0.5), {24, 12, 8});
  const ShadowWorth worth =
      PredictShadowWorth(scene, points, {{&map, &matte}}, {});
  EXPECT_NEAR(-0.75 * std::log(1 - hidden), worth.log_error, 5e-3);
  EXPECT_GT(worth.seconds, 0.0);
}

TEST(SceneProbe, WorstLookCountsAndThreadsDoNot) {
  const Scene scene = Scene::FromMesh(TorusMesh(32, 16)).value();
  const auto points =
      FindShadingPoints(scene, TorusCamera(), 30, 30, Mask(), 1).value();
  const Image soft = ConstantMap(16, 32, 1.0f);
  Image hard = ConstantMap(16, 32, 0.01f);  // a low sun: long shadows
  std::fill_n(hard.At(2, 6), 3, 1e4f);
  const BrdfGrid matte = BrdfGrid::FromFunction(Lambertian(0.5), {24, 12, 8});
  SceneProbeOptions one;
  one.num_threads = 1;
  const double soft_error =
      PredictShadowWorth(scene, points, {{&soft, &matte}}, one).log_error;
  const ShadowWorth both = PredictShadowWorth(
      scene, points, {{&soft, &matte}, {&hard, &matte}}, one);
  EXPECT_GT(soft_error, 0.05);
  EXPECT_GT(both.log_error, soft_error);
  EXPECT_EQ(1, both.look);
  EXPECT_EQ(
      both.log_error,
      PredictShadowWorth(scene, points, {{&soft, &matte}, {&hard, &matte}}, {})
          .log_error);
  EXPECT_EQ(ProbeScene(scene, points, one).hidden_mean,
            ProbeScene(scene, points, {}).hidden_mean);
}

}  // namespace
}  // namespace ibrdf
