// Photographs of several views as one problem.
#include <gtest/gtest.h>

#include <cmath>
#include <string>

#include "ibrdf/image/rgb8_image.h"
#include "ibrdf/io/exr.h"
#include "ibrdf/io/model_file.h"
#include "ibrdf/io/png.h"
#include "ibrdf/io/problem_file.h"
#include "ibrdf/solvers/problem/load_problem.h"
#include "tests/support/solver_testing.h"
#include "tests/support/temp_dir.h"

namespace ibrdf {
namespace {
using namespace testing;  // NOLINT

// The camera that looks at the origin from the front, the right or the back.
const char kFront[] = "[[1,0,0,0],[0,1,0,0],[0,0,1,4],[0,0,0,1]]";
const char kRight[] = "[[0,0,1,4],[0,1,0,0],[-1,0,0,0],[0,0,0,1]]";
// One that looks away from it.
const char kAway[] = "[[1,0,0,0],[0,1,0,0],[0,0,1,-4],[0,0,0,1]]";

class LoadViewsTest : public ::testing::Test {
 protected:
  void SetUp() override {
    ASSERT_TRUE(WriteModel(TinyModel(2), dir_.File("tiny.ibrdf")).ok());
    WriteImage("a.exr", 12, 10, 1.0f);
    WriteImage("b.exr", 8, 14, 2.0f);
    WriteCodes("a.png", 12, 10, 200);
    WriteCodes("black.png", 12, 10, 0);
  }
  void WriteImage(const std::string& name, int width, int height, float value) {
    Image image(width, height);
    for (size_t k = 0; k < image.rgb.size(); ++k) {
      image.rgb[k] = value + 0.001f * static_cast<float>(k);
    }
    ASSERT_TRUE(WriteExr(image, dir_.File(name)).ok());
  }
  void WriteCodes(const std::string& name, int width, int height,
                  uint8_t code) {
    Rgb8Image image(width, height);
    for (uint8_t& v : image.rgb) v = code;
    ASSERT_TRUE(WritePng(image, dir_.File(name)).ok());
  }
  static std::string View(const std::string& name, const std::string& more,
                          const std::string& pose,
                          const std::string& type = "orthographic") {
    return "  - {name: " + name + ", " + more + ", camera: {type: " + type +
           ", world_from_camera: " + pose + "}}\n";
  }
  // The keys but for the views; overrides as of the command line.
  StatusOr<Problem> Read(const std::string& views,
                         const std::vector<std::string>& overrides = {}) {
    return ParseProblem(dir_.File("p.yaml"),
                        "problem: joint\n"
                        "geometry: {sphere: {}}\n"
                        "reflectance: {model: tiny.ibrdf, variation: none}\n"
                        "illumination: {width: 16, height: 8}\n"
                        "views:\n" +
                            views,
                        overrides);
  }
  StatusOr<InverseProblem> Load(
      const std::string& views,
      const std::vector<std::string>& overrides = {}) {
    const StatusOr<Problem> problem = Read(views, overrides);
    if (!problem.ok()) return problem.status();
    return LoadInverseProblem(*problem, 1, 1);
  }
  void ExpectRefused(const std::string& views, const std::string& word,
                     const std::vector<std::string>& overrides = {}) {
    const Status status = Load(views, overrides).status();
    EXPECT_EQ(StatusCode::kInvalidInput, status.code()) << word;
    EXPECT_NE(std::string::npos, status.message().find(word))
        << status.message();
  }

  const TempDir dir_;
};

TEST_F(LoadViewsTest, EveryViewHasItsPointsAndPixels) {
  const auto p = Load(View("left", "file: a.exr", kFront) +
                      View("right", "file: b.exr", kRight));
  ASSERT_TRUE(p.ok()) << p.status().message();
  ASSERT_EQ(2u, p->sheet.views.size());
  EXPECT_EQ("left", p->sheet.views[0].name);
  EXPECT_EQ(p->sheet.width, p->image.width);
  EXPECT_EQ(p->sheet.height, p->image.height);
  int of_view[2] = {};
  int last_index = -1;
  for (const ShadingPoint& point : p->points) {
    ++of_view[point.view];
    EXPECT_EQ(last_index + 1, point.index);
    last_index = point.index;
    const SheetView& view = p->sheet.views[point.view];
    const int x = point.pixel % p->sheet.width - view.x;
    const int y = point.pixel / p->sheet.width - view.y;
    ASSERT_TRUE(x >= 0 && x < view.width && y >= 0 && y < view.height);
    // The file's value at that place.
    EXPECT_EQ((point.view == 0 ? 1.0f : 2.0f) +
                  0.001f * static_cast<float>(3 * (y * view.width + x)),
              p->image.rgb[size_t{3} * point.pixel]);
    const Eigen::Vector3f towards =
        point.view == 0 ? Eigen::Vector3f(0, 0, 1) : Eigen::Vector3f(1, 0, 0);
    EXPECT_LT((point.wo - towards).norm(), 1e-6f);
  }
  EXPECT_GT(of_view[0], 70);
  EXPECT_GT(of_view[1], 40);
}

TEST_F(LoadViewsTest, OneViewIsThePlainProblem) {
  const auto view = Load(View("only", "file: a.exr", kFront));
  ASSERT_TRUE(view.ok()) << view.status().message();
  EXPECT_TRUE(view->sheet.empty());
  const auto plain = ParseProblem(
      dir_.File("p.yaml"),
      "{problem: joint, image: {file: a.exr}, geometry: {sphere: {}}, "
      "reflectance: {model: tiny.ibrdf, variation: none}, camera: {type: "
      "orthographic, world_from_camera: " +
          std::string(kFront) + "}, illumination: {width: 16, height: 8}}",
      {});
  ASSERT_TRUE(plain.ok()) << plain.status().message();
  const auto expected = LoadInverseProblem(*plain, 1, 1);
  ASSERT_TRUE(expected.ok()) << expected.status().message();
  EXPECT_EQ(expected->image.rgb, view->image.rgb);
  ASSERT_EQ(expected->points.size(), view->points.size());
  for (size_t i = 0; i < view->points.size(); ++i) {
    EXPECT_EQ(expected->points[i].pixel, view->points[i].pixel);
    EXPECT_EQ(expected->points[i].normal, view->points[i].normal);
  }
}

// One view's exposure is its own; the others have that of `image`.
TEST_F(LoadViewsTest, AViewMayHaveItsOwnExposure) {
  const auto p = Load(View("left", "file: a.exr, exposure: 4", kFront) +
                          View("right", "file: b.exr", kRight),
                      {"image.exposure=2"});
  ASSERT_TRUE(p.ok()) << p.status().message();
  int of_view[2] = {};
  for (const ShadingPoint& point : p->points) {
    ++of_view[point.view];
    const SheetView& view = p->sheet.views[point.view];
    const int x = point.pixel % p->sheet.width - view.x;
    const int y = point.pixel / p->sheet.width - view.y;
    const float value = (point.view == 0 ? 1.0f : 2.0f) +
                        0.001f * static_cast<float>(3 * (y * view.width + x));
    EXPECT_FLOAT_EQ(value / (point.view == 0 ? 4.0f : 2.0f),
                    p->image.rgb[size_t{3} * point.pixel]);
  }
  EXPECT_GT(of_view[0], 70);
  EXPECT_GT(of_view[1], 40);
  const auto one = Load(View("only", "file: a.exr, exposure: 4", kFront));
  ASSERT_TRUE(one.ok()) << one.status().message();
  EXPECT_FLOAT_EQ(
      (1.0f + 0.001f * static_cast<float>(3 * one->points[0].pixel)) / 4.0f,
      one->image.rgb[size_t{3} * one->points[0].pixel]);
}

TEST_F(LoadViewsTest, BlindViewsTakeNoPart) {
  const auto p = Load(View("sees", "file: a.exr", kFront) +
                      View("blind", "file: b.exr", kAway, "perspective"));
  ASSERT_TRUE(p.ok()) << p.status().message();
  for (const ShadingPoint& point : p->points) EXPECT_EQ(0, point.view);
  bool told = false;
  for (const std::string& warning : p->warnings) {
    told |= warning.find("view blind takes no part") != std::string::npos;
  }
  EXPECT_TRUE(told);
  ExpectRefused(View("a", "file: a.exr", kAway, "perspective") +
                    View("b", "file: b.exr", kAway, "perspective"),
                "no view sees the object");
}

TEST_F(LoadViewsTest, CodesBeforeFloatsHaveTheirOwnBounds) {
  const auto p = Load(View("codes", "file: a.png", kFront) +
                      View("floats", "file: b.exr", kRight));
  ASSERT_TRUE(p.ok()) << p.status().message();
  ASSERT_TRUE(p->bounds.has_value());
  for (const ShadingPoint& point : p->points) {
    const size_t k = size_t{3} * point.pixel;
    const float low = p->bounds->low.rgb[k], high = p->bounds->high.rgb[k];
    if (point.view == 0) {
      EXPECT_LT(low, p->image.rgb[k]);
      EXPECT_GT(high, p->image.rgb[k]);
    } else {
      EXPECT_EQ(p->image.rgb[k], low);
      EXPECT_EQ(p->image.rgb[k], high);
    }
  }
}

// A view from the front in Blender's world, where the camera's up is z, is that
// of ours; what the other tells of it is a warning.
TEST_F(LoadViewsTest, TheUpAxisMayBeZ) {
  const std::string blender = "[[1,0,0,0],[0,0,-1,-4],[0,1,0,0],[0,0,0,1]]";
  const std::string second = View("b", "file: b.exr", blender);
  const auto turned = Load(View("a", "file: a.exr", blender) + second,
                           {"geometry={sphere: {}, up: z}"});
  ASSERT_TRUE(turned.ok()) << turned.status().message();
  EXPECT_TRUE(turned->warnings.empty());
  const auto plain =
      Load(View("a", "file: a.exr", kFront) + View("b", "file: b.exr", kFront));
  ASSERT_TRUE(plain.ok()) << plain.status().message();
  ASSERT_EQ(plain->points.size(), turned->points.size());
  for (size_t i = 0; i < plain->points.size(); ++i) {
    EXPECT_EQ(plain->points[i].pixel, turned->points[i].pixel);
    EXPECT_LT((plain->points[i].normal - turned->points[i].normal).norm(),
              1e-6f);
    EXPECT_LT((plain->points[i].wo - turned->points[i].wo).norm(), 1e-6f);
  }
  const auto untold = Load(View("a", "file: a.exr", blender) + second);
  ASSERT_TRUE(untold.ok());
  bool told = false;
  for (const std::string& warning : untold->warnings) {
    told |= warning.find("geometry.up: z") != std::string::npos;
  }
  EXPECT_TRUE(told);
}

TEST_F(LoadViewsTest, LabelsAreOfEachView) {
  WriteCodes("one.png", 12, 10, 10);
  WriteCodes("two.png", 8, 14, 20);
  const auto p = Load(View("a", "file: a.exr, labels: one.png", kFront) +
                          View("b", "file: b.exr, labels: two.png", kRight),
                      {"reflectance={model: tiny.ibrdf}"});
  ASSERT_TRUE(p.ok()) << p.status().message();
  EXPECT_EQ(ReflectanceVariation::kLabels, p->variation);
  ASSERT_EQ(2u, p->materials.size());
  for (const ShadingPoint& point : p->points) {
    EXPECT_EQ(point.view, point.material);
  }
}

TEST_F(LoadViewsTest, ProblemsOfViewsAreRefusedByName) {
  const std::string a = View("a", "file: a.exr", kFront);
  const std::string b = View("b", "file: b.exr", kRight);
  ExpectRefused(a + View("b", "mask: black.png", kRight), "views[1].mask");
  ExpectRefused(a + "  - {name: b, camera: {}}\n", "views[1].file");
  ExpectRefused(a + b, "image: expected no file", {"image={file: a.exr}"});
  ExpectRefused(a + View("b", "file: none.exr", kRight), "none.exr");
  ExpectRefused(a + View("a", "file: b.exr", kRight),
                "expected a name that no other view has");
  ExpectRefused(a + View("b", "file: b.exr, labels: black.png", kRight),
                "views[0].labels", {"reflectance={model: tiny.ibrdf}"});
  ExpectRefused(View("a", "file: a.exr, labels: black.png", kFront) +
                    View("b", "file: b.exr, labels: black.png", kRight),
                "black.png: labels of view b",
                {"reflectance={model: tiny.ibrdf}"});
  ExpectRefused(a + b, "several views: a map of",
                {"geometry={normals: a.exr}"});
  ExpectRefused(
      View("a", "file: a.png", kFront) + View("b", "file: b.exr", kRight),
      "b.exr", {"image={response: unknown}"});
}

TEST_F(LoadViewsTest, TheLookTakesEachViewByItself) {
  // Two views of one grey each are of one material; together, as one image,
  // they would be of two.
  WriteCodes("dark.png", 12, 10, 90);
  const auto p = Load(View("a", "file: a.png", kFront) +
                      View("b", "file: dark.png", kRight));
  ASSERT_TRUE(p.ok()) << p.status().message();
  ASSERT_NE(nullptr, p->look);
  EXPECT_LT(p->look->check.like_normals.log_radiance, 1e-6);
}

}  // namespace
}  // namespace ibrdf
