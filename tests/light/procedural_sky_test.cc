#include "ibrdf/light/procedural_sky.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>

#include "ibrdf/base/pi.h"
#include "ibrdf/light/environment_map.h"

namespace ibrdf {
namespace {

int BrightestTexel(const Image& map) {
  int best = 0;
  for (int t = 1; t < static_cast<int>(map.num_pixels()); ++t) {
    if (map.rgb[3 * t] > map.rgb[3 * best]) best = t;
  }
  return best;
}

TEST(ProceduralSky, IsFiniteAndPositiveAtTheEndsOfItsOptions) {
  for (const double end : {0.0, 1.0}) {
    SkyOptions options;
    options.haze = options.clouds = options.skyline = options.ground_albedo =
        end;
    options.sun_theta_degrees = 90.0 * end;
    options.sun_irradiance = 10.0 * end;
    const Image map = RenderSky(options, 32, 64);
    for (const float v : map.rgb) {
      EXPECT_TRUE(std::isfinite(v));
      EXPECT_GT(v, 0.0f);
    }
  }
}

TEST(ProceduralSky, SunIsWhereAsked) {
  for (const double theta : {5.0, 40.0, 75.0}) {
    for (const double phi : {-30.0, 60.0, 200.0}) {
      SkyOptions options;
      options.sun_theta_degrees = theta;
      options.sun_phi_degrees = phi;
      const Image map = RenderSky(options, 128, 256);
      const int t = BrightestTexel(map);
      const Eigen::Vector3d found =
          MapDirection(t / 256 + 0.5, t % 256 + 0.5, 128, 256);
      const Eigen::Vector3d asked = MapDirection(theta, phi, 180, 360);
      // Within one texel of 1.4 degrees.
      EXPECT_GT(found.dot(asked), std::cos(1.5 * kPi / 180));
    }
  }
}

TEST(ProceduralSky, SunIrradianceIsThatAskedAtAnySize) {
  for (const int height : {8, 32, 128}) {
    const SkyOptions with;
    const Image a = RenderSky(with, height, 2 * height);
    double sun = 0.0;
    for (int r = 0; r < height; ++r) {
      for (int c = 0; c < 2 * height; ++c) {
        const Eigen::Vector3d w =
            MapDirection(r + 0.5, c + 0.5, height, 2 * height);
        sun += TexelSolidAngle(r, height, 2 * height) *
               (a.At(c, r)[0] - SkyRadiance(with, w)[0]);
      }
    }
    // Sums of float texels.
    EXPECT_NEAR(with.sun_irradiance, sun, 1e-4 * with.sun_irradiance);
  }
}

TEST(ProceduralSky, IrradianceOfAnUpwardSurfaceIsOfTheSizeOfItsParts) {
  const SkyOptions options;
  const Image map = RenderSky(options, 64, 128);
  double L_o = 0.0;
  for (int r = 0; r < 32; ++r) {
    for (int c = 0; c < 128; ++c) {
      L_o += TexelSolidAngle(r, 64, 128) * std::cos(kPi * (r + 0.5) / 64) *
             map.At(c, r)[1];
    }
  }
  const double sun = options.sun_irradiance * std::cos(40 * kPi / 180);
  EXPECT_GT(L_o, 0.9 * sun);
  EXPECT_LT(L_o, sun + 3 * kPi * options.zenith_radiance);
}

TEST(ProceduralSky, HasStructureWithoutTheSun) {
  SkyOptions options;
  options.sun_irradiance = 0.0;
  const Image map = RenderSky(options, 64, 128);
  const auto [low, high] = std::minmax_element(map.rgb.begin(), map.rgb.end());
  EXPECT_GT(*high / *low, 4.0f);
  // A row through clouds and buildings is not constant.
  float row_low = 1e9f, row_high = 0.0f;
  for (int c = 0; c < 128; ++c) {
    row_low = std::min(row_low, map.At(c, 28)[1]);
    row_high = std::max(row_high, map.At(c, 28)[1]);
  }
  EXPECT_GT(row_high / row_low, 1.5f);
}

}  // namespace
}  // namespace ibrdf
