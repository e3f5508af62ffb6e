#include "ibrdf/solvers/estimation/light_gauge.h"

#include <gtest/gtest.h>

#include <cmath>
#include <limits>

#include "ibrdf/light/environment_map.h"
#include "tests/support/render_testing.h"

namespace ibrdf {
namespace {

// A map of another hue, and its mean after the gauge's shift.
Image Reddish() {
  Image map = testing::SmoothMap(16, 32);
  for (size_t i = 0; i < map.rgb.size(); i += 3) map.rgb[i] *= 3.0f;
  return map;
}
Eigen::Array3d MeanAfter(SolverGauge gauge, const Image& map) {
  return (MeanRadiance(map).log() - LightGaugeShift(gauge, map)).exp();
}

TEST(LightGauge, PriorsAreLeftAsTheyAre) {
  EXPECT_TRUE((LightGaugeShift(SolverGauge::kPrior, Reddish()) == 0.0).all());
}

TEST(LightGauge, GreyLightKeepsTheLevel) {
  const Image map = Reddish();
  const Eigen::Array3d shift = LightGaugeShift(SolverGauge::kGreyLight, map);
  EXPECT_NEAR(0.0, shift.sum(), 1e-12);
  EXPECT_GT(shift[0], 0.5);  // the red goes to the reflectance
  const Eigen::Array3d mean = MeanAfter(SolverGauge::kGreyLight, map);
  EXPECT_NEAR(mean[0], mean[1], 1e-12 * mean[0]);
  EXPECT_NEAR(mean[0], mean[2], 1e-12 * mean[0]);
  EXPECT_NEAR(MeanRadiance(map).log().mean(), std::log(mean[0]), 1e-12);
}

TEST(LightGauge, UnitLightHasMeanOneInAnyUnit) {
  Image map = Reddish();
  for (const float unit : {1e-20f, 1.0f, 1e20f}) {
    Image scaled = map;
    for (float& v : scaled.rgb) v *= unit;
    const Eigen::Array3d mean = MeanAfter(SolverGauge::kUnitLight, scaled);
    EXPECT_LT((mean - 1.0).abs().maxCoeff(), 1e-12) << unit;
  }
}

TEST(LightGauge, LightThatHasNoMeanMovesNothing) {
  Image black = Reddish(), infinite = Reddish();
  for (size_t i = 1; i < black.rgb.size(); i += 3) black.rgb[i] = 0.0f;
  infinite.rgb[5] = std::numeric_limits<float>::infinity();
  for (const Image& map : {black, infinite}) {
    for (const SolverGauge gauge :
         {SolverGauge::kGreyLight, SolverGauge::kUnitLight}) {
      EXPECT_TRUE((LightGaugeShift(gauge, map) == 0.0).all());
    }
  }
}

}  // namespace
}  // namespace ibrdf
