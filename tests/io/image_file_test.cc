#include "ibrdf/io/image_file.h"

#include <gtest/gtest.h>

#include "tests/support/temp_dir.h"

namespace ibrdf {
namespace {

TEST(ImageFile, ExtensionChoosesTheFormat) {
  const TempDir dir;
  Image image(9, 2);
  for (size_t i = 0; i < image.rgb.size(); ++i) image.rgb[i] = 0.5f;
  for (const char* name : {"a.exr", "b.HDR", "c.d.Exr"}) {
    const std::string path = dir.File(name);
    ASSERT_TRUE(WriteImage(image, path).ok()) << name;
    EXPECT_EQ(image.rgb, ReadImage(path).value().rgb) << name;
  }
  EXPECT_EQ("#?", ReadBytes(dir.File("b.HDR")).substr(0, 2));
  EXPECT_EQ("\x76\x2f\x31\x01", ReadBytes(dir.File("a.exr")).substr(0, 4));
}

TEST(ImageFile, OtherExtensionsAreRefused) {
  const TempDir dir;
  for (const char* name : {"a.png", "a", "exr", "a.exr/b", "a.exr."}) {
    const std::string path = dir.File(name);
    const Status read = ReadImage(path).status();
    EXPECT_EQ(StatusCode::kInvalidInput, read.code()) << name;
    EXPECT_EQ(path + ": extension: expected .exr or .hdr", read.message());
    EXPECT_EQ(read.message(), WriteImage(Image(1, 1), path).message());
  }
  EXPECT_EQ(0, dir.CountFiles());
}

}  // namespace
}  // namespace ibrdf
