#include "ibrdf/approximation/gaussian_light.h"

#include <gtest/gtest.h>

#include <cmath>
#include <random>

#include "ibrdf/light/procedural_sky.h"
#include "tests/support/render_testing.h"

namespace ibrdf {
namespace {
using namespace testing;  // NOLINT

// L at a unit direction.
Eigen::Array3d EvaluateGaussians(const std::vector<SphericalGaussian>& lobes,
                                 const GaussianColours& amplitudes,
                                 const Eigen::Vector3d& direction) {
  Eigen::Array3d sum = Eigen::Array3d::Zero();
  for (size_t k = 0; k < lobes.size(); ++k) {
    sum += std::exp(lobes[k].sharpness * (lobes[k].axis.dot(direction) - 1.0)) *
           amplitudes.row(static_cast<Eigen::Index>(k)).transpose().array();
  }
  return sum;
}

Eigen::Array3d Flux(const std::vector<SphericalGaussian>& lobes,
                    const GaussianColours& amplitudes) {
  Eigen::Array3d flux = Eigen::Array3d::Zero();
  for (size_t k = 0; k < lobes.size(); ++k) {
    flux += GaussianIntegral(lobes[k].sharpness) *
            amplitudes.row(static_cast<Eigen::Index>(k)).transpose().array();
  }
  return flux;
}

Image HardSky(int height, int width) {
  SkyOptions sky;
  sky.sun_radius_degrees = 0.5;
  return RenderSky(sky, height, width);
}

TEST(GaussianLight, IntegralMatchesQuadratureAtEverySharpness) {
  for (const double sharpness : {0.0, 1e-13, 1e-3, 1.0, 30.0, 1e4}) {
    // Midpoints in u = 1 - cosine, close together where the Gaussian is.
    const int n = 20000;
    double sum = 0.0;
    for (int k = 0; k < n; ++k) {
      const double a = std::pow(static_cast<double>(k) / n, 4);
      const double b = std::pow((k + 1.0) / n, 4);
      sum += std::exp(-sharpness * (a + b)) * 2.0 * (b - a) * 2.0 * kPi;
    }
    EXPECT_NEAR(1.0, GaussianIntegral(sharpness) / sum, 1e-6) << sharpness;
  }
}

TEST(GaussianLight, EnergyIsTheMaps) {
  const Image maps[] = {ConstantMap(16, 32, 2.0f), SmoothMap(30, 70),
                        RandomMap(16, 32, 3), HardSky(64, 128),
                        HardSky(128, 256)};
  for (const Image& map : maps) {
    const GaussianLight light(map);
    const Eigen::Array3d flux = Flux(light.lobes(), light.Fit(map.rgb.data()));
    const Eigen::Array3d expected = 4.0 * kPi * MeanRadiance(map);
    for (int c = 0; c < 3; ++c) {
      EXPECT_NEAR(expected[c], flux[c], 1e-6 * expected[c]);
    }
  }
}

TEST(GaussianLight, ConstantLightIsTheConstant) {
  const Image map = ConstantMap(16, 32, 2.0f);
  const GaussianLight light(map);
  EXPECT_EQ(0, light.num_peaks());
  const GaussianColours a = light.Fit(map.rgb.data());
  EXPECT_NEAR(2.0, a(0, 1), 1e-4);
  EXPECT_LT(a.bottomRows(light.count() - 1).cwiseAbs().maxCoeff(), 1e-4);
  for (const float v : light.Residual(map.rgb.data()).rgb) {
    EXPECT_NEAR(0.0, v, 1e-6);
  }
}

TEST(GaussianLight, FollowsSmoothLight) {
  const Image map = SmoothMap(64, 128);
  const GaussianLight light(map);
  const GaussianColours a = light.Fit(map.rgb.data());
  double error = 0.0, size = 0.0;
  for (int r = 0; r < map.height; ++r) {
    const double area = TexelSolidAngle(r, map.height, map.width);
    for (int c = 0; c < map.width; ++c) {
      const Eigen::Array3d L = EvaluateGaussians(
          light.lobes(), a, MapDirection(r + 0.5, c + 0.5, 64, 128));
      for (int k = 0; k < 3; ++k) {
        error += area * std::pow(L[k] - map.At(c, r)[k], 2);
        size += area * std::pow(map.At(c, r)[k], 2);
      }
    }
  }
  // 0.012: ripples as wide as the Gaussians, which no surface that is rougher
  // shows.
  EXPECT_LT(std::sqrt(error / size), 0.014);
}

TEST(GaussianLight, TheSunIsALobeOfItsOwnWithItsFluxAndDirection) {
  // 2 x 2 texels, uneven, on top of a smooth map.
  const Image soft = SmoothMap(64, 128);
  Image hard = soft;
  Eigen::Vector3d towards = Eigen::Vector3d::Zero();
  double flux = 0.0;
  for (int k = 0; k < 4; ++k) {
    const int row = 20 + k / 2, column = 30 + k % 2;
    const float added = 300.0f * static_cast<float>(1 + k);
    for (int c = 0; c < 3; ++c) hard.At(column, row)[c] += added;
    const double power = added * TexelSolidAngle(row, 64, 128);
    flux += power;
    towards += power * MapDirection(row + 0.5, column + 0.5, 64, 128);
  }
  EXPECT_EQ(0, GaussianLight(soft).num_peaks());
  const GaussianLight light(hard);
  ASSERT_EQ(1, light.num_peaks());
  const SphericalGaussian& sun = light.lobes().back();
  const GaussianColours a = light.Fit(hard.rgb.data());
  EXPECT_NEAR(1.0,
              a(light.count() - 1, 1) * GaussianIntegral(sun.sharpness) / flux,
              1e-3);
  EXPECT_LT(std::acos(std::min(sun.axis.dot(towards.normalized()), 1.0)), 1e-4);
  // As wide as a square of 2 x 2 texels, narrower for the latitude and their
  // light.
  const double variance = std::pow(2 * kPi / 64, 2) / 12.0;
  EXPECT_GT(sun.sharpness, 1.0 / variance);
  EXPECT_LT(sun.sharpness, 1.5 / variance);
  // Without it, its texels are as bright as what surrounds them.
  const Image left = light.Residual(hard.rgb.data());
  const Image soft_left = GaussianLight(soft).Residual(soft.rgb.data());
  for (size_t k = 0; k < left.num_pixels(); ++k) {
    double difference = 0.0;
    for (int c = 0; c < 3; ++c) {
      difference += (left.rgb[3 * k + c] - soft_left.rgb[3 * k + c]) / 3.0;
    }
    EXPECT_NEAR(0.0, difference, 0.02);
  }
}

TEST(GaussianLight, TransposeIsThatOfFit) {
  const Image maps[] = {SmoothMap(30, 70), HardSky(64, 128)};
  std::mt19937 rng(7);
  std::normal_distribution<float> g;
  for (const Image& chosen : maps) {
    const GaussianLight light(chosen);
    std::vector<float> map(chosen.rgb.size()), gradient(map.size());
    for (float& v : map) v = g(rng);
    GaussianColours adjoint(light.count(), 3);
    for (Eigen::Index k = 0; k < adjoint.size(); ++k)
      adjoint.data()[k] = g(rng);
    light.Transpose(adjoint, gradient.data());
    const GaussianColours a = light.Fit(map.data());
    double sum = 0.0;
    for (size_t k = 0; k < map.size(); ++k) sum += double{map[k]} * gradient[k];
    const double size = a.cwiseProduct(adjoint).cwiseAbs().sum();
    EXPECT_NEAR(a.cwiseProduct(adjoint).sum(), sum, 1e-6 * size);
  }
}

TEST(GaussianLight, TakesWhatMapsThereAre) {
  // Black; one texel of light, at a pole; nine orders of magnitude.
  Image black = ConstantMap(4, 8, 0.0f), dot = black;
  dot.At(3, 0)[0] = 1e9f;
  for (const Image& map : {black, dot, ConstantMap(1, 2, 1e-9f)}) {
    const GaussianLight light(map);
    const GaussianColours a = light.Fit(map.rgb.data());
    EXPECT_TRUE(a.allFinite());
    const Eigen::Array3d expected = 4.0 * kPi * MeanRadiance(map);
    EXPECT_NEAR(expected[0], Flux(light.lobes(), a)[0], 1e-6 * expected[0]);
  }
  EXPECT_EQ(1, GaussianLight(dot).num_peaks());
}

}  // namespace
}  // namespace ibrdf
