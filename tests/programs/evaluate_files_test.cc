#include "ibrdf/solvers/programs/evaluate_files.h"

#include <gtest/gtest.h>

#include <cmath>

#include "ibrdf/io/exr.h"
#include "ibrdf/io/merl.h"
#include "ibrdf/io/png.h"
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
                                      "brdf_log_rmse_below80"}),
            Names(m));
  EXPECT_NEAR(std::log(2.0), m[0].second, kFloorTolerance);
  EXPECT_NEAR(0.0, m[1].second, kFloorTolerance);
  for (size_t k = 0; k < size_t{kMerlBins}; ++k) table.raw[k] = -1.0;  // red
  ASSERT_TRUE(WriteMerl(table, dir.File("b")).ok());
  EXPECT_EQ(dir.File("b") + ": red: expected a bin with a positive value",
            EvaluateBrdfFiles(dir.File("a"), dir.File("b")).status().message());
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
      EvaluateIlluminationFiles(dir.File("a.exr"), dir.File("b.exr")).value();
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
