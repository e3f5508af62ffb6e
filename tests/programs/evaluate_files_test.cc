#include "ibrdf/solvers/programs/evaluate_files.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>

#include "ibrdf/io/exr.h"
#include "ibrdf/io/merl.h"
#include "ibrdf/io/png.h"
#include "ibrdf/solvers/programs/draw_map_file.h"
#include "tests/support/temp_dir.h"

namespace ibrdf {
namespace {

// The relative floor 1e-6 of the metrics.
constexpr double kFloorTolerance = 1e-5;

std::vector<std::string> Names(const NamedMetrics& metrics) {
  std::vector<std::string> names;
  for (const auto& entry : metrics) names.push_back(entry.first);
  return names;
}

TEST(EvaluateFiles, Brdf) {
  const TempDir dir;
  MerlTable table;
  table.raw.assign(size_t{3} * kMerlBins, 1.0);
  ASSERT_TRUE(WriteMerl(table, dir.File("b")).ok());
  for (double& v : table.raw) v = 2.0;
  ASSERT_TRUE(WriteMerl(table, dir.File("a")).ok());
  const NamedMetrics m =
      EvaluateBrdfFiles(dir.File("a"), dir.File("b")).value();
  EXPECT_EQ((std::vector<std::string>{"brdf_log_rmse", "brdf_log_rmse_aligned",
                                      "brdf_log_rmse_below80",
                                      "brdf_log_rmse_aligned_below80"}),
            Names(m));
  EXPECT_NEAR(std::log(2.0), m[0].second, kFloorTolerance);
  EXPECT_NEAR(0.0, m[1].second, kFloorTolerance);
  // Grazing bins that are e times as bright count no more.
  for (int h = 0; h < kMerlThetaH; ++h) {
    for (int d = 0; d < kMerlThetaD; ++d) {
      for (int p = 0; p < kMerlPhiD; ++p) {
        const size_t bin = MerlTable::Bin(h, d, p);
        const bool far = MerlBinLowestCosine(h, d, p) < std::cos(1.2);
        for (size_t c = 0; c < 3; ++c) {
          table.raw[c * kMerlBins + bin] = far ? 2.0 * std::exp(1.0) : 2.0;
        }
      }
    }
  }
  ASSERT_TRUE(WriteMerl(table, dir.File("a")).ok());
  const auto error = [&](double void_beyond) {
    return EvaluateBrdfFiles(dir.File("a"), dir.File("b"), void_beyond)
        .value()[0]
        .second;
  };
  EXPECT_LT(1.0, error(90.0));
  EXPECT_NEAR(std::log(2.0), error(68.7), kFloorTolerance);  // 1.2 is 68.75
  for (size_t k = 0; k < size_t{kMerlBins}; ++k) table.raw[k] = -1.0;  // red
  ASSERT_TRUE(WriteMerl(table, dir.File("b")).ok());
  EXPECT_EQ(dir.File("b") + ": red: expected a bin with a positive value",
            EvaluateBrdfFiles(dir.File("a"), dir.File("b")).status().message());
}

TEST(EvaluateFiles, AlbedoOfFloatsAndCodes) {
  const TempDir dir;
  Image image(4, 2);
  Rgb8Image codes(4, 2);
  for (size_t i = 0; i < image.rgb.size(); ++i) {
    codes.rgb[i] = static_cast<uint8_t>(51 + 102 * (i % 2));
    image.rgb[i] = 2.0f * (0.2f + 0.4f * static_cast<float>(i % 2));
  }
  ASSERT_TRUE(WriteExr(image, dir.File("a.exr")).ok());
  ASSERT_TRUE(WritePng(codes, dir.File("b.png")).ok());
  const NamedMetrics m =
      EvaluateAlbedoFiles(dir.File("a.exr"), dir.File("b.png"), "").value();
  EXPECT_EQ(
      (std::vector<std::string>{"albedo_log_rmse", "albedo_log_rmse_aligned",
                                "albedo_psnr", "albedo_dssim", "albedo_lmse"}),
      Names(m));
  EXPECT_NEAR(std::log(2.0), m[0].second, 1e-5);
  EXPECT_NEAR(0.0, m[1].second, 1e-5);
  EXPECT_EQ(
      dir.File("a.exr") + ": size: expected 2x2 as the reference, found 4x2",
      [&] {
        EXPECT_TRUE(WriteExr(Image(2, 2), dir.File("c.exr")).ok());
        return EvaluateAlbedoFiles(dir.File("a.exr"), dir.File("c.exr"), "")
            .status()
            .message();
      }());
}

TEST(EvaluateFiles, IlluminationAndImage) {
  const TempDir dir;
  Image image(4, 2);
  for (size_t i = 0; i < image.rgb.size(); ++i) image.rgb[i] = 1.0f + i % 2;
  ASSERT_TRUE(WriteExr(image, dir.File("b.exr")).ok());
  for (float& v : image.rgb) v *= 2.0f;
  image.At(3, 1)[0] = 77.0f;
  ASSERT_TRUE(WriteExr(image, dir.File("a.exr")).ok());
  const NamedMetrics illumination =
      EvaluateIlluminationFiles({dir.File("a.exr"), std::nullopt},
                                {dir.File("b.exr"), std::nullopt})
          .value()
          .metrics;
  EXPECT_EQ(
      (std::vector<std::string>{"illumination_relative_log_rmse",
                                "illumination_relative_log_rmse_aligned",
                                "illumination_relative_log_rmse_unweighted"}),
      Names(illumination));
  // The pixel that differs by more than a factor is outside the mask.
  Rgb8Image mask(4, 2);
  for (uint8_t& v : mask.rgb) v = 255;
  for (int c = 0; c < 3; ++c) mask.At(3, 1)[c] = 0;
  ASSERT_TRUE(WritePng(mask, dir.File("m.png")).ok());
  const NamedMetrics m =
      EvaluateImageFiles(dir.File("a.exr"), dir.File("b.exr"),
                         dir.File("m.png"))
          .value();
  EXPECT_EQ((std::vector<std::string>{"image_log_rmse", "image_mean_abs_log",
                                      "psnr", "dssim"}),
            Names(m));
  EXPECT_NEAR(std::log(2.0), m[0].second, kFloorTolerance);
  EXPECT_NEAR(std::log(2.0), m[1].second, kFloorTolerance);
  EXPECT_TRUE(std::isinf(m[2].second));

  ASSERT_TRUE(WritePng(Rgb8Image(1, 1), dir.File("small.png")).ok());
  EXPECT_EQ(dir.File("small.png") +
                ": size: expected 4x2 as the reference, found 1x1",
            EvaluateImageFiles(dir.File("a.exr"), dir.File("b.exr"),
                               dir.File("small.png"))
                .status()
                .message());
}

// Stripes of `width` over 16 texels, by the texel of the finest map.
Image Stripes(int width, int height) {
  Image map(width, height);
  for (int y = 0; y < height; ++y) {
    for (int x = 0; x < width; ++x) {
      for (int c = 0; c < 3; ++c) {
        map.At(x, y)[c] = 1.0f + static_cast<float>(8 * x / width);
      }
    }
  }
  return map;
}

TEST(EvaluateFiles, MapsOfTwoSizesAreComparedAtTheCoarserOne) {
  const TempDir dir;
  ASSERT_TRUE(WriteExr(Stripes(8, 4), dir.File("coarse.exr")).ok());
  ASSERT_TRUE(WriteExr(Stripes(32, 16), dir.File("fine.exr")).ok());
  for (const auto& [a, b] : {std::pair("coarse.exr", "fine.exr"),
                             std::pair("fine.exr", "coarse.exr")}) {
    const StatusOr<IlluminationComparison> compared = EvaluateIlluminationFiles(
        {dir.File(a), std::nullopt}, {dir.File(b), std::nullopt});
    ASSERT_TRUE(compared.ok()) << compared.status().message();
    EXPECT_EQ((MapSize{8, 4}), compared->compared_at);
    // The stripes are as wide as the coarser texels.
    EXPECT_NEAR(0.0, compared->metrics[0].second, 1e-6);
    EXPECT_TRUE(compared->warnings.empty());
  }
}

TEST(EvaluateFiles, MapsOfTwoFramesAreTheSameLight) {
  const TempDir dir;
  const Image map = Stripes(32, 16);
  ASSERT_TRUE(WriteExr(map, dir.File("a.exr")).ok());
  Image mirrored = map;
  for (int y = 0; y < 16; ++y) {
    for (int x = 0; x < 32; ++x) {
      std::copy_n(map.At(31 - x, y), 3, mirrored.At(x, y));
    }
  }
  ASSERT_TRUE(WriteExr(mirrored, dir.File("b.exr")).ok());
  const auto error = [&](std::optional<MapFrame> a, std::optional<MapFrame> b) {
    return EvaluateIlluminationFiles({dir.File("a.exr"), a},
                                     {dir.File("b.exr"), b})
        .value()
        .metrics[0]
        .second;
  };
  EXPECT_EQ(0.0, error(std::nullopt, MapFrame::kIbrdf01));
  EXPECT_EQ(0.0, error(MapFrame::kIbrdf01, MapFrame::kCamera));
  EXPECT_LT(0.2, error(std::nullopt, std::nullopt));
  const Status refused =
      EvaluateIlluminationFiles({dir.File("a.exr"), MapFrame::kDebevecProbe},
                                {dir.File("b.exr"), std::nullopt})
          .status();
  EXPECT_EQ(0u, refused.message().find(dir.File("a.exr") +
                                       ": frame debevec_probe expects"))
      << refused.message();
}

TEST(EvaluateFiles, MapsAreDrawn) {
  const TempDir dir;
  ASSERT_TRUE(WriteExr(Stripes(8, 4), dir.File("a.exr")).ok());
  std::vector<std::string> warnings;
  EXPECT_TRUE(
      DrawMapFile(dir.File("a.exr"), std::nullopt, dir.File("a.png"), &warnings)
          .ok());
  EXPECT_TRUE(ReadMask(dir.File("a.png")).ok());
  EXPECT_FALSE(
      DrawMapFile(dir.File("a.exr"), std::nullopt, dir.File("a.jpg"), &warnings)
          .ok());
  EXPECT_FALSE(DrawMapFile(dir.File("a.exr"), MapFrame::kCubeCross,
                           dir.File("b.png"), &warnings)
                   .ok());
}

TEST(EvaluateFiles, MissingFilesAreNamed) {
  const TempDir dir;
  for (const StatusOr<NamedMetrics>& m :
       {EvaluateBrdfFiles(dir.File("x"), dir.File("y")),
        EvaluateImageFiles(dir.File("x"), dir.File("y"), "")}) {
    EXPECT_EQ(StatusCode::kInvalidInput, m.status().code());
    EXPECT_EQ(0u, m.status().message().find(dir.File("x") + ": "));
  }
}

}  // namespace
}  // namespace ibrdf
