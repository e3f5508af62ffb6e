#include "ibrdf/solvers/uncertainty_map/map_uncertainty.h"

#include <gtest/gtest.h>

#include <Eigen/Geometry>
#include <algorithm>
#include <cmath>
#include <filesystem>
#include <nlohmann/json.hpp>
#include <string>
#include <vector>

#include "ibrdf/base/format.h"
#include "ibrdf/base/pi.h"
#include "ibrdf/io/calibrated_views.h"
#include "ibrdf/io/exr.h"
#include "ibrdf/io/png.h"
#include "ibrdf/io/problem_file.h"
#include "ibrdf/solvers/forward/render_scene.h"
#include "ibrdf/solvers/next_view/candidate_views.h"
#include "ibrdf/solvers/uncertainty_map/surface_pictures.h"
#include "ibrdf/solvers/uncertainty_map/write_uncertainty.h"
#include "tests/support/markup.h"
#include "tests/support/mesh_files.h"
#include "tests/support/photo_files.h"
#include "tests/support/shapes.h"
#include "tests/support/temp_dir.h"

namespace ibrdf {
namespace {

constexpr char kLight[] =
    "illumination: {width: 32, height: 16, known: {sky: {}}}\n"
    "geometry: {sphere: {}}\n";
// All before the sphere's front half: the back stays unseen.
const char* const kNames[] = {"a", "b", "c", "d"};
const char* const kPlaces[] = {"[0, 0, 4]", "[2, 1, 3.5]", "[-2, 0.5, 3.5]",
                               "[0.5, -2, 3.5]"};

std::string CameraText(int view) {
  return std::string("camera: {type: perspective, fov_degrees: 32, from: ") +
         kPlaces[view] + "}";
}

// Photographs of a sphere, made once by the library's renderer.
class MapUncertaintyTest : public ::testing::Test {
 protected:
  static void SetUpTestSuite() {
    dir_ = new TempDir;
    std::string views;
    for (int k = 0; k < 4; ++k) {
      views += std::string(k == 0 ? "" : ", ") + "{name: " + kNames[k] + ", " +
               CameraText(k) + "}";
    }
    const Problem scene =
        ParseProblem(dir_->File("scene.yaml"),
                     std::string(kLight) +
                         "image: {width: 32, height: 32}\nquality: preview\n"
                         "reflectance: {known: {principled: {base: [0.6, 0.3, "
                         "0.2], roughness: 0.5, metallic: 0.5}}}\nviews: [" +
                         views + "]\n",
                     {})
            .value();
    const Status rendered = RenderViews(
        scene, {}, [](const ViewSpec& view, const RenderedScene& out) {
          IBRDF_RETURN_IF_ERROR(
              WriteExr(out.image, dir_->File(view.name + ".exr")));
          return WriteMask(out.mask, dir_->File(view.name + ".png"));
        });
    ASSERT_TRUE(rendered.ok()) << rendered.message();
  }
  static void TearDownTestSuite() {
    delete dir_;
    dir_ = nullptr;
  }

  static std::string ViewText(int k) {
    const std::string name = kNames[k];
    return "{name: " + name + ", file: " + name + ".exr, mask: " + name +
           ".png, " + CameraText(k) + "}";
  }

  static StatusOr<Problem> ProblemOf(
      const std::vector<int>& views,
      const std::vector<std::string>& overrides = {}) {
    std::string list;
    for (const int k : views) list += (list.empty() ? "" : ", ") + ViewText(k);
    return ParseProblem(dir_->File("p.yaml"),
                        std::string(kLight) +
                            "problem: textures\ntexture: {width: 32, height: "
                            "32}\nviews: [" +
                            list + "]\n",
                        overrides);
  }

  static UncertaintyResult Map(const std::vector<int>& views,
                               const UncertaintyOptions& options = {},
                               const std::vector<std::string>& overrides = {}) {
    const StatusOr<Problem> problem = ProblemOf(views, overrides);
    EXPECT_TRUE(problem.ok()) << problem.status().message();
    StatusOr<UncertaintyResult> result = MapUncertainty(*problem, options);
    EXPECT_TRUE(result.ok()) << result.status().message();
    return *std::move(result);
  }

  static void WriteTorus(const std::string& file) {
    const TriangleMesh torus = TorusMesh(48, 24, 0.7, 0.3);
    MeshSpec mesh;
    for (size_t i = 0; i < torus.vertices.size(); ++i) {
      mesh.vertices.push_back(torus.vertices[i].cast<double>());
      mesh.normals.push_back(torus.normals[i].cast<double>());
    }
    mesh.triangles = torus.triangles;
    WriteBytes(dir_->File(file), ObjBytes(mesh));
  }

  static std::string Error(const StatusOr<Problem>& problem,
                           const UncertaintyOptions& options = {}) {
    if (!problem.ok()) return problem.status().message();
    const StatusOr<UncertaintyResult> result =
        MapUncertainty(*problem, options);
    if (result.ok()) return "";
    EXPECT_EQ(2, result.status().ExitCode());
    EXPECT_EQ(std::string::npos, result.status().message().find('\n'));
    return result.status().message();
  }

  static TempDir* dir_;
};
TempDir* MapUncertaintyTest::dir_ = nullptr;

TEST_F(MapUncertaintyTest, TexelsThatNoViewSeesHaveEntropyOne) {
  for (const char* evaluator : {"angular", "spectrum"}) {
    SCOPED_TRACE(evaluator);
    const UncertaintyResult result = Map(
        {0, 1, 2, 3}, {}, {std::string("uncertainty.evaluator=") + evaluator});
    const TexelEntropy& texels = result.texels;
    ASSERT_EQ(1024u, texels.observed_views.size());
    EXPECT_GT(texels.CountObserved(), 200);
    EXPECT_LT(texels.CountObserved(), 900);
    int below_one = 0;
    for (size_t i = 0; i < texels.observed_views.size(); ++i) {
      for (size_t c = 0; c < 3; ++c) {
        const float h = texels.maps.entropy[3 * i + c];
        ASSERT_TRUE(h >= 0.0f && h <= 1.0f) << h;
        if (texels.observed_views[i] == 0) {
          EXPECT_EQ(1.0f, h);
        } else {
          below_one += h < 1.0f;
        }
      }
    }
    EXPECT_GT(below_one, 300);
  }
}

TEST_F(MapUncertaintyTest, ViewsNeverTakeTexelsAway) {
  std::vector<int> before(1024, 0);
  for (const std::vector<int>& views :
       {std::vector<int>{0}, {0, 1}, {0, 1, 2}, {0, 1, 2, 3}}) {
    const std::vector<int> seen = Map(views).texels.observed_views;
    for (size_t i = 0; i < seen.size(); ++i) EXPECT_GE(seen[i], before[i]);
    EXPECT_NE(before, seen);
    before = seen;
  }
}

TEST_F(MapUncertaintyTest, OrderOfViewsAndThreadsChangeNothing) {
  UncertaintyOptions one;
  one.num_threads = 1;
  UncertaintyOptions three;
  three.num_threads = 3;
  const UncertaintyResult a = Map({0, 1, 2, 3}, one);
  const UncertaintyResult b = Map({0, 1, 2, 3}, three);
  EXPECT_EQ(a.texels.maps.entropy, b.texels.maps.entropy);
  EXPECT_EQ(a.texels.maps.alpha, b.texels.maps.alpha);
  EXPECT_EQ(a.texels.observed_views, b.texels.observed_views);
  const UncertaintyResult turned = Map({2, 0, 3, 1}, three);
  EXPECT_EQ(a.texels.observed_views, turned.texels.observed_views);
  for (size_t i = 0; i < a.texels.maps.entropy.size(); ++i) {
    EXPECT_NEAR(a.texels.maps.entropy[i], turned.texels.maps.entropy[i], 1e-6);
  }
}

TEST_F(MapUncertaintyTest, NextViewsAreCamerasThatAreReadBack) {
  UncertaintyOptions options;
  options.add = 3;
  options.candidates = "sphere:12";
  UncertaintyResult result = Map({0, 1, 2, 3}, options);
  ASSERT_TRUE(result.next);
  const NextViews& next = *result.next;
  ASSERT_EQ(3u, next.chosen.size());
  ASSERT_EQ(4u, next.expected_entropy.size());
  EXPECT_EQ(3u, next.farthest.size());
  // The first view to add is none of what photographs show.
  const Eigen::Vector3d first =
      next.candidates[next.chosen[0]].world_from_camera.block<3, 1>(0, 3);
  for (const PhotographedView& view : result.inputs.views) {
    const Eigen::Vector3d from = AxesOf(view.camera).centre;
    EXPECT_LT(first.normalized().dot(from.normalized()), std::cos(kPi / 4.0));
  }
  for (size_t i = 1; i < 4; ++i) {
    EXPECT_LT(next.expected_entropy[i], next.expected_entropy[i - 1]);
  }
  const TempDir out;
  const Problem problem = ProblemOf({0, 1, 2, 3}).value();
  const Status written =
      WriteUncertainty(problem, options, out.path(), &result);
  ASSERT_TRUE(written.ok()) << written.message();
  const StatusOr<std::vector<CalibratedView>> read =
      ReadTransforms(out.File("next_views.json"));
  ASSERT_TRUE(read.ok()) << read.status().message();
  ASSERT_EQ(3u, read->size());
  for (size_t i = 0; i < 3; ++i) {
    const CalibratedView& chosen = next.candidates[next.chosen[i]];
    EXPECT_EQ(chosen.name, (*read)[i].name);
    EXPECT_TRUE(
        (*read)[i].world_from_camera.isApprox(chosen.world_from_camera, 1e-12));
    EXPECT_EQ(chosen.focal, (*read)[i].focal);
    EXPECT_TRUE(CameraOf((*read)[i], 32, 32).ok());
  }
  // As candidates of another run they are taken back, too.
  options.candidates = out.File("next_views.json");
  EXPECT_EQ(3u, Map({0, 1}, options).next->candidates.size());
}

TEST_F(MapUncertaintyTest, FilesAreWholeAndAgree) {
  UncertaintyOptions options;
  UncertaintyResult result = Map({0, 3}, options);
  const Problem problem = ProblemOf({0, 3}).value();
  const TempDir out;
  WriteBytes(out.File("next_views.json"), "{}");  // of an earlier run
  ASSERT_TRUE(WriteUncertainty(problem, options, out.path(), &result).ok());
  EXPECT_FALSE(std::filesystem::exists(out.File("next_views.json")));
  const Image entropy = ReadExr(out.File("entropy.exr")).value();
  const Image seen = ReadExr(out.File("observed_views.exr")).value();
  ASSERT_EQ(32, entropy.width);
  const TexelRows rows = RowsOfTexture(result.inputs.surface.atlas);
  for (size_t i = 0; i < rows.row.size(); ++i) {
    ASSERT_GE(rows.row[i], 0);  // a sphere fills its texture
    EXPECT_EQ(result.texels.observed_views[rows.row[i]], seen.rgb[3 * i]);
    EXPECT_EQ(result.texels.maps.entropy[3 * rows.row[i]], entropy.rgb[3 * i]);
    if (seen.rgb[3 * i] == 0.0f) {
      EXPECT_EQ(1.0f, entropy.rgb[3 * i]);
    }
  }
  // What a view shows: no surface in the corner; in the middle one it sees.
  const Image view = ReadExr(out.File("views/a/entropy.exr")).value();
  EXPECT_TRUE(std::isnan(view.At(0, 0)[0]));
  EXPECT_LT(view.At(16, 16)[0], 1.0f);
  for (const char* name : {"entropy.png", "alpha.exr", "ks.exr",
                           "below_band_limit.png", "views/d/entropy.png"}) {
    EXPECT_TRUE(std::filesystem::exists(out.File(name))) << name;
  }
  const nlohmann::json json =
      nlohmann::json::parse(ReadBytes(out.File("result.json")));
  EXPECT_EQ("textures", json["problem"]["problem"]);
  EXPECT_EQ(result.texels.CountObserved(), json["metrics"]["texels_observed"]);
  EXPECT_TRUE(json["seconds"].contains("evaluate"));
  EXPECT_EQ("", MarkupError(ReadBytes(out.File("report.html"))));
  // No result replaces a photograph.
  EXPECT_EQ(2, WriteUncertainty(ProblemOf({0}, {"views=[{name: a, file: " +
                                                out.File("entropy.exr") + "}]"})
                                    .value(),
                                options, out.path(), &result)
                   .ExitCode());
}

TEST_F(MapUncertaintyTest, ViewsOfAFileNameTheirImages) {
  std::vector<CalibratedView> views;
  const UncertaintyResult listed = Map({0, 1});
  for (const PhotographedView& view : listed.inputs.views) {
    CalibratedView calibrated;
    calibrated.name = view.name;
    calibrated.image = "./" + view.name + ".exr";
    const CameraAxes axes = AxesOf(view.camera);
    calibrated.world_from_camera.topLeftCorner<3, 3>() = axes.world_from_camera;
    calibrated.world_from_camera.topRightCorner<3, 1>() = axes.centre;
    const PixelGrid grid = PixelGridOf(view.camera, 32, 32);
    calibrated.focal = grid.side.cwiseInverse();
    calibrated.centre = grid.centre;
    calibrated.width = calibrated.height = 32.0;
    views.push_back(calibrated);
  }
  WriteBytes(dir_->File("t.json"), TransformsText(views));
  const UncertaintyResult read =
      Map({0, 1}, {}, {"views={transforms: t.json, masks: .}"});
  ASSERT_EQ(2u, read.inputs.views.size());
  EXPECT_EQ(listed.inputs.views[1].mask.inside,
            read.inputs.views[1].mask.inside);
  EXPECT_EQ(listed.texels.observed_views, read.texels.observed_views);
  for (size_t i = 0; i < read.texels.maps.entropy.size(); ++i) {
    EXPECT_NEAR(listed.texels.maps.entropy[i], read.texels.maps.entropy[i],
                1e-6);
  }
}

// The cameras of views as COLMAP has them: x right, y down, z forward.
std::string ColmapImages(const std::vector<PhotographedView>& views) {
  std::string text;
  for (size_t k = 0; k < views.size(); ++k) {
    const CameraAxes axes = AxesOf(views[k].camera);
    const Eigen::Matrix3d camera_from_world =
        Eigen::Vector3d(1, -1, -1).asDiagonal() *
        axes.world_from_camera.transpose();
    const Eigen::Quaterniond q(camera_from_world);
    const Eigen::Vector3d t = -camera_from_world * axes.centre;
    text += Format("%zu %.17g %.17g %.17g %.17g %.17g %.17g %.17g 1 %s.exr\n\n",
                   k + 1, q.w(), q.x(), q.y(), q.z(), t.x(), t.y(), t.z(),
                   views[k].name.c_str());
  }
  return text;
}

TEST_F(MapUncertaintyTest, ModelsOfColmapAreViews) {
  const UncertaintyResult listed = Map({0, 1, 2});
  std::filesystem::create_directories(dir_->File("sparse"));
  const PixelGrid grid = PixelGridOf(listed.inputs.views[0].camera, 32, 32);
  WriteBytes(dir_->File("sparse/cameras.txt"),
             Format("1 PINHOLE 32 32 %.17g %.17g 16 16\n", 1.0 / grid.side.x(),
                    1.0 / grid.side.y()));
  WriteBytes(dir_->File("sparse/images.txt"),
             ColmapImages(listed.inputs.views));
  UncertaintyOptions options;
  options.add = 1;
  options.candidates = "sphere:9";
  const UncertaintyResult read =
      Map({0}, options, {"views={colmap: sparse, images: ., masks: .}"});
  ASSERT_EQ(3u, read.inputs.views.size());
  EXPECT_EQ(listed.texels.observed_views, read.texels.observed_views);
  for (size_t i = 0; i < read.texels.maps.entropy.size(); ++i) {
    EXPECT_NEAR(listed.texels.maps.entropy[i], read.texels.maps.entropy[i],
                1e-5);
  }
  // Candidates of a model, too.
  options.candidates = dir_->File("sparse");
  EXPECT_EQ(3u, Map({0}, options).next->candidates.size());
  WriteBytes(dir_->File("sparse/cameras.txt"), "1 OPENCV 32 32 9 9 0 0 0 0\n");
  EXPECT_NE(std::string::npos,
            Error(ProblemOf({0}, {"views={colmap: sparse, images: .}"}))
                .find("cameras.txt"));
}

// A sphere hides no light from itself, a torus some in its hole.
TEST_F(MapUncertaintyTest, ShadowsLeaveOutWhatTheObjectHides) {
  const std::string none = "uncertainty.shadows=none";
  EXPECT_EQ(Map({0, 1}).texels.maps.entropy,
            Map({0, 1}, {}, {none}).texels.maps.entropy);
  WriteTorus("ring.obj");
  const std::string ring = "geometry={mesh: ring.obj}";
  const UncertaintyResult mirror = Map({0, 1, 2, 3}, {}, {ring});
  const UncertaintyResult open = Map({0, 1, 2, 3}, {}, {ring, none});
  EXPECT_EQ(mirror.texels.observed_views, open.texels.observed_views);
  int changed = 0, seen = 0;
  for (size_t i = 0; i < mirror.texels.observed_views.size(); ++i) {
    if (mirror.texels.observed_views[i] == 0) continue;
    ++seen;
    changed +=
        mirror.texels.maps.entropy[3 * i] != open.texels.maps.entropy[3 * i];
  }
  EXPECT_GT(changed, 0);
  EXPECT_LT(changed, seen);
}

TEST_F(MapUncertaintyTest, PriorsCountWhereNothingIsSeen) {
  for (const char* evaluator : {"angular", "spectrum"}) {
    const UncertaintyResult result =
        Map({0}, {},
            {"uncertainty.prior=materials",
             std::string("uncertainty.evaluator=") + evaluator});
    for (size_t i = 0; i < result.texels.observed_views.size(); ++i) {
      if (result.texels.observed_views[i] > 0) continue;
      EXPECT_LT(result.texels.maps.entropy[3 * i], 0.95f);
      EXPECT_GT(result.texels.maps.entropy[3 * i], 0.2f);
    }
  }
}

// Transparent pixels are outside, as those that a mask leaves out.
TEST_F(MapUncertaintyTest, AlphaOfAPngIsItsMask) {
  const Image render = ReadExr(dir_->File("a.exr")).value();
  const Mask mask = ReadMask(dir_->File("a.png")).value();
  for (const bool with_alpha : {false, true}) {
    PngSpec png;
    png.width = png.height = 32;
    png.type = with_alpha ? PNG_COLOR_TYPE_RGB_ALPHA : PNG_COLOR_TYPE_RGB;
    for (int y = 0; y < 32; ++y) {
      for (int x = 0; x < 32; ++x) {
        for (int c = 0; c < 3; ++c) {
          png.rows += static_cast<char>(static_cast<int>(
              std::clamp(40.0f * render.At(x, y)[c], 0.0f, 250.0f)));
        }
        if (with_alpha) {
          png.rows += static_cast<char>(
              mask.inside[static_cast<size_t>(y) * 32 + x] != 0 ? 255 : 0);
        }
      }
    }
    WriteBytes(dir_->File(with_alpha ? "cut.png" : "whole.png"), PngBytes(png));
  }
  const auto map = [&](const std::string& files) {
    return Map({0}, {},
               {"views=[{name: a, " + files + ", " + CameraText(0) + "}]"});
  };
  const UncertaintyResult masked = map("file: whole.png, mask: a.png");
  const UncertaintyResult cut = map("file: cut.png");
  EXPECT_EQ(masked.texels.observed_views, cut.texels.observed_views);
  EXPECT_EQ(masked.texels.maps.entropy, cut.texels.maps.entropy);
  EXPECT_GT(cut.texels.CountObserved(), 100);
}

// A mesh without texture coordinates gets charts, between which the picture
// shows no surface.
TEST_F(MapUncertaintyTest, MeshesHaveChartsAndPixelsShowTheirTexels) {
  WriteTorus("torus.obj");
  const UncertaintyResult result =
      Map({0, 3}, {},
          {"geometry={mesh: torus.obj}", "texture={width: 256, height: 256}"});
  const SurfaceAtlas& atlas = result.inputs.surface.atlas;
  const TexelRows texture = RowsOfTexture(atlas);
  const Mask covered = texture.Covered();
  EXPECT_EQ(atlas.texels.size(), covered.CountInside());
  EXPECT_LT(covered.CountInside(), covered.inside.size());
  EXPECT_GT(result.texels.CountObserved(), 0);
  const Camera& camera = result.inputs.views[1].camera;
  const TexelRows rows =
      RowsOfView(result.inputs.surface.scene, texture, camera, 64, 64, 0);
  int met = 0;
  for (int i = 0; i < 64 * 64; ++i) {
    if (rows.row[i] < 0) continue;
    ++met;
    const auto at =
        ProjectPoint(camera, atlas.texels[rows.row[i]].position, 64, 64);
    ASSERT_TRUE(at);
    // A texel is narrower than 0.1, two pixels and a half.
    EXPECT_NEAR(i % 64 + 0.5, at->x, 2.5);
    EXPECT_NEAR(i / 64 + 0.5, at->y, 2.5);
  }
  EXPECT_GT(met, 500);
  EXPECT_TRUE(result.inputs.warnings.empty());
  const UncertaintyResult coarse =
      Map({0, 3}, {}, {"geometry={mesh: torus.obj}"});
  ASSERT_EQ(1u, coarse.inputs.warnings.size());
  EXPECT_NE(std::string::npos, coarse.inputs.warnings[0].find("too coarse"));
}

TEST_F(MapUncertaintyTest, BadInputIsOneLine) {
  const std::string file = dir_->File("p.yaml");
  // All look away.
  EXPECT_EQ(0u, Error(ProblemOf({0}, {"views=[{name: a, file: a.exr, camera: "
                                      "{type: perspective, from: [0, 0, 4], "
                                      "to: [0, 0, 8]}}]"}))
                    .find(file + ": views: expected one that sees"));
  EXPECT_EQ(0u, Error(ProblemOf({0, 1}, {"geometry={normals: a.exr}"}))
                    .find(file + ": geometry: expected a sphere or a mesh"));
  EXPECT_EQ(0u, Error(ProblemOf({0}, {"geometry={normals: a.exr}"}))
                    .find(file + ": geometry: expected a mesh, or sphere"));
  EXPECT_NE(std::string::npos,
            Error(ProblemOf({0}, {"views=[{name: a, file: none.exr}]"}))
                .find("none.exr"));
  EXPECT_EQ(0u,
            Error(ProblemOf({0}, {"illumination.known.sky={sun_irradiance: 0, "
                                  "zenith_radiance: 0}"}))
                .find(file + ": illumination.known.sky"));
  EXPECT_NE("", Error(ProblemOf({0}, {"problem=joint"})));
  UncertaintyOptions options;
  options.add = 1;
  for (const char* candidates :
       {"sphere:0", "sphere:", "sphere:-1", "sphere:1001", "sphere:9x"}) {
    options.candidates = candidates;
    EXPECT_EQ(0u, Error(ProblemOf({0}), options)
                      .find("command line: --candidates: expected sphere:N"))
        << candidates;
  }
  options.candidates = dir_->File("none.json");
  EXPECT_NE("", Error(ProblemOf({0}), options));
  WriteBytes(dir_->File("flat.json"),
             R"({"fl_x": 0, "w": 8, "h": 8, "frames": [{"file_path": "a",
 "transform_matrix": [[1, 0, 0, 0], [0, 1, 0, 0], [0, 0, 1, 4],
 [0, 0, 0, 1]]}]})");
  options.candidates = dir_->File("flat.json");
  EXPECT_NE(std::string::npos,
            Error(ProblemOf({0}), options).find("fl_x: expected a number > 0"));
}

TEST_F(MapUncertaintyTest, StopsWhereAskedTo) {
  UncertaintyOptions options;
  options.progress = [](double) { return false; };
  const StatusOr<UncertaintyResult> result =
      MapUncertainty(ProblemOf({0}).value(), options);
  EXPECT_EQ(130, result.status().ExitCode());
}

}  // namespace
}  // namespace ibrdf
