#include "ibrdf/solvers/report/result_metrics.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <limits>

#include "ibrdf/light/environment_map.h"
#include "ibrdf/solvers/report/brdf_sphere.h"
#include "ibrdf/solvers/report/result_images.h"

namespace ibrdf {
namespace {

// An image of 1.5, rendered as 3, in three of its four pixels.
struct FourPixels {
  FourPixels() {
    inverse.image = Image(2, 2);
    solution.render = Image(2, 2);
    std::fill(inverse.image.rgb.begin(), inverse.image.rgb.end(), 1.5f);
    for (const int pixel : {0, 1, 3}) {
      inverse.points.emplace_back();
      inverse.points.back().pixel = pixel;
      for (int c = 0; c < 3; ++c) solution.render.rgb[3 * pixel + c] = 3.0f;
    }
    solution.seconds = 12.0;
    solution.misfit = std::log(2.0);
    solution.map = ProceduralSky(8, 16);
  }
  InverseProblem inverse;
  Truth truth;
  Solution solution;
};

TEST(ResultMetrics, WithoutTruthTheImageIsAllThatCompares) {
  const FourPixels example;
  const ResultMetrics metrics =
      MeasureResult(example.inverse, example.truth, example.solution).value();
  EXPECT_EQ(12.0, metrics.seconds);
  EXPECT_FALSE(metrics.brdf.has_value());
  EXPECT_FALSE(metrics.illumination.has_value());
  ASSERT_TRUE(metrics.image.has_value());
  EXPECT_EQ(3, metrics.image->pixels);
  EXPECT_NEAR(std::log(2.0), metrics.image->log_rmse, 1e-5);
}

TEST(ResultMetrics, OnlyWhatWasEstimatedIsComparedWithTheTruth) {
  FourPixels example;
  example.truth.illumination = example.solution.map;
  EXPECT_TRUE(MeasureResult(example.inverse, example.truth, example.solution)
                  ->illumination.has_value());
  example.inverse.known_map = example.solution.map;
  EXPECT_FALSE(MeasureResult(example.inverse, example.truth, example.solution)
                   ->illumination.has_value());
}

TEST(ResultMetrics, LinesHoldTheFiniteOnesInOrder) {
  ResultMetrics metrics;
  metrics.seconds = 2.0;
  metrics.misfit = 0.0123456;
  metrics.image.emplace();
  metrics.image->psnr = std::numeric_limits<double>::infinity();
  EXPECT_EQ(size_t{5}, ListMetrics(metrics).size());
  EXPECT_EQ(std::vector<std::string>(
                {"seconds 2", "misfit 0.01235", "image_log_rmse 0", "dssim 0"}),
            MetricLines(metrics));
}

TEST(LogResidual, IsZeroWhereAPixelTookNoPart) {
  FourPixels example;
  example.inverse.image.rgb[3] = 0.0f;  // red of pixel 1
  const Image residual = LogResidual(example.inverse, example.solution);
  for (int c = 0; c < 3; ++c) {
    EXPECT_NEAR(std::log(2.0), residual.rgb[c], 1e-6);
    EXPECT_EQ(0.0f, residual.rgb[3 + c]);
    EXPECT_EQ(0.0f, residual.rgb[6 + c]);  // outside
  }
  // In the shadow of a known light.
  example.inverse.dark.unlit.assign(example.inverse.image.num_pixels(), 1);
  for (const float v : LogResidual(example.inverse, example.solution).rgb) {
    EXPECT_EQ(0.0f, v);
  }
}

// A row of texels counts by its solid angle.
TEST(AlbedoDeviation, IsThatOfTheObjectsPixels) {
  Image log_std(12, 1);
  std::vector<ShadingPoint> points(11);
  for (int x = 0; x < 11; ++x) {
    points[x].pixel = x;
    std::fill_n(log_std.At(x, 0), 3, 0.1f * static_cast<float>(x));
  }
  const AlbedoDeviation deviation = MeasureAlbedoDeviation(log_std, points);
  EXPECT_NEAR(0.5, deviation.median, 1e-6);
  EXPECT_NEAR(0.9, deviation.most, 1e-6);
}

TEST(DeterminedLight, IsWeighedBySolidAngle) {
  Image left(8, 4);
  for (int y = 0; y < 4; ++y) {
    for (int x = 0; x < 8; ++x) {
      for (int c = 0; c < 3; ++c) left.At(x, y)[c] = y == 0 ? 0.05f : 0.5f;
    }
  }
  // The cap above 45 degrees: (1 - cos 45) / 2 of the sphere.
  const double cap = 0.5 * (1.0 - std::sqrt(0.5));
  const DeterminedLight found = MeasureDetermined(left);
  EXPECT_NEAR(cap, found.share, 1e-6);
  EXPECT_NEAR(0.05 * cap + 0.5 * (1 - cap), found.variance_left, 1e-6);
}

}  // namespace
}  // namespace ibrdf
