#include "ibrdf/render/scene_probe.h"

#include <gtest/gtest.h>

#include <cmath>

#include "tests/support/render_testing.h"
#include "tests/support/shadow_testing.h"

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
  EXPECT_EQ(0.0, PredictEffects(Scene::UnitSphere(), SpherePoints(20),
                                {{&map, &matte}}, {})
                     .unshadowed);
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
  OmissionErrors omission = PredictEffects(scene, points, {{&map, &matte}}, {});
  EXPECT_GT(omission.shadow_seconds, 0.0);
  // A black wall gives nothing back.
  const BrdfGrid black = BrdfGrid::FromFunction(Lambertian(1e-9), {24, 12, 8});
  omission = PredictEffects(scene, points, {{&map, &black}}, {});
  EXPECT_NEAR(-0.75 * std::log(1 - hidden), omission.unshadowed, 5e-3);
  EXPECT_LT(omission.bounces[0], 1e-6);
}

// The inside of half a sphere: half of all light comes from it, so that a matte
// bowl of albedo a lacks log (1 / (1 - a / 2)) without bounces and
// log (1 / (1 - (a / 2)^(b + 1))) with b.
TEST(SceneProbe, BouncesOfABowlAreWorthTheClosedForm) {
  const TriangleMesh bowl = BowlMesh(90);
  std::vector<ShadingPoint> points;
  for (int i = 0; i < 12; ++i) {
    const double theta = kPi / 2 * (1.05 + 0.07 * i);
    const Eigen::Vector3d p(std::sin(theta) * std::sin(2.0 * i),
                            std::cos(theta),
                            std::sin(theta) * std::cos(2.0 * i));
    ShadingPoint point{};
    point.normal = point.wo = -p.cast<float>();
    point.position = 0.999 * p;
    point.index = i;
    points.push_back(point);
  }
  const Image map = ConstantMap(16, 32, 1.0f);
  const double albedo = 0.6;
  const BrdfGrid matte =
      BrdfGrid::FromFunction(Lambertian(albedo), {24, 12, 8});
  const OmissionErrors omission = PredictEffects(Scene::FromMesh(bowl).value(),
                                                 points, {{&map, &matte}}, {});
  const auto sum = [&](int b) {
    return (1 - std::pow(albedo / 2, b + 1)) / (1 - albedo / 2);
  };
  for (int b = 0; b < kMostBounces; ++b) {
    EXPECT_NEAR(std::log(sum(kMostBounces) / sum(b)), omission.bounces[b], 0.01)
        << b;
  }
  EXPECT_EQ(0.0, omission.bounces[kMostBounces]);
}

TEST(SceneProbe, WorstLookCountsAndThreadsDoNot) {
  const Scene scene = Scene::FromMesh(UnitTorusMesh(32, 16)).value();
  const auto points =
      FindShadingPoints(scene, TorusCamera(), 30, 30, Mask(), 1).value();
  const Image soft = ConstantMap(16, 32, 1.0f);
  Image hard = ConstantMap(16, 32, 0.01f);  // a low sun: long shadows
  std::fill_n(hard.At(2, 6), 3, 1e4f);
  const BrdfGrid matte = BrdfGrid::FromFunction(Lambertian(0.5), {24, 12, 8});
  SceneProbeOptions one;
  one.num_threads = 1;
  const OmissionErrors gentle =
      PredictEffects(scene, points, {{&soft, &matte}}, one);
  const OmissionErrors both =
      PredictEffects(scene, points, {{&soft, &matte}, {&hard, &matte}}, one);
  // What the hole of the torus hides it gives back in part.
  EXPECT_GT(gentle.unshadowed, 0.02);
  EXPECT_GT(gentle.bounces[0], 0.02);
  EXPECT_GT(both.unshadowed, gentle.unshadowed);
  const OmissionErrors all =
      PredictEffects(scene, points, {{&soft, &matte}, {&hard, &matte}}, {});
  EXPECT_EQ(both.unshadowed, all.unshadowed);
  EXPECT_EQ(both.bounces, all.bounces);
  EXPECT_EQ(ProbeScene(scene, points, one).hidden_mean,
            ProbeScene(scene, points, {}).hidden_mean);
}

}  // namespace
}  // namespace ibrdf
