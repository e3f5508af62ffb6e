#include "ibrdf/surface/prefiltered_map.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <vector>

#include "ibrdf/approximation/harmonics.h"
#include "ibrdf/light/environment_map.h"

namespace ibrdf {
namespace {

TEST(PrefilterMap, ConstantLightStaysAsItIs) {
  Image map(32, 16);
  for (float& v : map.rgb) v = 2.5f;
  const Image out = PrefilterMap(map, 0.1, 0);
  EXPECT_GE(out.height, 64);
  for (const float v : out.rgb) EXPECT_NEAR(2.5f, v, 1e-5f);
}

// One harmonic on a floor keeps exp(-(alpha l)^2) of its amplitude.
TEST(PrefilterMap, HarmonicsAreDampedByTheirDegree) {
  constexpr int kDegree = 3, kHeight = 128;
  const HarmonicBasis basis(kDegree);
  const int index = HarmonicIndex(kDegree, 2);
  std::vector<double> Y(basis.count());
  Image map(2 * kHeight, kHeight);
  for (int y = 0; y < kHeight; ++y) {
    for (int x = 0; x < 2 * kHeight; ++x) {
      basis.Evaluate(MapDirection(y + 0.5, x + 0.5, kHeight, 2 * kHeight),
                     Y.data());
      for (int c = 0; c < 3; ++c) {
        map.At(x, y)[c] = static_cast<float>(2.0 + Y[index]);
      }
    }
  }
  for (const double alpha : {0.05, 0.2, 0.5}) {
    const Image out = PrefilterMap(map, alpha, 0);
    const Eigen::Vector3d direction =
        Eigen::Vector3d(0.3, 0.5, -0.7).normalized();
    basis.Evaluate(direction, Y.data());
    // Both maps are bilinear or constant between centres of texels.
    EXPECT_NEAR(2.0 + std::exp(-alpha * alpha * 9.0) * Y[index],
                LookUpMap(out, direction)[1], 2e-3);
  }
}

TEST(PrefilterMap, ASunIsBlurredAndKeepsItsLight) {
  Image map(64, 32);
  for (float& v : map.rgb) v = 1e-3f;
  map.At(20, 12)[0] = 1e4f;
  const Image out = PrefilterMap(map, 0.2, 0);
  const auto [least, most] =
      std::minmax_element(out.rgb.begin(), out.rgb.end());
  EXPECT_TRUE(std::isfinite(*least) && std::isfinite(*most));
  EXPECT_LT(*most, 1e3f);
  EXPECT_GT(*least, -0.05f * *most);
  // Texels of the result have its value at their centres.
  EXPECT_NEAR(1.0, MeanRadiance(out)[0] / MeanRadiance(map)[0], 1e-3);
}

}  // namespace
}  // namespace ibrdf
