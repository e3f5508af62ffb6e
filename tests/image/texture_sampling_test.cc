#include "ibrdf/image/texture_sampling.h"

#include <gtest/gtest.h>

namespace ibrdf {
namespace {

Image Ramp(int width, int height) {
  Image image(width, height);
  for (int y = 0; y < height; ++y) {
    for (int x = 0; x < width; ++x) {
      image.At(x, y)[0] = static_cast<float>(x);
      image.At(x, y)[1] = static_cast<float>(y);
      image.At(x, y)[2] = 7.0f;
    }
  }
  return image;
}

Eigen::Array3f At(float u, float v, bool wrap = false) {
  return SampleTexture(Ramp(4, 2), {u, v}, wrap);
}

TEST(SampleTexture, CentresOfTexelsAreTheirValues) {
  // (0, 0) is the bottom left.
  EXPECT_TRUE(At(0.125f, 0.25f).isApprox(Eigen::Array3f(0, 1, 7)));
  EXPECT_TRUE(At(0.875f, 0.75f).isApprox(Eigen::Array3f(3, 0, 7)));
}

TEST(SampleTexture, IsLinearBetween) {
  EXPECT_TRUE(At(0.5f, 0.5f).isApprox(Eigen::Array3f(1.5f, 0.5f, 7)));
  EXPECT_TRUE(At(0.3125f, 0.75f).isApprox(Eigen::Array3f(0.75f, 0, 7)));
}

TEST(SampleTexture, BordersGoOnOrMeet) {
  EXPECT_TRUE(At(0.0f, 0.25f).isApprox(Eigen::Array3f(0, 1, 7)));
  EXPECT_TRUE(At(-3.0f, 9.0f).isApprox(Eigen::Array3f(0, 0, 7)));
  EXPECT_TRUE(At(0.0f, 0.25f, true).isApprox(Eigen::Array3f(1.5f, 1, 7)));
  EXPECT_TRUE(At(1.0f, 0.25f, true).isApprox(Eigen::Array3f(1.5f, 1, 7)));
}

}  // namespace
}  // namespace ibrdf
