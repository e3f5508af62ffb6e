#include "ibrdf/solvers/entropy_study/study_scene.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>

#include "ibrdf/base/pi.h"
#include "ibrdf/solvers/entropy_study/brute_force.h"
#include "ibrdf/solvers/entropy_study/study_surface.h"
#include "tests/support/render_testing.h"
#include "tests/support/temp_dir.h"

namespace ibrdf {
namespace {

using testing::SmoothMap;

SceneOptions FewViews() {
  SceneOptions options;
  options.num_views = 24;
  options.samples = 64;
  options.occluders = 0.0;
  options.noise = 0.0;
  return options;
}

TEST(StudySurface, PointsAreEvenlySpreadOverTheArea) {
  const StudySurface torus = MakeStudySurface("", "torus", 400, 3).value();
  EXPECT_TRUE(torus.scene.CastsShadows());
  ASSERT_EQ(400u, torus.points.size());
  int outer = 0;
  for (const SurfacePoint& p : torus.points) {
    EXPECT_NEAR(1.0, p.normal.norm(), 1e-6);
    EXPECT_LT(p.position.norm(), 1.01);
    const double around = std::hypot(p.position.x(), p.position.z()) - 0.7;
    EXPECT_NEAR(0.3, std::hypot(around, p.position.y()), 0.01);
    outer += around > 0.0;
  }
  // The outer half of the tube has the share 1/2 + (0.3 / 0.7) / pi.
  EXPECT_NEAR(0.5 + 3.0 / 7.0 / kPi, outer / 400.0, 0.03);
}

TEST(StudySurface, ReadsMeshesAndNamesThoseThatAreMissing) {
  const TempDir dir;
  WriteBytes(dir.File("wedge.obj"),
             "v 9 0 0\nv 0 9 0\nv 0 0 9\nv 0 0 0\n"
             "f 1 2 3\nf 1 4 2\nf 2 4 3\nf 3 4 1\n");
  const auto wedge = MakeStudySurface(dir.path(), "wedge", 10, 1);
  ASSERT_TRUE(wedge.ok()) << wedge.status().message();
  double farthest = 0.0;
  for (const SurfacePoint& p : wedge->points) {
    farthest = std::max(farthest, p.position.norm());
  }
  EXPECT_LT(farthest, 1.01);
  EXPECT_GT(farthest, 0.3);
  const auto none = MakeStudySurface(dir.path(), "cow", 10, 1);
  EXPECT_EQ(2, none.status().ExitCode());
  EXPECT_NE(std::string::npos, none.status().message().find("cow"));
}

// A white sphere in a furnace: what it shows, and what brute force renders.
TEST(StudyScene, OfConstantLightIsTheFurnace) {
  Image map(64, 32);
  std::fill(map.rgb.begin(), map.rgb.end(), 5.0f);  // the unit is taken out
  const StudyScene scene = MakeStudyScene(
      MakeStudySurface("", "sphere", 20, 1).value(), map, FewViews());
  int seen = 0;
  for (int texel = 0; texel < 20; ++texel) {
    EXPECT_NEAR(1.0, scene.matte[3 * texel], 1e-3);
    EXPECT_NEAR(kPi, scene.open_irradiance[3 * texel], 1e-3);
    for (int view = 0; view < 24; ++view) {
      const size_t at = static_cast<size_t>(texel) * 24 + view;
      if (scene.samples.weight[at] == 0.0f) continue;
      ++seen;
      EXPECT_NEAR(1.0, scene.samples.incoming[3 * at], 1e-3);
      // Away from the horizon a mirror of F = 1 reflects all.
      if (scene.samples.directions[3 * at + 2] < 0.3f) continue;
      const size_t mirror = at * kBruteRoughnesses * 3;
      EXPECT_NEAR(1.0, scene.fixed[mirror] + scene.slope[mirror], 0.02);
    }
  }
  EXPECT_GT(seen, 100);
}

TEST(StudyScene, SurfacesHideCamerasAndLight) {
  const StudyScene torus =
      MakeStudyScene(MakeStudySurface("", "torus", 60, 1).value(),
                     SmoothMap(32, 64), FewViews());
  int seen = 0, facing = 0;
  for (size_t at = 0; at < torus.samples.weight.size(); ++at) {
    facing += torus.samples.directions[3 * at + 2] > 1e-3f;
    seen += torus.samples.weight[at] > 0.0f;
    const float open = torus.samples.incoming[3 * at];
    const float unhidden = torus.unhidden_incoming[3 * at];
    EXPECT_TRUE(unhidden == open || unhidden == 0.0f);
  }
  EXPECT_LT(seen, 0.95 * facing);
  EXPECT_GT(seen, 0.6 * facing);
  double matte = 0.0, rays = 0.0, open = 0.0;
  for (size_t i = 0; i < torus.matte.size(); ++i) {
    matte += torus.matte[i] * kPi;
    rays += torus.unhidden_irradiance[i];
    open += torus.open_irradiance[i];
  }
  EXPECT_NEAR(1.0, rays / matte, 0.01);
  EXPECT_GT(open / matte, 1.03);
}

// The sharp posterior of a material that is a cell of the grid is a spike.
TEST(StudyScene, BruteForceIsCertainOfWhatItSees) {
  SceneOptions options = FewViews();
  options.one_material = true;
  StudyScene scene =
      MakeStudyScene(MakeStudySurface("", "sphere", 12, 1).value(),
                     SmoothMap(32, 64), options);
  // The material of the cell (roughness 2 / 7, Ks 5 / 7, Kd 1 / 7).
  for (StudyMaterial& m : scene.materials) {
    m = {2.0 / 7.0, Eigen::Array3d(1, 1, 1) / 7.0,
         Eigen::Array3d(5, 5, 5) / 7.0};
  }
  for (size_t at = 0; at < scene.samples.weight.size(); ++at) {
    const size_t texel = at / 24;
    for (int c = 0; c < 3; ++c) {
      const size_t cell = (at * kBruteRoughnesses + 2) * 3 + c;
      scene.samples.outgoing[3 * at + c] = scene.matte[3 * texel + c] / 7.0f +
                                           scene.fixed[cell] +
                                           5.0f / 7.0f * scene.slope[cell];
    }
  }
  const BruteForce sharp = EvaluateBruteForce(scene, {}, 1e-7, 1);
  const BruteForce blunt = EvaluateBruteForce(scene, {}, 1e-2, 1);
  for (size_t i = 0; i < sharp.entropy.size(); ++i) {
    EXPECT_LT(sharp.entropy[i], 0.05);
    EXPECT_LT(sharp.error[i], 0.02);
    EXPECT_GT(blunt.entropy[i], sharp.entropy[i]);
    EXPECT_LE(blunt.entropy[i], 1.0);
  }
  // Without a view all is possible.
  std::fill(scene.samples.weight.begin(), scene.samples.weight.end(), 0.0f);
  for (const double H : EvaluateBruteForce(scene, {}, 1e-2, 1).entropy) {
    EXPECT_NEAR(1.0, H, 1e-12);
  }
}

}  // namespace
}  // namespace ibrdf
