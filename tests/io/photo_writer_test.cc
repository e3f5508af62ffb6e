#include "ibrdf/io/photo_writer.h"

#include <gtest/gtest.h>

#include <cmath>

#include "ibrdf/io/photo_file.h"
#include "tests/support/temp_dir.h"

namespace ibrdf {
namespace {

CodeImage Ramp(int width, int height, int bits) {
  CodeImage codes{width, height, bits, {}};
  const int most = (1 << bits) - 1;
  for (int k = 0; k < 3 * width * height; ++k) {
    codes.rgb.push_back(static_cast<uint16_t>(
        std::lround(static_cast<double>(most) * k / (3 * width * height - 1))));
  }
  return codes;
}

StatusOr<Photo> Read(const std::string& name, const std::string& bytes) {
  const TempDir dir;
  WriteBytes(dir.File(name), bytes);
  return ReadPhoto(dir.File(name), PhotoOptions());
}

TEST(PhotoWriter, PngHoldsTheCodes) {
  for (const int bits : {8, 16}) {
    const CodeImage codes = Ramp(7, 5, bits);
    const StatusOr<Photo> photo = Read("a.png", EncodeCodesAsPng(codes));
    ASSERT_TRUE(photo.ok()) << photo.status().message();
    EXPECT_EQ(bits, photo->bits);
    EXPECT_EQ(bits, photo->significant_bits);
    ASSERT_EQ(codes.rgb.size(), photo->image.rgb.size());
    for (size_t k = 0; k < codes.rgb.size(); ++k) {
      EXPECT_EQ(codes.rgb[k], photo->image.rgb[k]);
    }
  }
}

// Codes of fewer bits stand at the same share of the file's largest code.
TEST(PhotoWriter, FewBitsFillTheFilesRange) {
  for (const int bits : {1, 3, 6, 10, 12}) {
    const CodeImage codes = Ramp(7, 5, bits);
    const StatusOr<Photo> photo = Read("a.png", EncodeCodesAsPng(codes));
    ASSERT_TRUE(photo.ok()) << photo.status().message();
    EXPECT_EQ(bits > 8 ? 16 : 8, photo->bits);
    EXPECT_EQ(bits, photo->significant_bits);
    const double most = (1 << bits) - 1, largest = (1 << photo->bits) - 1;
    for (size_t k = 0; k < codes.rgb.size(); ++k) {
      EXPECT_NEAR(codes.rgb[k] / most, photo->image.rgb[k] / largest,
                  1.0 / largest)
          << bits;
    }
  }
}

TEST(PhotoWriter, JpegIsNear) {
  CodeImage codes{16, 16, 8, {}};
  for (int y = 0; y < 16; ++y) {
    for (int x = 0; x < 16; ++x) {
      for (const int c : {8 * x + 40, 8 * y + 60, 120}) {
        codes.rgb.push_back(static_cast<uint16_t>(c));
      }
    }
  }
  const StatusOr<Photo> photo = Read("a.jpg", EncodeCodesAsJpeg(codes, 95));
  ASSERT_TRUE(photo.ok()) << photo.status().message();
  EXPECT_EQ(8, photo->bits);
  double sum = 0.0;
  for (size_t k = 0; k < codes.rgb.size(); ++k) {
    sum += std::abs(codes.rgb[k] - photo->image.rgb[k]);
  }
  EXPECT_LT(sum / static_cast<double>(codes.rgb.size()), 4.0);
  EXPECT_LT(EncodeCodesAsJpeg(codes, 10).size(),
            EncodeCodesAsJpeg(codes, 95).size());
}

}  // namespace
}  // namespace ibrdf
