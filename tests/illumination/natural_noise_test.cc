#include "ibrdf/solvers/illumination/natural_noise.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>

namespace ibrdf {
namespace {

constexpr int kNoiseWidth = 64, kNoiseHeight = 32,
              kNoiseTexels = kNoiseWidth * kNoiseHeight;
constexpr int kChannels = 6;

std::vector<float> Noise(uint64_t seed) {
  IlluminationUnetOptions options;
  options.width = kNoiseWidth;
  options.height = kNoiseHeight;
  options.noise_channels = kChannels;
  options.seed = seed;
  return NaturalNoise(options);
}

double Correlation(const float* a, const float* b) {
  double sum = 0.0;
  for (int t = 0; t < kNoiseTexels; ++t) {
    sum += double{a[t]} * b[t] / kNoiseTexels;
  }
  return sum;
}

TEST(NaturalNoise, ChannelsAreStandardizedAndDiffer) {
  const std::vector<float> noise = Noise(3);
  ASSERT_EQ(size_t{kChannels} * kNoiseTexels, noise.size());
  for (int a = 0; a < kChannels; ++a) {
    const float* channel = &noise[size_t{kNoiseTexels} * a];
    double mean = 0.0;
    for (int t = 0; t < kNoiseTexels; ++t) {
      mean += double{channel[t]} / kNoiseTexels;
    }
    EXPECT_NEAR(0.0, mean, 1e-5);
    EXPECT_NEAR(1.0, Correlation(channel, channel), 1e-4);
    // Smooth draws have few degrees of freedom, so that two may be alike by
    // chance, but not the same.
    for (int b = 0; b < a; ++b) {
      EXPECT_LT(
          std::abs(Correlation(channel, &noise[size_t{kNoiseTexels} * b])),
          0.9);
    }
  }
  EXPECT_EQ(noise, Noise(3));
  EXPECT_NE(noise, Noise(4));
}

// A fine map's is of fewer texels than it: a process of its own size would take
// minutes.
TEST(NaturalNoise, OfAFineMapIsStandardizedToo) {
  IlluminationUnetOptions options;
  options.width = 1000;
  options.height = 500;
  options.noise_channels = 1;
  const std::vector<float> noise = NaturalNoise(options);
  ASSERT_EQ(size_t{1000} * 500, noise.size());
  double mean = 0.0, square = 0.0, along = 0.0;
  for (size_t t = 0; t < noise.size(); ++t) {
    mean += noise[t] / static_cast<double>(noise.size());
    square += noise[t] * noise[t] / static_cast<double>(noise.size());
    if (t > 0)
      along = std::max(along, std::abs(double{noise[t]} - noise[t - 1]));
  }
  EXPECT_NEAR(0.0, mean, 1e-4);
  EXPECT_NEAR(1.0, square, 1e-3);
  EXPECT_LT(along, 1.0);
}

// Neighbours of white noise differ by a mean square of 2.
TEST(NaturalNoise, NeighboursAreAlikeAcrossRowsAndTheSeam) {
  const std::vector<float> noise = Noise(5);
  double along = 0.0, down = 0.0, seam = 0.0;
  for (int k = 0; k < kChannels; ++k) {
    const float* n = &noise[size_t{kNoiseTexels} * k];
    const int row = kNoiseHeight / 2 - 4;
    for (int c = 0; c + 1 < kNoiseWidth; ++c) {
      along +=
          std::pow(n[row * kNoiseWidth + c + 1] - n[row * kNoiseWidth + c], 2) /
          ((kNoiseWidth - 1) * kChannels);
    }
    for (int c = 0; c < kNoiseWidth; ++c) {
      down +=
          std::pow(n[(row + 1) * kNoiseWidth + c] - n[row * kNoiseWidth + c],
                   2) /
          (kNoiseWidth * kChannels);
    }
    for (int r = 0; r < kNoiseHeight; ++r) {
      seam +=
          std::pow(n[r * kNoiseWidth] - n[r * kNoiseWidth + kNoiseWidth - 1],
                   2) /
          (kNoiseHeight * kChannels);
    }
  }
  EXPECT_LT(std::max({along, down, seam}), 0.5);
  EXPECT_GT(std::min({along, down, seam}), 0.02);
}

}  // namespace
}  // namespace ibrdf
