#include "ibrdf/solvers/photograph_check/colour_steps.h"

#include <gtest/gtest.h>

#include <cmath>
#include <functional>

namespace ibrdf {
namespace {

// A ball that fills a square image, of log radiance by right and up in [-1, 1].
std::vector<NormalSample> Ball(
    int size,
    const std::function<Eigen::Array3d(double, double)>& log_radiance) {
  std::vector<NormalSample> samples;
  for (int y = 0; y < size; ++y) {
    for (int x = 0; x < size; ++x) {
      NormalSample sample;
      sample.normal = {(2.0 * x + 1.0) / size - 1.0,
                       1.0 - (2.0 * y + 1.0) / size};
      if (sample.normal.norm() > 0.95) continue;
      sample.log_radiance = log_radiance(sample.normal.x(), sample.normal.y());
      sample.position = Eigen::Vector2i(x, y).cast<double>();
      samples.push_back(sample);
    }
  }
  return samples;
}

Eigen::Array3d RedOrGreen(bool red) {
  return red ? Eigen::Array3d(0.0, -1.0, -1.0)
             : Eigen::Array3d(-1.0, 0.0, -1.0);
}

double Of(int size,
          const std::function<Eigen::Array3d(double, double)>& log_radiance) {
  return SharpColourSteps(Ball(size, log_radiance), size, size);
}

TEST(ColourSteps, AreLinesOnceAcross) {
  // A line down the middle has 2 radii of 0.95; the object's size is the root
  // of pi of its square. A slanted one counts up to a quarter more.
  const double expected = 2.0 / std::sqrt(std::acos(-1.0));
  for (const int size : {64, 128, 300}) {
    EXPECT_NEAR(expected,
                Of(size, [](double x, double) { return RedOrGreen(x > 0.0); }),
                0.1)
        << size;
    EXPECT_NEAR(
        expected,
        Of(size, [](double x, double y) { return RedOrGreen(x + y > 0.0); }),
        0.3)
        << size;
  }
}

TEST(ColourSteps, ShadingAndWhatDriftsAreNone) {
  EXPECT_EQ(0.0, Of(128, [](double x, double) {
              return Eigen::Array3d::Constant(x > 0.0 ? 0.0 : -2.0).eval();
            }));
  EXPECT_EQ(0.0, Of(128, [](double x, double y) {
              return Eigen::Array3d(x, -x, y);
            }));
}

TEST(ColourSteps, AnEdgeOfTheSurfaceIsNone) {
  std::vector<NormalSample> samples =
      Ball(128, [](double x, double) { return RedOrGreen(x > 0.0); });
  ASSERT_GT(SharpColourSteps(samples, 128, 128), kMayBePainted);
  for (NormalSample& sample : samples) {
    sample.normal.x() += sample.normal.x() > 0.0 ? 0.3 : -0.3;
  }
  EXPECT_EQ(0.0, SharpColourSteps(samples, 128, 128));
}

TEST(ColourSteps, FewPixelsHaveNone) {
  EXPECT_EQ(0.0, SharpColourSteps({}, 4, 4));
  EXPECT_EQ(0.0, Of(2, [](double x, double) { return RedOrGreen(x > 0.0); }));
}

}  // namespace
}  // namespace ibrdf
