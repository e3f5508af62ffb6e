#include "ibrdf/solvers/report/check_picture.h"

#include <gtest/gtest.h>

#include <limits>
#include <nlohmann/json.hpp>
#include <string>

#include "ibrdf/solvers/report/check_json.h"
#include "ibrdf/solvers/report/check_panels.h"
#include "tests/photograph_check/surfaces.h"

namespace ibrdf {
namespace {

ObjectLook LookAt(const Image& image, const Image& normals,
                  const std::vector<ShadingPoint>& points) {
  ObjectLook look;
  look.radiance = image;
  look.normal_map = normals;
  look.silhouette = Mask(image.width, image.height, 0);
  for (const ShadingPoint& point : points) {
    look.silhouette.inside[static_cast<size_t>(point.pixel)] = 1;
  }
  look.check = CheckPhotograph({image, look.mask, points, normals, false,
                                "linear", 1.0, 0, std::nullopt});
  return look;
}

Image Grey(const Image& normals) {
  return Painted(normals, [](const Eigen::Vector3d& n, int, int) {
    return Eigen::Array3d(Eigen::Array3d::Constant(1.2 + n.x()));
  });
}

TEST(CheckPanels, TheLampIsAtTheUpperLeft) {
  const Image normals = SphereNormals(64);
  const Image of_map = LampLit(normals, Mask());
  const Image of_points = LampLit(PointsOf(normals), 64, 64);
  for (const Image& lit : {of_map, of_points}) {
    EXPECT_GT(lit.At(20, 20)[0], lit.At(44, 20)[0]);
    EXPECT_GT(lit.At(20, 20)[0], lit.At(20, 44)[0]);
    EXPECT_GT(lit.At(20, 44)[0], lit.At(44, 44)[0]);
  }
  for (size_t k = 0; k < of_map.rgb.size(); ++k) {
    ASSERT_NEAR(of_map.rgb[k], of_points.rgb[k], 1e-6);
  }
}

TEST(CheckPanels, NormalsToTheRightAreRedAndUpwardsGreen) {
  const Image normals = SphereNormals(64);
  const Image colours = NormalColours(PointsOf(normals), Image(64, 64));
  EXPECT_GT(colours.At(54, 32)[0], colours.At(10, 32)[0]);
  EXPECT_GT(colours.At(32, 10)[1], colours.At(32, 54)[1]);
}

TEST(CheckPanels, MarksStandWhereThePixelsAre) {
  const Image normals = SphereNormals(64);
  Image image = Grey(normals);
  image.At(30, 30)[1] = 0.0f;
  image.At(34, 30)[1] = std::numeric_limits<float>::quiet_NaN();
  const std::vector<ShadingPoint> points = PointsOf(normals);
  const ObjectLook look = LookAt(image, normals, points);
  const Image marked =
      MarkedPixels(look, points, ExposedPhotograph(image, look.mask));
  float zero[3], no_number[3];
  ColourOf(Mark::kZero, zero);
  ColourOf(Mark::kNotFinite, no_number);
  for (int c = 0; c < 3; ++c) {
    EXPECT_EQ(zero[c], marked.At(30, 30)[c]);
    EXPECT_EQ(no_number[c], marked.At(34, 30)[c]);
  }
  EXPECT_EQ(marked.At(32, 36)[0], marked.At(32, 36)[2]);  // grey
}

TEST(CheckPicture, HasRoomForAnyShapeOfObject) {
  for (const bool wide : {false, true}) {
    Image normals(wide ? 300 : 8, wide ? 6 : 200);
    for (size_t i = 0; i < normals.num_pixels(); ++i) {
      normals.rgb[3 * i + 2] = 1.0f;
    }
    const std::vector<ShadingPoint> points = PointsOf(normals);
    const Image image = Grey(normals);
    const ObjectLook look = LookAt(image, normals, points);
    const Rgb8Image picture =
        DrawCheck({"a title\xc3\xa9", image, points, look, Image()});
    EXPECT_LE(picture.width, 1600);
    EXPECT_GT(picture.height, 300);
    EXPECT_LT(picture.height, 2000);
  }
}

TEST(CheckPicture, AOnePixelObjectCanBeDrawn) {
  Image normals(1, 1);
  normals.rgb = {0, 0, 1};
  const std::vector<ShadingPoint> points = PointsOf(normals);
  const Image image = Grey(normals);
  const ObjectLook look = LookAt(image, normals, points);
  EXPECT_FALSE(DrawCheck({"one", image, points, look, Image()}).empty());
}

TEST(CheckJson, NumbersThatAreNotKnownAreNull) {
  const Image normals = SphereNormals(32);
  const std::vector<ShadingPoint> points = PointsOf(normals);
  const Image image = Grey(normals);
  const ObjectLook look = LookAt(image, normals, points);
  const nlohmann::json json =
      nlohmann::json::parse(CheckJson(look.check, {"a warning \xff"}));
  const nlohmann::json& check = json.at("check");
  EXPECT_TRUE(check.at("overlap").is_null());
  EXPECT_TRUE(check.at("mask_pixels").is_null());
  EXPECT_TRUE(check.at("materials").at("colour_spread").is_null());
  EXPECT_EQ("cannot be told", check.at("materials").at("verdict"));
  EXPECT_EQ("as given", check.at("normals").at(0).at("hypothesis"));
  EXPECT_EQ(look.check.counts.used, check.at("pixels").at("used"));
  EXPECT_EQ(1u, json.at("warnings").size());
}

}  // namespace
}  // namespace ibrdf
