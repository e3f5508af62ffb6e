#include "ibrdf/solvers/drawing/crop.h"

#include <gtest/gtest.h>

namespace ibrdf {
namespace {

TEST(Crop, IsTheMasksBoxWithAMarginInTheImage) {
  Mask mask(100, 60, 0);
  mask.inside[10 * 100 + 1] = mask.inside[50 * 100 + 41] = 1;
  const PixelBox box = BoxAround(mask, 100, 60);
  EXPECT_EQ(0, box.left);  // one column short of the margin of two
  EXPECT_EQ(8, box.top);
  EXPECT_EQ(44, box.width);
  EXPECT_EQ(45, box.height);
  EXPECT_EQ(size_t{2}, Crop(mask, box).CountInside());
  Image image(100, 60);
  image.At(41, 50)[2] = 3.0f;
  const Image part = Crop(image, box);
  EXPECT_EQ(3.0f, part.At(41, 42)[2]);
}

TEST(Crop, IsTheWholeImageWithoutAnObject) {
  for (const Mask& mask : {Mask(), Mask(7, 5, 0)}) {
    const PixelBox box = BoxAround(mask, 7, 5);
    EXPECT_EQ(7, box.width);
    EXPECT_EQ(5, box.height);
    EXPECT_EQ(mask.inside.size(), Crop(mask, box).inside.size());
  }
}

}  // namespace
}  // namespace ibrdf
