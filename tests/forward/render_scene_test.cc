#include "ibrdf/solvers/forward/render_scene.h"

#include <gtest/gtest.h>

#include <cmath>

#include "ibrdf/io/problem_file.h"

namespace ibrdf {
namespace {

Problem Scene24() {
  StatusOr<Problem> problem =
      ReadProblem(std::string(IBRDF_SOURCE_DIR) + "/examples/sphere/scene.yaml",
                  {"image={width: 24, height: 24}", "quality=preview",
                   "illumination.width=64", "illumination.height=32"});
  EXPECT_TRUE(problem.ok()) << problem.status().message();
  EXPECT_TRUE(CheckRenderable(*problem).ok());
  return *problem;
}

TEST(RenderScene, ExampleRendersPositiveRadianceInsideTheMaskOnly) {
  const StatusOr<RenderedScene> out = RenderScene(Scene24(), {});
  ASSERT_TRUE(out.ok()) << out.status().message();
  EXPECT_EQ(64, out->illumination.width);
  // Area of the inscribed disc, within its border's pixels.
  EXPECT_NEAR(3.1416 * 144, static_cast<double>(out->mask.CountInside()), 40.0);
  for (size_t p = 0; p < out->image.num_pixels(); ++p) {
    for (int c = 0; c < 3; ++c) {
      const float v = out->image.rgb[3 * p + c];
      EXPECT_TRUE(out->mask.inside[p] != 0 ? v > 0.0f && std::isfinite(v)
                                           : v == 0.0f);
    }
  }
}

TEST(RenderScene, NoiseHasTheAskedSizeAndFollowsTheSeed) {
  Problem problem = Scene24();
  RenderSceneOptions options;
  problem.noise = 0.02;
  const RenderedScene a = RenderScene(problem, options).value();
  options.num_threads = 1;
  const RenderedScene same = RenderScene(problem, options).value();
  EXPECT_EQ(a.image.rgb, same.image.rgb);
  options.seed = 2;
  const RenderedScene other = RenderScene(problem, options).value();
  EXPECT_NE(a.image.rgb, other.image.rgb);
  problem.noise = 0.0;
  const RenderedScene clean = RenderScene(problem, options).value();
  double sum = 0.0, squares = 0.0;
  int count = 0;
  for (size_t k = 0; k < a.image.rgb.size(); ++k) {
    if (a.mask.inside[k / 3] == 0) continue;
    const double d = std::log(a.image.rgb[k] / clean.image.rgb[k]);
    sum += d;
    squares += d * d;
    ++count;
  }
  // Five standard errors of 1300 samples.
  EXPECT_NEAR(0.0, sum / count, 5 * 0.02 / std::sqrt(count));
  EXPECT_NEAR(0.02, std::sqrt(squares / count),
              5 * 0.02 / std::sqrt(2.0 * count));
}

// A preview samples pixels where the image asks for it, says so, and is near
// the reference, which samples all of them.
TEST(RenderScene, PreviewSamplesThePixelsThatNeedIt) {
  Problem problem = Scene24();
  problem.illumination.sky->sun_phi_degrees = 35;
  const RenderedScene preview = RenderScene(problem, {}).value();
  EXPECT_NE(std::string::npos, Describe(preview).find("sampled 4 times"))
      << Describe(preview);
  problem.quality = RenderQuality::kReference;
  const RenderedScene reference = RenderScene(problem, {}).value();
  double error = 0.0;
  int count = 0;
  for (size_t k = 0; k < preview.image.rgb.size(); ++k) {
    if (preview.mask.inside[k / 3] == 0) continue;
    error += std::abs(std::log(preview.image.rgb[k] / reference.image.rgb[k]));
    ++count;
  }
  EXPECT_LT(error / count, 0.006);
}

TEST(RenderScene, ProgressMayStopIt) {
  RenderSceneOptions options;
  options.progress = [](double) { return false; };
  EXPECT_EQ(StatusCode::kInterrupted,
            RenderScene(Scene24(), options).status().code());
}

TEST(RenderScene, MissingFilesAreNamed) {
  Problem problem = Scene24();
  problem.geometry.kind = GeometryKind::kMesh;
  problem.geometry.file = "/nowhere/a.obj";
  const Status status = RenderScene(problem, {}).status();
  EXPECT_EQ(StatusCode::kInvalidInput, status.code());
  EXPECT_NE(std::string::npos, status.message().find("/nowhere/a.obj"));
}

}  // namespace
}  // namespace ibrdf
