#include "ibrdf/solvers/effects/effects_plan.h"

#include <gtest/gtest.h>

#include <cmath>
#include <nlohmann/json.hpp>
#include <string>

#include "ibrdf/io/exr.h"
#include "ibrdf/io/problem_file.h"
#include "ibrdf/solvers/effects/describe_plan.h"
#include "ibrdf/solvers/forward/render_scene.h"
#include "ibrdf/solvers/problem/load_problem.h"
#include "ibrdf/solvers/report/write_results.h"
#include "ibrdf/solvers/solve/solve.h"
#include "tests/support/solver_testing.h"
#include "tests/support/temp_dir.h"

namespace ibrdf {
namespace {
using namespace testing;  // NOLINT

// Each side hides half of what a point inside sees towards it: a right angle,
// its crease at the back, along y.
constexpr char kGroove[] =
    "v 0.001 -1 -1\nv 1 -1 0\nv 1 1 0\nv 0.001 1 -1\n"
    "v -0.001 -1 -1\nv -0.001 1 -1\nv -1 1 0\nv -1 -1 0\n"
    "f 1 2 3 4\nf 5 6 7 8\n";
// Two sides that look away from each other.
constexpr char kRidge[] =
    "v 0.001 -1 0\nv 1 -1 -1\nv 1 1 -1\nv 0.001 1 0\n"
    "v -0.001 -1 0\nv -0.001 1 0\nv -1 1 -1\nv -1 -1 -1\n"
    "f 1 2 3 4\nf 5 6 7 8\n";

class EffectsPlanTest : public ::testing::Test {
 protected:
  void SetUp() override {
    WriteBytes(dir_.File("groove.obj"), kGroove);
    WriteBytes(dir_.File("ridge.obj"), kRidge);
    ASSERT_TRUE(WriteExr(SmoothMap(32, 64), dir_.File("map.exr")).ok());
    WriteBytes(dir_.File("scene.yaml"),
               "image: {width: 24, height: 24}\n"
               "geometry: {mesh: groove.obj, fit: none}\n"
               "reflectance: {known: {lambertian: 0.5}}\n"
               "illumination: {known: map.exr}\n"
               "quality: preview\n");
  }
  StatusOr<RenderedScene> Render(const std::vector<std::string>& overrides) {
    const StatusOr<Problem> problem =
        ReadProblem(dir_.File("scene.yaml"), overrides);
    if (!problem.ok()) return problem.status();
    return RenderScene(*problem, {});
  }
  const TempDir dir_;
};

TEST_F(EffectsPlanTest, AutoShadowsWhatNeedsItAndSaysSo) {
  const RenderedScene groove = Render({}).value();
  EXPECT_TRUE(groove.plan.effects.visibility);
  EXPECT_GE(groove.plan.effects.bounces, 1);
  EXPECT_EQ(0u,
            Describe(groove.plan.effects).find("visibility, interreflection ("))
      << Describe(groove.plan.effects);
  EXPECT_GT(groove.plan.effects.omission.unshadowed, 0.1);
  EXPECT_LT(groove.plan.effects.error, kSolveOmissionError);

  const RenderedScene dark =
      Render({"reflectance.known={lambertian: 0.02}"}).value();
  EXPECT_EQ(0, dark.plan.effects.bounces);
  EXPECT_EQ(0u, Describe(dark.plan.effects).find("visibility: "))
      << Describe(dark.plan.effects);
  EXPECT_EQ(1.0, groove.plan.effects.probe.shadowed_share);

  const RenderedScene ridge = Render({"geometry.mesh=ridge.obj"}).value();
  EXPECT_FALSE(ridge.plan.effects.visibility);
  EXPECT_EQ(0u, Describe(ridge.plan.effects).find("none: "));
  EXPECT_EQ(0.0, ridge.plan.effects.omission.unshadowed);

  const RenderedScene sphere = Render({"geometry={sphere: {}}"}).value();
  EXPECT_EQ(0, sphere.plan.effects.probe.rays);
  EXPECT_NE(std::string::npos, Describe(sphere.plan.effects).find("convex"));
}

// By patches of the object and, of a mirror, along the lobe's own rays.
TEST_F(EffectsPlanTest, PredictionIsTheErrorOfTheImage) {
  const std::string few = "image={width: 8, height: 8}";
  const std::string mirror =
      "{cook_torrance: {diffuse: 0, specular: 1, roughness: 0.03, f0: 0.9}}";
  for (const std::string& material :
       {std::string("{lambertian: 0.5}"), mirror}) {
    const std::string known = "reflectance.known=" + material;
    const RenderedScene all = Render({known, few, "effects=all"}).value();
    EXPECT_EQ(kMostBounces, all.plan.effects.bounces);
    for (const char* effects :
         {"effects=none", "effects=[visibility]", "effects=auto"}) {
      const RenderedScene some = Render({known, few, effects}).value();
      double error = 0.0;
      int count = 0;
      for (size_t k = 0; k < all.image.rgb.size(); ++k) {
        if (all.mask.inside[k / 3] == 0) continue;
        error += std::abs(std::log(some.image.rgb[k] / all.image.rgb[k]));
        ++count;
      }
      EXPECT_NEAR(error / count, some.plan.effects.error,
                  0.1 * error / count + 1e-3)
          << effects << " " << material;
    }
  }
}

TEST_F(EffectsPlanTest, TheUserOverrules) {
  EXPECT_FALSE(Render({"effects=[reflectance_map]"})->plan.effects.visibility);
  const RenderedScene shadows = Render({"effects=[visibility]"}).value();
  EXPECT_TRUE(shadows.plan.effects.visibility);
  EXPECT_EQ(0, shadows.plan.effects.bounces);
  EXPECT_NE(std::string::npos, Describe(shadows.plan.effects).find("absorb"));
  const RenderedScene bounces = Render({"effects=[interreflection]"}).value();
  EXPECT_TRUE(bounces.plan.effects.visibility);
  EXPECT_GE(bounces.plan.effects.bounces, 1);
  const RenderedScene ridge =
      Render({"effects=[visibility]", "geometry.mesh=ridge.obj"}).value();
  EXPECT_TRUE(ridge.plan.effects.visibility);
  EXPECT_EQ(Render({"geometry.mesh=ridge.obj"})->image.rgb, ridge.image.rgb);
}

TEST_F(EffectsPlanTest, NormalsHaveNoShadows) {
  Image normals(24, 24);
  for (size_t i = 0; i < normals.num_pixels(); ++i) normals.rgb[3 * i + 2] = 1;
  ASSERT_TRUE(WriteExr(normals, dir_.File("normals.exr")).ok());
  const std::string geometry = "geometry={normals: normals.exr}";
  EXPECT_NE(std::string::npos,
            Describe(Render({geometry})->plan.effects).find("no positions"));
  const Status refused = Render({geometry, "effects=[visibility]"}).status();
  EXPECT_EQ(StatusCode::kInvalidInput, refused.code());
  EXPECT_NE(std::string::npos, refused.message().find("effects"));
  EXPECT_NE(std::string::npos, Render({geometry, "effects=[interreflection]"})
                                   .status()
                                   .message()
                                   .find("interreflection needs a shape"));
}

// The solver gets the table, its result tells why, and the light that it finds
// under shadows explains the shadowed image where the other's does not.
TEST_F(EffectsPlanTest, SolveUsesShadowsAndReportsThem) {
  const RenderedScene scene =
      Render({"effects=all", "quality=reference"}).value();
  ASSERT_TRUE(WriteExr(scene.image, dir_.File("input.exr")).ok());
  WriteBytes(dir_.File("solve.yaml"),
             "problem: illumination\n"
             "image: {file: input.exr}\n"
             "geometry: {mesh: groove.obj, fit: none}\n"
             "reflectance: {known: {lambertian: 0.5}}\n"
             "illumination: {width: 16, height: 8, prior: none}\n"
             "solver: {seconds: 20, max_iterations: 6}\n");
  double misfit[2];
  for (const bool shadows : {false, true}) {
    const StatusOr<Problem> problem = ReadProblem(
        dir_.File("solve.yaml"), {shadows ? "effects=auto" : "effects=none"});
    ASSERT_TRUE(problem.ok()) << problem.status().message();
    StatusOr<InverseProblem> inverse = LoadInverseProblem(*problem, 1, 0);
    ASSERT_TRUE(inverse.ok()) << inverse.status().message();
    EXPECT_EQ(shadows, inverse->transport.visibility != nullptr);
    const StatusOr<Solution> estimate =
        SolveInverseRendering(*inverse, nullptr, nullptr);
    ASSERT_TRUE(estimate.ok()) << estimate.status().message();
    misfit[shadows ? 1 : 0] = estimate->misfit;
    if (!shadows) continue;
    const Truth truth;
    const ResultMetrics metrics =
        MeasureResult(*inverse, truth, *estimate).value();
    ASSERT_TRUE(WriteResults({*problem, *inverse, truth, *estimate, metrics},
                             dir_.File("out"))
                    .ok());
    const nlohmann::json result =
        nlohmann::json::parse(ReadBytes(dir_.File("out/result.json")));
    EXPECT_EQ(Describe(inverse->effects), result["effects"].get<std::string>());
    const nlohmann::json& visibility = result["effects_plan"]["visibility"];
    EXPECT_TRUE(visibility["simulated"].get<bool>());
    EXPECT_EQ(inverse->effects.omission.unshadowed,
              visibility["log_radiance_error_without"].get<double>());
    EXPECT_GT(visibility["rays"].get<int64_t>(), 0);
    const nlohmann::json& bounces = result["effects_plan"]["interreflection"];
    EXPECT_EQ(inverse->effects.bounces, bounces["bounces"].get<int>());
    EXPECT_GT(bounces["emitters"].get<int>(), 0);
  }
  EXPECT_LT(misfit[1], 0.5 * misfit[0]);
}

}  // namespace
}  // namespace ibrdf
