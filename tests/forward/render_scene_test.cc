#include "ibrdf/solvers/forward/render_scene.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <vector>

#include "ibrdf/base/pi.h"
#include "ibrdf/io/exr.h"
#include "ibrdf/io/map_file.h"
#include "ibrdf/io/problem_file.h"
#include "ibrdf/light/environment_map.h"
#include "tests/support/camera_files.h"
#include "tests/support/mesh_files.h"
#include "tests/support/temp_dir.h"

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

// A ball of flat sides, before the camera.
MeshSpec Ball() {
  constexpr int kRings = 8, kColumns = 2 * kRings;
  MeshSpec ball;
  for (int i = 0; i <= kRings; ++i) {
    for (int k = 0; k < kColumns; ++k) {
      const double theta = kPi * i / kRings, phi = 2 * kPi * k / kColumns;
      // A float's numbers, so that all formats hold the same.
      const Eigen::Vector3f p(Eigen::Vector3d(std::sin(theta) * std::sin(phi),
                                              std::cos(theta),
                                              std::sin(theta) * std::cos(phi))
                                  .cast<float>());
      ball.vertices.push_back(p.cast<double>());
    }
  }
  for (int i = 0; i < kRings; ++i) {
    for (int k = 0; k < kColumns; ++k) {
      const int a = i * kColumns + k, d = i * kColumns + (k + 1) % kColumns;
      ball.triangles.push_back({a, a + kColumns, d + kColumns});
      ball.triangles.push_back({a, d + kColumns, d});
    }
  }
  return ball;
}

TEST(RenderScene, AMeshRendersTheSameFromAFileOfAnyFormat) {
  const TempDir dir;
  Problem problem = Scene24();
  problem.geometry.kind = GeometryKind::kMesh;
  const auto render = [&](const std::string& file, const std::string& bytes) {
    WriteBytes(dir.File(file), bytes);
    problem.geometry.file = dir.File(file);
    const StatusOr<RenderedScene> out = RenderScene(problem, {});
    EXPECT_TRUE(out.ok()) << out.status().message();
    return out->image.rgb;
  };
  const MeshSpec ball = Ball();
  const std::vector<float> obj = render("a.obj", ObjBytes(ball));
  EXPECT_GT(*std::max_element(obj.begin(), obj.end()), 0.0f);
  EXPECT_EQ(obj, render("a.ply", PlyBytes(ball)));
  EXPECT_EQ(obj, render("a.stl", StlBytes(ball)));
  EXPECT_EQ(obj, render("b.stl", StlText(ball)));
  EXPECT_EQ(obj, render("a.glb", GlbBytes(ball)));
}

// A light whose log radiance changes by 1 per radian at most, brighter to the
// right (red), above (green) and behind the camera (blue).
Image SmoothLight(int height) {
  Image map(2 * height, height);
  for (int r = 0; r < height; ++r) {
    for (int c = 0; c < map.width; ++c) {
      const Eigen::Vector3d d =
          MapDirection(r + 0.5, c + 0.5, height, map.width);
      for (int k = 0; k < 3; ++k) {
        map.At(c, r)[k] = static_cast<float>(std::exp(d[k]));
      }
    }
  }
  return map;
}

double LargestLogDifference(const Image& a, const Image& b) {
  double largest = 0.0;
  for (size_t k = 0; k < a.rgb.size(); ++k) {
    if (a.rgb[k] == 0.0f && b.rgb[k] == 0.0f) continue;
    largest =
        std::max<double>(largest, std::abs(std::log(a.rgb[k] / b.rgb[k])));
  }
  return largest;
}

TEST(RenderScene, ALightRendersTheSameFromAFileOfAnyFrame) {
  constexpr int kRows = 64;
  const TempDir dir;
  Problem problem = Scene24();
  problem.illumination.sky.reset();
  const auto render = [&](const std::string& file,
                          std::optional<MapFrame> frame) {
    problem.illumination.known_file = dir.File(file);
    problem.illumination.frame = frame;
    const StatusOr<RenderedScene> out = RenderScene(problem, {});
    EXPECT_TRUE(out.ok()) << out.status().message();
    EXPECT_TRUE(out->warnings.empty());
    return out->image;
  };
  const Image light = SmoothLight(kRows);
  // Without attributes: the user's word alone says what it is.
  ASSERT_TRUE(WriteExr(light, dir.File("library.exr")).ok());
  const Image expected = render("library.exr", MapFrame::kIbrdf01);
  // The bit-by-bit frames move columns. The others are resampled twice, each
  // time by less than half a texel of pi / 64, on both sides of which the light
  // differs by as much in the logarithm; and each ripples by 0.003
  // (convert_map.h). A render is a mean of the light, weights > 0.
  constexpr double kResampled = 3.15 / kRows + 2 * 0.003;
  for (const MapFrame frame : kMapFrames) {
    const std::string name = std::string(MapFrameName(frame)) + ".exr";
    ASSERT_TRUE(WriteMap(light, frame, dir.File(name)).ok());
    const Image image = render(name, std::nullopt);
    EXPECT_EQ(image.rgb, render(name, frame).rgb) << name;
    const bool exact = frame != MapFrame::kOpenExr &&
                       frame != MapFrame::kDebevecProbe &&
                       frame != MapFrame::kCubeCross;
    if (exact) {
      EXPECT_EQ(expected.rgb, image.rgb) << name;
    } else {
      EXPECT_LT(LargestLogDifference(expected, image), kResampled) << name;
    }
  }
  // A wrong word shows.
  EXPECT_GT(
      LargestLogDifference(expected, render("library.exr", MapFrame::kCamera)),
      0.2);
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

Camera LookingFrom(const Eigen::Vector3d& from) {
  Camera camera;
  camera.type = CameraType::kPerspective;
  camera.from = from;
  return camera;
}

// Views share what is read; each is the render of its camera, bit for bit.
TEST(RenderViews, EachIsTheRenderOfItsCamera) {
  Problem problem = Scene24();
  problem.noise = 0.02;
  problem.views.list = {{"front", LookingFrom({0, 0, 4})},
                        {"side", LookingFrom({3, 1, 2})},
                        {"square", Camera()}};
  std::vector<std::string> names;
  std::vector<Image> images;
  RenderSceneOptions options;
  double last = 0.0;
  options.progress = [&](double share) {
    EXPECT_GE(share, last);
    last = share;
    return true;
  };
  ASSERT_TRUE(RenderViews(problem, options,
                          [&](const ViewSpec& view, const RenderedScene& out) {
                            names.push_back(view.name);
                            images.push_back(out.image);
                            return OkStatus();
                          })
                  .ok());
  EXPECT_EQ((std::vector<std::string>{"front", "side", "square"}), names);
  EXPECT_EQ(1.0, last);
  for (size_t i = 0; i < images.size(); ++i) {
    Problem one = Scene24();
    one.noise = 0.02;
    one.camera = problem.views.list[i].camera;
    RenderSceneOptions of_one;
    of_one.seed = options.seed + i;
    EXPECT_EQ(RenderScene(one, of_one)->image.rgb, images[i].rgb) << names[i];
  }
}

TEST(RenderViews, ComeFromFilesAndAreNamedInMessages) {
  const TempDir dir;
  WriteBytes(dir.File("t.json"), SmallTransforms());
  Problem problem = Scene24();
  problem.views.transforms = dir.File("t.json");
  const auto take = [&](const ViewSpec&, const RenderedScene& out) {
    EXPECT_GT(out.mask.CountInside(), 50u);
    return OkStatus();
  };
  EXPECT_TRUE(RenderViews(problem, {}, take).ok());
  // COLMAP's have a size.
  WriteBytes(dir.File("cameras.txt"), SmallColmapCameras());
  WriteBytes(dir.File("images.txt"), SmallColmapImages());
  problem.views.transforms.clear();
  problem.views.colmap = dir.path();
  EXPECT_NE(std::string::npos, RenderViews(problem, {}, take)
                                   .message()
                                   .find("the proportions of view a, 160 x"));
  problem.image.width = 32;
  EXPECT_TRUE(RenderViews(problem, {}, take).ok());
  // One that looks away.
  problem.views = {};
  problem.views.list = {{"away", LookingFrom({0, 0, 4})}};
  problem.views.list[0].camera.to = {0, 0, 9};
  EXPECT_NE(std::string::npos,
            RenderViews(problem, {}, take)
                .message()
                .find(": view away: geometry: no pixel sees the object"));
}

}  // namespace
}  // namespace ibrdf
