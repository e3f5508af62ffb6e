#include "ibrdf/solvers/problem/load_depth.h"

#include <gtest/gtest.h>

#include <cmath>
#include <cstring>
#include <limits>
#include <string>
#include <vector>

#include "ibrdf/io/exr.h"
#include "tests/support/photo_files.h"
#include "tests/support/temp_dir.h"

namespace ibrdf {
namespace {
using namespace testing;  // NOLINT

constexpr int kWidth = 6, kHeight = 4;

std::string Npy(const std::vector<float>& values) {
  std::string header =
      "{'descr': '<f4', 'fortran_order': False, 'shape': (4, 6), }";
  header.resize(117, ' ');
  header += '\n';
  std::string bytes("\x93NUMPY\x01\x00", 8);
  bytes += static_cast<char>(header.size());
  bytes += '\0';
  bytes += header;
  bytes.append(reinterpret_cast<const char*>(values.data()),
               values.size() * sizeof(float));
  return bytes;
}

class LoadDepthTest : public ::testing::Test {
 protected:
  // A slope: depth grows by `step` per pixel to the right.
  static std::vector<float> Slope(float step) {
    std::vector<float> values;
    for (int i = 0; i < kWidth * kHeight; ++i) {
      values.push_back(10.0f + step * static_cast<float>(i % kWidth));
    }
    return values;
  }
  GeometrySpec Spec(const std::string& name) const {
    GeometrySpec geometry;
    geometry.kind = GeometryKind::kDepth;
    geometry.file = dir_.File(name);
    return geometry;
  }
  GeometrySpec WriteNpy(const std::vector<float>& values) const {
    WriteBytes(dir_.File("d.npy"), Npy(values));
    return Spec("d.npy");
  }
  GeometrySpec WritePng(int bits) const {
    PngSpec png;
    png.width = kWidth;
    png.height = kHeight;
    png.bits = bits;
    for (int i = 0; i < kWidth * kHeight; ++i) {
      for (int c = 0; c < 3; ++c) {
        png.rows += BigEndianBytes(100 + 4 * (i % kWidth), bits / 8);
      }
    }
    WriteBytes(dir_.File("d.png"), PngBytes(png));
    return Spec("d.png");
  }
  static void ExpectSlope(const GeometrySpec& geometry, double slope,
                          size_t num_warnings = 0) {
    const StatusOr<NormalMap> map = LoadDepth(geometry, Camera());
    ASSERT_TRUE(map.ok()) << map.status().message();
    EXPECT_EQ(num_warnings, map->warnings.size());
    const float* n = map->normals.At(2, 2);
    EXPECT_NEAR(slope / std::hypot(slope, 1.0), n[0], 1e-6);
    EXPECT_NEAR(0.0, n[1], 1e-6);
    EXPECT_NEAR(1.0 / std::hypot(slope, 1.0), n[2], 1e-6);
  }
  static std::string Error(const GeometrySpec& geometry,
                           const Camera& camera = Camera()) {
    const Status status = LoadDepth(geometry, camera).status();
    EXPECT_EQ(StatusCode::kInvalidInput, status.code());
    EXPECT_NE(std::string::npos, status.message().find(geometry.file));
    return status.message();
  }

  const TempDir dir_;
};

TEST_F(LoadDepthTest, FloatsTimesTheScale) {
  GeometrySpec geometry = WriteNpy(Slope(0.5f));
  ExpectSlope(geometry, 0.5);
  geometry.depth_scale = 3.0;
  ExpectSlope(geometry, 1.5);
  geometry.depth_scale = -1.0;  // heights
  ExpectSlope(geometry, -0.5);
}

TEST_F(LoadDepthTest, WholeNumbersNeedTheScale) {
  GeometrySpec geometry = WritePng(16);
  EXPECT_NE(std::string::npos, Error(geometry).find("geometry.depth_scale"));
  geometry.depth_scale = 0.125;
  ExpectSlope(geometry, 0.5);
  geometry = WritePng(8);
  geometry.depth_scale = 0.125;
  ExpectSlope(geometry, 0.5, 1);
}

TEST_F(LoadDepthTest, OpenExrOfLikeChannels) {
  const std::vector<float> values = Slope(0.5f);
  Image image(kWidth, kHeight);
  for (size_t k = 0; k < image.rgb.size(); ++k) image.rgb[k] = values[k / 3];
  EXPECT_TRUE(WriteExr(image, dir_.File("d.exr")).ok());
  ExpectSlope(Spec("d.exr"), 0.5);
  image.rgb[7] += 1.0f;
  EXPECT_TRUE(WriteExr(image, dir_.File("d.exr")).ok());
  EXPECT_NE(std::string::npos, Error(Spec("d.exr")).find("channels"));
}

TEST_F(LoadDepthTest, WhatIsNotThereIsAHole) {
  std::vector<float> values = Slope(0.5f);
  values[0] = 0.0f;
  values[5] = std::numeric_limits<float>::quiet_NaN();
  values[6] = std::numeric_limits<float>::infinity();
  values[11] = 1e10f;
  values[12] = 65504.0f;
  const StatusOr<NormalMap> map = LoadDepth(WriteNpy(values), Camera());
  ASSERT_TRUE(map.ok()) << map.status().message();
  for (const size_t pixel : {0, 5, 6, 11, 12}) {
    EXPECT_EQ(0.0f, map->normals.rgb[3 * pixel + 2]) << pixel;
  }
  ExpectSlope(Spec("d.npy"), 0.5, 1);  // the first pixel of the last row
}

TEST_F(LoadDepthTest, RefusesWhatIsNoDepth) {
  std::vector<float> none(kWidth * kHeight, 0.0f);
  EXPECT_NE(std::string::npos,
            Error(WriteNpy(none)).find("found 0 pixels of depth"));
  none[3] = 2.0f;
  EXPECT_NE(std::string::npos,
            Error(WriteNpy(none)).find("found 1 pixels of depth"));
  std::vector<float> behind = Slope(0.5f);
  behind[9] = -1.0f;
  Camera camera;
  camera.type = CameraType::kPerspective;
  EXPECT_NE(std::string::npos,
            Error(WriteNpy(behind), camera).find("depth > 0 before"));
  std::string cut = Npy(behind);
  cut.resize(cut.size() - 3);
  WriteBytes(dir_.File("cut.npy"), cut);
  Error(Spec("cut.npy"));
  WriteBytes(dir_.File("text.npy"), "depth");
  Error(Spec("text.npy"));
}

}  // namespace
}  // namespace ibrdf
