#include "ibrdf/solvers/problem/sphere_outline.h"

#include <gtest/gtest.h>

#include <cmath>

#include "ibrdf/io/exr.h"
#include "ibrdf/io/png.h"
#include "ibrdf/io/problem_file.h"
#include "ibrdf/solvers/problem/load_object.h"
#include "tests/support/temp_dir.h"

namespace ibrdf {
namespace {

Mask Disc(int width, int height, double cx, double cy, double rx, double ry) {
  Mask mask(width, height, 0);
  for (int y = 0; y < height; ++y) {
    for (int x = 0; x < width; ++x) {
      mask.inside[static_cast<size_t>(y) * width + x] =
          std::hypot((x + 0.5 - cx) / rx, (y + 0.5 - cy) / ry) < 1.0 ? 255 : 0;
    }
  }
  return mask;
}

class SphereOutlineTest : public ::testing::Test {
 protected:
  std::optional<PixelCircle> Outline(const Mask& mask, size_t num_warnings) {
    std::vector<std::string> warnings;
    const auto outline = FindSphereOutline(mask, "m.png", &warnings);
    EXPECT_TRUE(outline.ok()) << outline.status().message();
    EXPECT_EQ(num_warnings, warnings.size());
    if (!warnings.empty()) warning_ = warnings[0];
    return outline.ok() ? *outline : std::nullopt;
  }
  std::string warning_;
};

TEST_F(SphereOutlineTest, StaysWhereTheMaskFillsTheImage) {
  EXPECT_FALSE(Outline(Mask(), 0).has_value());
  EXPECT_FALSE(Outline(Disc(64, 64, 32, 32, 32, 32), 0).has_value());
  EXPECT_FALSE(Outline(Disc(64, 64, 32.2, 32, 31.8, 31.8), 0).has_value());
  EXPECT_FALSE(Outline(Disc(64, 48, 32, 24, 24, 24), 0).has_value());
  EXPECT_FALSE(Outline(Mask(64, 64, 255), 0).has_value());
}

// A mask of the pixels that a ball touches, as ibrdf_render writes it, not of
// those whose centre it covers.
TEST_F(SphereOutlineTest, StaysWhereTheMaskHasEveryPixelThatIsTouched) {
  for (const int size : {8, 10, 16, 24, 33, 64, 128}) {
    Mask touched(size, size, 0);
    for (int y = 0; y < size; ++y) {
      for (int x = 0; x < size; ++x) {
        for (const double dx : {0.25, 0.75}) {
          for (const double dy : {0.25, 0.75}) {
            if (std::hypot(x + dx - 0.5 * size, y + dy - 0.5 * size) <
                0.5 * size) {
              touched.inside[static_cast<size_t>(y) * size + x] = 255;
            }
          }
        }
      }
    }
    EXPECT_FALSE(Outline(touched, 0).has_value()) << size;
  }
}

TEST_F(SphereOutlineTest, IsTheMasksElsewhere) {
  const auto outline = Outline(Disc(300, 400, 140, 230, 101, 101), 1);
  ASSERT_TRUE(outline.has_value());
  EXPECT_NEAR(140, outline->x, 0.1);
  EXPECT_NEAR(230, outline->y, 0.1);
  EXPECT_NEAR(101, outline->radius, 0.1);
  EXPECT_NE(std::string::npos, warning_.find("radius 101.0")) << warning_;
  EXPECT_EQ(std::string::npos, warning_.find("not quite a circle"));
}

TEST_F(SphereOutlineTest, WarnsOfAnEllipseAndRefusesALongOne) {
  EXPECT_TRUE(Outline(Disc(300, 400, 140, 230, 100, 93), 1).has_value());
  EXPECT_NE(std::string::npos, warning_.find("not quite a circle")) << warning_;
  std::vector<std::string> warnings;
  const Status status =
      FindSphereOutline(Disc(300, 400, 150, 250, 60, 120), "m.png", &warnings)
          .status();
  EXPECT_EQ(StatusCode::kInvalidInput, status.code());
  EXPECT_EQ(0u, status.message().find("m.png: expected the outline of a ball"));
  EXPECT_NE(std::string::npos, status.message().find("geometry.sphere"));
}

TEST_F(SphereOutlineTest, APartOfTheUnitSphereLeavesItThere) {
  Mask half = Disc(64, 64, 32, 32, 32, 32);
  for (size_t i = 0; i < half.inside.size() / 2; ++i) half.inside[i] = 0;
  EXPECT_FALSE(Outline(half, 0).has_value());
  Mask patch(64, 64, 0);
  for (int y = 20; y < 40; ++y) {
    for (int x = 15; x < 45; ++x) patch.inside[y * 64 + x] = 255;
  }
  EXPECT_FALSE(Outline(patch, 0).has_value());
}

// The points of a ball anywhere in a picture are those of the unit sphere.
TEST(SphereInAPicture, HasTheNormalsOfTheBall) {
  const TempDir dir;
  const int width = 60, height = 80;
  const double cx = 25.25, cy = 46.5, radius = 21.0;
  Image image(width, height);
  for (size_t k = 0; k < image.rgb.size(); ++k) {
    image.rgb[k] = 0.5f + 1e-3f * static_cast<float>(k % 497);
  }
  ASSERT_TRUE(WriteExr(image, dir.File("i.exr")).ok());
  ASSERT_TRUE(
      WriteMask(Disc(width, height, cx, cy, radius, radius), dir.File("m.png"))
          .ok());
  for (const std::string sphere :
       {"{centre: [25.25, 46.5], radius: 21}", "{}"}) {
    const StatusOr<Problem> problem = ParseProblem(
        dir.File("p.yaml"),
        "problem: illumination\nimage: {file: i.exr, mask: m.png}\n"
        "geometry: {sphere: " +
            sphere + "}\nreflectance: {known: {lambertian: 0.5}}\n",
        {});
    ASSERT_TRUE(problem.ok()) << problem.status().message();
    const StatusOr<PhotographedObject> object =
        LoadPhotographedObject(*problem, 1);
    ASSERT_TRUE(object.ok()) << object.status().message();
    EXPECT_EQ(sphere == "{}" ? 1u : 0u, object->warnings.size());
    EXPECT_GT(*object->look->check.overlap, 0.98);
    for (const ShadingPoint& p : object->points) {
      const double x = (p.pixel % width + 0.5 - cx) / radius;
      const double y = (cy - p.pixel / width - 0.5) / radius;
      if (std::hypot(x, y) > 0.9) continue;
      const double tolerance = sphere == "{}" ? 0.02 : 1e-6;
      ASSERT_NEAR(x, p.normal.x(), tolerance);
      ASSERT_NEAR(y, p.normal.y(), tolerance);
    }
  }
}

}  // namespace
}  // namespace ibrdf
