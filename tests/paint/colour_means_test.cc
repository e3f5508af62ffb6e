#include "ibrdf/solvers/paint/colour_means.h"

#include <gtest/gtest.h>

#include <cmath>
#include <limits>
#include <random>
#include <vector>

namespace ibrdf {
namespace {

constexpr double kLength = 0.1, kLuminanceLength = 0.4;

struct Points {
  std::vector<Eigen::Array2d> chroma;
  std::vector<double> luminance, values, weights;
};

Points RandomPoints(int count) {
  std::mt19937 random(7);
  std::normal_distribution<double> normal;
  Points p;
  for (int i = 0; i < count; ++i) {
    p.chroma.emplace_back(0.3 * normal(random), 0.1 * normal(random));
    p.luminance.push_back(normal(random));
    p.values.push_back(normal(random));
    p.weights.push_back(i % 7 == 0 ? 0.0 : std::exp(normal(random)));
  }
  return p;
}

// Square of a difference of cells, in lengths; infinite beyond three.
double Square(double a, double b, double origin, double length) {
  const double width = 0.5 * length;
  const double d =
      std::floor((a - origin) / width) - std::floor((b - origin) / width);
  return std::abs(d) > 6.0 ? std::numeric_limits<double>::infinity()
                           : 0.25 * d * d;
}

// The same by all pairs.
std::vector<double> SlowMeans(const Points& p, bool by_luminance) {
  double origin = 0.0;
  for (const double v : p.luminance) {
    origin += v / static_cast<double>(p.luminance.size());
  }
  std::vector<double> means;
  for (size_t i = 0; i < p.values.size(); ++i) {
    double weight = 0.0, sum = 0.0;
    for (size_t j = 0; j < p.values.size(); ++j) {
      double d2 = Square(p.chroma[i][0], p.chroma[j][0], 0.0, kLength) +
                  Square(p.chroma[i][1], p.chroma[j][1], 0.0, kLength);
      if (by_luminance) {
        d2 += Square(p.luminance[i], p.luminance[j], origin, kLuminanceLength);
      }
      const double k = std::exp(-0.5 * d2) * p.weights[j];
      weight += k;
      sum += k * p.values[j];
    }
    means.push_back(weight > 0.0 ? sum / weight : 0.0);
  }
  return means;
}

TEST(ColourMeans, AreThoseOfAllPairs) {
  const Points p = RandomPoints(400);
  const ColourMeans means(p.chroma, kLength);
  const std::vector<double> of_chroma = means.OfLikeChroma(p.values, p.weights);
  const std::vector<double> of_colour =
      means.OfLikeColour(p.values, p.weights, p.luminance, kLuminanceLength);
  const std::vector<double> slow_chroma = SlowMeans(p, false);
  const std::vector<double> slow_colour = SlowMeans(p, true);
  for (size_t i = 0; i < p.values.size(); ++i) {
    EXPECT_NEAR(slow_chroma[i], of_chroma[i], 1e-12) << i;
    EXPECT_NEAR(slow_colour[i], of_colour[i], 1e-12) << i;
  }
}

TEST(ColourMeans, BlackAndWhiteAreOfOneChromaAndTwoColours) {
  Points p;
  for (int i = 0; i < 10; ++i) {
    p.chroma.emplace_back(0.0, 0.0);
    p.luminance.push_back(i < 5 ? -1.0 : 1.0);
    p.values.push_back(i < 5 ? 3.0 : 4.0);
    p.weights.push_back(1.0);
  }
  const ColourMeans means(p.chroma, kLength);
  EXPECT_DOUBLE_EQ(3.5, means.OfLikeChroma(p.values, p.weights)[0]);
  const std::vector<double> of_colour =
      means.OfLikeColour(p.values, p.weights, p.luminance, kLuminanceLength);
  EXPECT_DOUBLE_EQ(3.0, of_colour[0]);
  EXPECT_DOUBLE_EQ(4.0, of_colour[9]);
}

TEST(ColourMeans, WildLuminanceAndNoWeightAreFinite) {
  Points p = RandomPoints(30);
  p.luminance[0] = 1e6;
  p.luminance[1] = -1e6;
  for (const bool weighted : {true, false}) {
    if (!weighted) p.weights.assign(30, 0.0);
    for (const double v : ColourMeans(p.chroma, kLength)
                              .OfLikeColour(p.values, p.weights, p.luminance,
                                            kLuminanceLength)) {
      EXPECT_TRUE(std::isfinite(v));
      if (!weighted) {
        EXPECT_EQ(0.0, v);
      }
    }
  }
}

TEST(ColourMeans, NoPointsHaveNoMeans) {
  EXPECT_TRUE(ColourMeans({}, kLength).OfLikeColour({}, {}, {}, 1.0).empty());
}

}  // namespace
}  // namespace ibrdf
