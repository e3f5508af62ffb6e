#include "ibrdf/solvers/forward/approximate_radiance.h"

#include <gtest/gtest.h>

#include <cmath>
#include <string>

#include "ibrdf/brdf/cook_torrance.h"
#include "ibrdf/io/problem_file.h"
#include "ibrdf/light/procedural_sky.h"
#include "ibrdf/solvers/forward/render_scene.h"
#include "tests/support/function_renderer.h"
#include "tests/support/temp_dir.h"

namespace ibrdf {
namespace {

constexpr char kSoft[] =
    "illumination={known: {sky: {sun_irradiance: 0}}, width: 128, height: 64}";
constexpr char kHard[] =
    "illumination={known: {sky: {sun_phi_degrees: 35, sun_radius_degrees: "
    "0.5}}, width: 128, height: 64}";
constexpr char kMirror[] =
    "reflectance.known={cook_torrance: {diffuse: 0, roughness: 0.03, f0: 0.9}}";
constexpr char kGlossy[] =
    "reflectance.known={cook_torrance: {diffuse: 0.2, roughness: 0.12, f0: "
    "0.04}}";
constexpr char kPerspective[] =
    "camera={type: perspective, fov_degrees: 30, from: [0, 0, 4]}";

class RadianceTier : public ::testing::Test {
 protected:
  void SetUp() override {
    WriteBytes(dir_.File("scene.yaml"),
               "image: {width: 64, height: 64}\n"
               "geometry: {sphere: {}}\n"
               "reflectance: {known: {lambertian: 0.5}}\n"
               "illumination: {known: {sky: {sun_irradiance: 0}}, width: 128, "
               "height: 64}\n"
               "quality: preview\n");
  }
  StatusOr<RenderedScene> Render(const std::vector<std::string>& overrides,
                                 const RenderSceneOptions& options = {}) {
    const StatusOr<Problem> problem =
        ReadProblem(dir_.File("scene.yaml"), overrides);
    if (!problem.ok()) return problem.status();
    return RenderScene(*problem, options);
  }
  ApproximationPlan Plan(const std::vector<std::string>& overrides,
                         int threads = 0) {
    RenderSceneOptions options;
    options.plan_only = true;
    options.num_threads = threads;
    return Render(overrides, options).value().plan.approximation;
  }
  const TempDir dir_;
};

double LogDifference(const RenderedScene& a, const RenderedScene& b) {
  double sum = 0.0;
  int count = 0;
  for (size_t k = 0; k < a.image.rgb.size(); ++k) {
    if (a.mask.inside[k / 3] == 0) continue;
    sum += std::abs(std::log(a.image.rgb[k] / b.image.rgb[k]));
    ++count;
  }
  return sum / count;
}

bool Says(const RenderedScene& scene, const std::string& text) {
  return Describe(scene).find(text) != std::string::npos;
}

TEST_F(RadianceTier, MatteUnderSoftLightIsRenderedInHarmonics) {
  const RenderedScene fast = Render({kPerspective}).value();
  const ApproximationPlan& plan = fast.plan.approximation;
  EXPECT_EQ(Approximation::kHarmonics, plan.approximation) << Describe(fast);
  EXPECT_LE(plan.order, 8);
  EXPECT_LE(plan.predicted_error, 3e-3);
  EXPECT_GT(plan.predicted_error, 0.0);
  EXPECT_LE(plan.found_error, 3e-3);
  EXPECT_EQ(64, plan.checked);
  EXPECT_LT(plan.seconds, 0.5 * plan.quadrature_seconds);
  EXPECT_TRUE(
      Says(fast, "spherical harmonics up to l = " + std::to_string(plan.order) +
                     ": predicted error of log radiance"));
  const RenderedScene slow = Render({kPerspective, "effects=none"}).value();
  EXPECT_EQ(Approximation::kQuadrature, slow.plan.approximation.approximation);
  EXPECT_LT(LogDifference(fast, slow), 3e-3);
  // Seen from far away, so few normals are enough that nothing is to be gained.
  const ApproximationPlan by_normal = Plan({});
  EXPECT_EQ(Approximation::kReflectanceMap, by_normal.approximation);
  EXPECT_EQ(0, by_normal.checked);
}

TEST_F(RadianceTier, MatteUnderASmallSunIsRenderedInGaussians) {
  const RenderedScene fast = Render({kHard, kPerspective}).value();
  const ApproximationPlan& plan = fast.plan.approximation;
  EXPECT_EQ(Approximation::kGaussians, plan.approximation) << Describe(fast);
  EXPECT_EQ(1, plan.spots);
  EXPECT_TRUE(Says(fast, "spherical Gaussians, 1 for a bright spot"))
      << Describe(fast);
  // 0.0013.
  EXPECT_LT(plan.found_error, 2e-3);
  EXPECT_LT(plan.quadrature_error, plan.found_error);
  const ApproximationPlan reference =
      Plan({kHard, kPerspective, "quality=reference"});
  EXPECT_EQ(Approximation::kQuadrature, reference.approximation);
  EXPECT_EQ(0, reference.checked);
}

TEST_F(RadianceTier, MirrorsAreLeftToTheQuadratureAndItSaysWhy) {
  EXPECT_EQ(Approximation::kQuadrature,
            Plan({kMirror, kPerspective}).approximation);
  EXPECT_EQ(Approximation::kReflectanceMap, Plan({kMirror}).approximation);
  const ApproximationPlan soft = Plan({kMirror});
  EXPECT_EQ(0, soft.checked);
  EXPECT_NE(std::string::npos, Describe(soft).find("are not within 0.0030"))
      << Describe(soft);
  // A glossy surface under a sun is looked at and found to need too many.
  const ApproximationPlan hard = Plan({kGlossy, kHard});
  EXPECT_EQ(Approximation::kReflectanceMap, hard.approximation);
  EXPECT_EQ(64, hard.checked);
  EXPECT_NE(std::string::npos, Describe(hard).find("slower or not within"))
      << Describe(hard);
}

TEST_F(RadianceTier, SmallImagesAreNotWorthAChoice) {
  const ApproximationPlan plan = Plan({"image={width: 24, height: 24}"});
  EXPECT_EQ(Approximation::kReflectanceMap, plan.approximation);
  EXPECT_EQ(0, plan.checked);
  EXPECT_EQ("", Describe(plan));
}

TEST_F(RadianceTier, TheUserOverrules) {
  EXPECT_EQ(Approximation::kQuadrature, Plan({"effects=none"}).approximation);
  EXPECT_EQ(Approximation::kReflectanceMap,
            Plan({"effects=[reflectance_map]"}).approximation);
  EXPECT_EQ(Approximation::kReflectanceMap,
            Plan({"effects=all"}).approximation);
  const ApproximationPlan gaussians = Plan({"effects=[gaussians]"});
  EXPECT_EQ(Approximation::kGaussians, gaussians.approximation);
  EXPECT_NE(std::string::npos, Describe(gaussians).find("as asked"));
  // What was asked for, as near as it comes, with its error.
  const ApproximationPlan mirror = Plan({"effects=[harmonics]", kMirror});
  EXPECT_EQ(Approximation::kHarmonics, mirror.approximation);
  EXPECT_GT(mirror.predicted_error, 0.1);
  EXPECT_GT(mirror.found_error, 0.1);
  // At reference quality as well, and in small images.
  const ApproximationPlan asked =
      Plan({"effects=harmonics", "quality=reference",
            "image={width: 16, height: 16}"});
  EXPECT_EQ(Approximation::kHarmonics, asked.approximation);
  EXPECT_LE(asked.predicted_error, 3e-4);
  EXPECT_EQ(Approximation::kHarmonics,
            Plan({"effects=[gaussians, harmonics]"}).approximation);
}

TEST_F(RadianceTier, PlanAndImageAreTheSameForAnyNumberOfThreads) {
  for (const char* light : {kSoft, kHard}) {
    RenderSceneOptions one, many;
    one.num_threads = 1;
    many.num_threads = 8;
    const RenderedScene a = Render({light, kPerspective}, one).value();
    const RenderedScene b = Render({light, kPerspective}, many).value();
    EXPECT_EQ(a.image.rgb, b.image.rgb);
    EXPECT_EQ(Describe(a), Describe(b));
    EXPECT_EQ(Describe(a.plan.approximation),
              Describe(Plan({light, kPerspective})));
  }
}

// Predicted to do, found not to.
TEST(ApproximateRadiance, FallsBackWhereTheTruthDisagrees) {
  SkyOptions sky;
  sky.sun_irradiance = 0.0;
  const Image map = RenderSky(sky, 32, 64);
  KnownBrdf brdf;
  CookTorrance matte;
  matte.specular = Eigen::Array3d::Zero();
  brdf.function = matte.Function();
  const std::vector<ShadingPoint> points =
      FindShadingPoints(Scene::UnitSphere(), Camera(), 64, 64, Mask(), 1)
          .value();
  ApproximationOptions options;
  options.harmonics = options.gaussians = true;
  const ReferenceRenderer renderer(map, {});
  double scale = 1.0;
  const testing::FunctionRenderer truth(
      [&](const std::vector<ShadingPoint>& some, double* L_o) {
        renderer.Render(some, brdf.function, L_o);
        for (size_t k = 0; k < 3 * some.size(); ++k) L_o[k] *= scale;
        return true;
      });
  ApproximateRadiance approximation(map, brdf, 0);
  ASSERT_TRUE(approximation.Choose(points, truth, truth, options));
  EXPECT_NE(nullptr, approximation.renderer());
  scale = 1.01;
  ASSERT_TRUE(approximation.Choose(points, truth, truth, options));
  EXPECT_EQ(nullptr, approximation.renderer());
  EXPECT_NE(std::string::npos,
            Describe(approximation.plan()).find("not within"));
  // The quadrature may be as far off itself.
  const testing::FunctionRenderer quadrature(
      [&](const std::vector<ShadingPoint>& some, double* L_o) {
        renderer.Render(some, brdf.function, L_o);
        for (size_t k = 0; k < 3 * some.size(); ++k) L_o[k] *= 0.99;
        return true;
      });
  ASSERT_TRUE(approximation.Choose(points, quadrature, truth, options));
  EXPECT_NE(nullptr, approximation.renderer());
  EXPECT_GT(approximation.plan().quadrature_error, 0.015);
  // Stopped.
  const testing::FunctionRenderer stop(
      [](const std::vector<ShadingPoint>&, double*) { return false; });
  EXPECT_FALSE(approximation.Choose(points, truth, stop, options));
}

}  // namespace
}  // namespace ibrdf
