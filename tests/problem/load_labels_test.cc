#include "ibrdf/solvers/problem/load_labels.h"

#include <gtest/gtest.h>

#include <limits>
#include <string>

#include "ibrdf/image/rgb8_image.h"
#include "ibrdf/io/png.h"
#include "tests/support/render_testing.h"
#include "tests/support/temp_dir.h"

namespace ibrdf {
namespace {
using namespace testing;  // NOLINT

constexpr int kLabelsSize = 16;

class LoadLabelsTest : public ::testing::Test {
 protected:
  LoadLabelsTest() {
    for (float& v : radiance_.rgb) v = 1.0f;
    for (int i = 0; i < kLabelsSize * kLabelsSize; ++i) {
      Set(i, 7.0f, 7.0f, 7.0f);
    }
  }
  void Set(int pixel, float r, float g, float b) {
    float* const rgb = &labels_.rgb[size_t{3} * pixel];
    rgb[0] = r;
    rgb[1] = g;
    rgb[2] = b;
  }
  int PixelAt(int x, int y) const { return y * kLabelsSize + x; }

  Image radiance_{kLabelsSize, kLabelsSize}, labels_{kLabelsSize, kLabelsSize};
  std::vector<ShadingPoint> points_ = SpherePoints(kLabelsSize);
};

TEST_F(LoadLabelsTest, LabelsAreTheValuesInOrder) {
  for (int i = 0; i < kLabelsSize * kLabelsSize; ++i) {
    const int x = i % kLabelsSize;
    if (x < 5) Set(i, 200.0f, 200.0f, 200.0f);
    if (x > 10) Set(i, 7.0f, 0.0f, 255.0f);
  }
  const auto found = LabelPoints("l.png", labels_, radiance_, &points_);
  ASSERT_TRUE(found.ok()) << found.status().message();
  EXPECT_TRUE(found->warnings.empty());
  ASSERT_EQ(size_t{3}, found->labels.size());
  EXPECT_EQ("7_0_255", found->labels[0].value);
  EXPECT_EQ("7", found->labels[1].value);
  EXPECT_EQ("200", found->labels[2].value);
  size_t counts[3] = {};
  for (const ShadingPoint& p : points_) {
    const int x = p.pixel % kLabelsSize;
    EXPECT_EQ(x < 5 ? 2 : x > 10 ? 0 : 1, p.material);
    ++counts[p.material];
  }
  for (int m = 0; m < 3; ++m) EXPECT_EQ(counts[m], found->labels[m].pixels);
  EXPECT_EQ(1, MainMaterial(found->labels));
}

TEST_F(LoadLabelsTest, ValuesOutsideTheObjectAreNone) {
  Set(0, 50.0f, 50.0f, 50.0f);  // a corner
  Set(1, std::numeric_limits<float>::quiet_NaN(), 0.0f, 0.0f);
  const auto found = LabelPoints("l.png", labels_, radiance_, &points_);
  ASSERT_TRUE(found.ok());
  ASSERT_EQ(size_t{1}, found->labels.size());
  EXPECT_EQ("7", found->labels[0].value);
}

TEST_F(LoadLabelsTest, LabelWithoutUsablePixelsGoesWithAWarning) {
  const int middle = PixelAt(kLabelsSize / 2, kLabelsSize / 2);
  Set(middle, 9.0f, 9.0f, 9.0f);
  radiance_.rgb[size_t{3} * middle + 1] = 0.0f;
  const size_t all = points_.size();
  const auto found = LabelPoints("l.png", labels_, radiance_, &points_);
  ASSERT_TRUE(found.ok());
  EXPECT_EQ(size_t{1}, found->labels.size());
  ASSERT_EQ(size_t{1}, found->warnings.size());
  EXPECT_NE(std::string::npos,
            found->warnings[0].find("l.png: reflectance.labels: the label 9"));
  ASSERT_EQ(all - 1, points_.size());
  for (size_t i = 0; i < points_.size(); ++i) {
    EXPECT_EQ(static_cast<int>(i), points_[i].index);
    EXPECT_NE(middle, points_[i].pixel);
  }
}

// What says so is the solve.
TEST_F(LoadLabelsTest, AllStayWhereNoPixelCanBeUsed) {
  for (float& v : radiance_.rgb) v = -1.0f;
  const size_t all = points_.size();
  const auto found = LabelPoints("l.png", labels_, radiance_, &points_);
  ASSERT_TRUE(found.ok());
  EXPECT_EQ(size_t{1}, found->labels.size());
  EXPECT_EQ(all, points_.size());
}

TEST_F(LoadLabelsTest, SixteenValuesAndNoMore) {
  for (int most : {16, 17}) {
    std::vector<ShadingPoint> points = points_;
    for (size_t i = 0; i < points.size(); ++i) {
      const auto v = static_cast<float>(i % most);
      Set(points[i].pixel, v, v, v);
    }
    const auto found = LabelPoints("l.png", labels_, radiance_, &points);
    ASSERT_EQ(most == 16, found.ok());
    if (found.ok()) continue;
    EXPECT_EQ(StatusCode::kInvalidInput, found.status().code());
    EXPECT_EQ(
        "l.png: reflectance.labels: expected at most 16 values at the object's "
        "pixels, found 17: smoothed edges and lossy files make many",
        found.status().message());
  }
}

TEST_F(LoadLabelsTest, RefusesOtherSizesAndNaN) {
  const auto other = LabelPoints("l.png", Image(8, 16), radiance_, &points_);
  EXPECT_EQ(
      "l.png: reflectance.labels: expected the image's size 16x16, found 8x16",
      other.status().message());
  Set(points_[3].pixel, std::numeric_limits<float>::quiet_NaN(), 0.0f, 0.0f);
  const auto nan = LabelPoints("l.exr", labels_, radiance_, &points_);
  EXPECT_EQ(
      "l.exr: reflectance.labels: expected finite values at the object's "
      "pixels",
      nan.status().message());
}

TEST_F(LoadLabelsTest, ReadsThePicture) {
  const TempDir dir;
  Rgb8Image picture(kLabelsSize, kLabelsSize);
  for (int i = 0; i < kLabelsSize * kLabelsSize; ++i) {
    if (i % kLabelsSize < kLabelsSize / 2) picture.rgb[size_t{3} * i] = 3;
  }
  ASSERT_TRUE(WritePng(picture, dir.File("l.png")).ok());
  const auto found = LoadLabels(dir.File("l.png"), radiance_, &points_);
  ASSERT_TRUE(found.ok()) << found.status().message();
  ASSERT_EQ(size_t{2}, found->labels.size());
  EXPECT_EQ("0", found->labels[0].value);
  EXPECT_EQ("3_0_0", found->labels[1].value);
  EXPECT_FALSE(LoadLabels(dir.File("none.png"), radiance_, &points_).ok());
}

}  // namespace
}  // namespace ibrdf
