#include "ibrdf/solvers/problem/load_normals.h"

#include <gtest/gtest.h>

#include <Eigen/Core>
#include <cmath>
#include <string>

#include "ibrdf/io/exr.h"
#include "tests/support/photo_files.h"
#include "tests/support/temp_dir.h"

namespace ibrdf {
namespace {
using namespace testing;  // NOLINT

constexpr int kNormalsSize = 16;

// Unit normals of a sphere that fills the image; zero outside.
Image SphereNormals() {
  Image image(kNormalsSize, kNormalsSize);
  for (int y = 0; y < kNormalsSize; ++y) {
    for (int x = 0; x < kNormalsSize; ++x) {
      const double X = (x + 0.5) / kNormalsSize * 2 - 1,
                   Y = 1 - (y + 0.5) / kNormalsSize * 2;
      const double z = 1 - X * X - Y * Y;
      if (z <= 0) continue;
      float* n = image.At(x, y);
      n[0] = static_cast<float>(X);
      n[1] = static_cast<float>(Y);
      n[2] = static_cast<float>(std::sqrt(z));
    }
  }
  return image;
}

bool IsOutside(const Image& image, size_t pixel) {
  const float* n = &image.rgb[3 * pixel];
  return n[0] == 0 && n[1] == 0 && n[2] == 0;
}

// Each component of the object's pixels through `change`.
template <typename Change>
Image Changed(Image image, const Change& change) {
  for (size_t i = 0; i < image.num_pixels(); ++i) {
    if (IsOutside(image, i)) continue;
    for (int c = 0; c < 3; ++c) {
      image.rgb[3 * i + c] = change(c, image.rgb[3 * i + c]);
    }
  }
  return image;
}

class LoadNormalsTest : public ::testing::Test {
 protected:
  GeometrySpec Spec(const Image& image) const {
    EXPECT_TRUE(WriteExr(image, dir_.File("n.exr")).ok());
    GeometrySpec geometry;
    geometry.kind = GeometryKind::kNormals;
    geometry.file = dir_.File("n.exr");
    return geometry;
  }

  void ExpectNormals(const GeometrySpec& geometry, double tolerance,
                     size_t num_warnings) const {
    const StatusOr<NormalMap> map = LoadNormals(geometry);
    ASSERT_TRUE(map.ok()) << map.status().message();
    EXPECT_EQ(num_warnings, map->warnings.size());
    for (size_t k = 0; k < right_.rgb.size(); ++k) {
      ASSERT_NEAR(right_.rgb[k], map->normals.rgb[k], tolerance) << k;
    }
  }

  const TempDir dir_;
  const Image right_ = SphereNormals();
};

TEST_F(LoadNormalsTest, FloatsAsTheyAre) {
  ExpectNormals(Spec(right_), 0.0, 0);
}

TEST_F(LoadNormalsTest, EncodedFloatsAreFoundAndItIsSaid) {
  const auto encode = [](int, float v) { return 0.5f * (v + 1.0f); };
  GeometrySpec geometry = Spec(Changed(right_, encode));
  ExpectNormals(geometry, 1e-6, 1);
  geometry.encoding = NormalEncoding::kUnit01;
  ExpectNormals(geometry, 1e-6, 0);
}

TEST_F(LoadNormalsTest, CodesOfEightAndSixteenBits) {
  for (const int bits : {8, 16}) {
    const double largest = std::exp2(bits) - 1;
    PngSpec png;
    png.width = png.height = kNormalsSize;
    png.bits = bits;
    for (size_t i = 0; i < right_.num_pixels(); ++i) {
      for (int c = 0; c < 3; ++c) {
        const double v = 0.5 * (right_.rgb[3 * i + c] + 1.0);
        const long code = IsOutside(right_, i) ? 0 : std::lround(largest * v);
        png.rows += BigEndianBytes(static_cast<uint32_t>(code), bits / 8);
      }
    }
    WriteBytes(dir_.File("n.png"), PngBytes(png));
    GeometrySpec geometry;
    geometry.kind = GeometryKind::kNormals;
    geometry.file = dir_.File("n.png");
    ExpectNormals(geometry, 1.1 / largest, 0);
    geometry.encoding = NormalEncoding::kFloat;
    EXPECT_EQ(StatusCode::kInvalidInput, LoadNormals(geometry).status().code());
  }
}

TEST_F(LoadNormalsTest, OpenCvsFrameIsTurnedWhenAskedForAndNamedWhenNot) {
  const auto turn = [](int c, float v) { return c == 0 ? v : -v; };
  GeometrySpec geometry = Spec(Changed(right_, turn));
  const Status status = LoadNormals(geometry).status();
  EXPECT_EQ(StatusCode::kInvalidInput, status.code());
  EXPECT_NE(std::string::npos, status.message().find("n.exr: 100 % of the"));
  EXPECT_NE(std::string::npos, status.message().find("frame: opencv"));
  geometry.frame = kOpenCvFrame;
  ExpectNormals(geometry, 0.0, 0);
}

TEST_F(LoadNormalsTest, EachAxisMayPointAnywhere) {
  // x holds what is down, y what is toward the camera, z what is left.
  Image other(kNormalsSize, kNormalsSize);
  for (size_t i = 0; i < right_.num_pixels(); ++i) {
    const float* n = &right_.rgb[3 * i];
    other.rgb[3 * i] = -n[1];
    other.rgb[3 * i + 1] = n[2];
    other.rgb[3 * i + 2] = -n[0];
  }
  GeometrySpec geometry = Spec(other);
  geometry.frame = {PictureAxis::kDown, PictureAxis::kToward,
                    PictureAxis::kLeft};
  ExpectNormals(geometry, 0.0, 0);
  geometry.frame = {PictureAxis::kDown, PictureAxis::kAway, PictureAxis::kLeft};
  EXPECT_NE(std::string::npos,
            LoadNormals(geometry).status().message().find("y: toward"));
}

TEST_F(LoadNormalsTest, TheGreyGroundOfCodesIsNoObject) {
  const auto encode = [](float v) { return 0.5f * (v + 1.0f); };
  Image encoded = right_;
  for (float& v : encoded.rgb) v = encode(v) + 0.002f;  // 128 of 255
  GeometrySpec geometry = Spec(encoded);
  geometry.encoding = NormalEncoding::kUnit01;
  ExpectNormals(geometry, 0.0041, 0);
  const StatusOr<NormalMap> map = LoadNormals(geometry);
  ASSERT_TRUE(map.ok());
  for (size_t i = 0; i < right_.num_pixels(); ++i) {
    EXPECT_EQ(IsOutside(right_, i), IsOutside(map->normals, i));
  }
}

TEST_F(LoadNormalsTest, OtherPicturesAreRefused) {
  const auto expect_refused = [](const GeometrySpec& geometry) {
    const Status status = LoadNormals(geometry).status();
    EXPECT_EQ(StatusCode::kInvalidInput, status.code());
    EXPECT_NE(std::string::npos,
              status.message().find("n.exr: expected normals, found"))
        << status.message();
  };
  // Colours between 0 and 1, radiance of any size, and positions.
  Image even(kNormalsSize, kNormalsSize), radiance(kNormalsSize, kNormalsSize),
      places(kNormalsSize, kNormalsSize);
  for (size_t i = 0; i < even.rgb.size(); ++i) {
    even.rgb[i] = 0.45f + 0.05f * static_cast<float>(i % 3) + 0.15f;
    radiance.rgb[i] = std::exp2(static_cast<float>(i / 3 % 11) - 3.0f);
    const auto column = static_cast<float>(i / 3 % kNormalsSize);
    places.rgb[i] = i % 3 == 2 ? 0.1f : column * column;
  }
  expect_refused(Spec(even));
  expect_refused(Spec(radiance));
  expect_refused(Spec(places));
}

TEST_F(LoadNormalsTest, OtherLengthsAreCounted) {
  const auto stretch = [](int, float v) { return 1.5f * v; };
  const StatusOr<NormalMap> map = LoadNormals(Spec(Changed(right_, stretch)));
  ASSERT_TRUE(map.ok());
  ASSERT_EQ(size_t{1}, map->warnings.size());
  EXPECT_NE(std::string::npos, map->warnings[0].find("not of unit length"));
}

}  // namespace
}  // namespace ibrdf
