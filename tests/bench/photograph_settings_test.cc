#include "ibrdf/solvers/bench/photograph_settings.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <set>

#include "ibrdf/io/photo_file.h"
#include "tests/support/temp_dir.h"

namespace ibrdf {
namespace {

Image Radiance() {
  Image image(40, 30);
  for (size_t k = 0; k < image.rgb.size(); ++k) {
    // In any order; few near the largest.
    image.rgb[k] = static_cast<float>(
        std::exp(6.0 * static_cast<double>(k * 1009 % image.rgb.size()) /
                 static_cast<double>(image.rgb.size())));
  }
  return image;
}

const PhotographSetting& Setting(const std::string& name) {
  const auto& all = PhotographSettings();
  return *std::find_if(all.begin(), all.end(),
                       [&](const auto& s) { return s.name == name; });
}

StatusOr<Photo> Written(const PhotographSetting& setting, const Image& image) {
  const TempDir dir;
  const std::string path = dir.File("a" + ExtensionOf(setting));
  const Status status = WritePhotograph(setting, image, Mask(), path);
  if (!status.ok()) return status;
  return ReadPhoto(path, PhotoOptions());
}

TEST(PhotographSettings, HaveNamesOfTheirOwnAndCanBeWritten) {
  std::set<std::string> names;
  for (const PhotographSetting& setting : PhotographSettings()) {
    EXPECT_TRUE(names.insert(setting.name).second) << setting.name;
    const StatusOr<Photo> photo = Written(setting, Radiance());
    EXPECT_TRUE(photo.ok()) << setting.name << photo.status().message();
  }
  EXPECT_EQ("hdr", PhotographSettings().front().name);
}

TEST(PhotographSettings, HdrIsTheImage) {
  EXPECT_EQ(Radiance().rgb, Written(Setting("hdr"), Radiance())->image.rgb);
}

TEST(PhotographSettings, ClippedIsTheShareThatItSays) {
  for (const auto& [name, share] : {std::pair("srgb_8_bits", 0.0),
                                    {"clipped_2", 0.02},
                                    {"clipped_20", 0.2}}) {
    const Image codes = Written(Setting(name), Radiance())->image;
    const auto white = static_cast<double>(
        std::count(codes.rgb.begin(), codes.rgb.end(), 255.0f));
    // Codes round: what is within half a code of white counts too.
    EXPECT_NEAR(share, white / static_cast<double>(codes.rgb.size()), 0.003)
        << name;
    EXPECT_GE(white, share * static_cast<double>(codes.rgb.size()) - 1.0);
  }
}

TEST(PhotographSettings, DataAndMissingDifferAtClippedValuesAlone) {
  const Image codes = Written(Setting("clipped_5"), Radiance())->image;
  const Image data = Written(Setting("clipped_5_as_data"), Radiance())->image;
  const Image missing =
      Written(Setting("clipped_5_as_missing"), Radiance())->image;
  for (size_t k = 0; k < codes.rgb.size(); ++k) {
    if (codes.rgb[k] == 255.0f) {
      EXPECT_EQ(1.0f, data.rgb[k]);
      EXPECT_TRUE(std::isnan(missing.rgb[k]));
    } else {
      EXPECT_EQ(data.rgb[k], missing.rgb[k]);
    }
  }
}

}  // namespace
}  // namespace ibrdf
