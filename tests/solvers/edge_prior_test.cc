#include "solvers/joint/edge_prior.h"

#include <gtest/gtest.h>

#include <cmath>
#include <random>

#include "tests/solvers/solver_testing.h"

namespace ibrdf {
namespace {
using namespace testing;  // NOLINT

constexpr int kHeight = 4, kWidth = 6, kSize = 3 * kHeight * kWidth;

std::vector<float> RandomLogMap(unsigned seed, float size) {
  std::mt19937 rng(seed);
  std::normal_distribution<float> gauss;
  std::vector<float> map(kSize);
  for (float& l : map) l = size * gauss(rng);
  return map;
}

double Dot(const std::vector<float>& a, const std::vector<float>& b) {
  double sum = 0.0;
  for (size_t i = 0; i < a.size(); ++i) sum += double{a[i]} * b[i];
  return sum;
}

TEST(EdgePrior, ConstantMapsCostNothing) {
  EdgePrior prior(kHeight, kWidth, 1.0, 0.3);
  std::vector<float> map(kSize, 2.5f), gradient(kSize, 0.0f);
  EXPECT_EQ(0.0, prior.Evaluate(map.data(), gradient.data()));
  EXPECT_EQ(std::vector<float>(kSize, 0.0f), gradient);
}

TEST(EdgePrior, OneStepInOneChannelCostsItsEdges) {
  // A texel of an equatorial row stands out by h: two edges along the row and
  // two down; the shares of its own row and of the row above, all 1 by
  // symmetry of four rows' middle two but for the edge to the polar row.
  const double scale = 0.7, delta = 0.3, h = 1.5;
  EdgePrior prior(kHeight, kWidth, scale, delta);
  std::vector<float> map(kSize, 0.0f);
  map[1 * kWidth + 2] = static_cast<float>(h);
  const double row_angle = kPi / kHeight;
  const auto share = [&](int r) {
    return TexelSolidAngle(r, kHeight, kWidth) /
           TexelSolidAngle(2, kHeight, kWidth);
  };
  const auto rho = [&](double angle) {
    const double t = h / (scale * std::sqrt(angle));
    return std::sqrt(t * t + delta * delta) - delta;
  };
  const double along = 2 * kPi / kWidth * std::sin(1.5 * row_angle);
  const double expected = 2 * share(1) * rho(along) +
                          share(1) * rho(row_angle) + share(0) * rho(row_angle);
  EXPECT_NEAR(expected, prior.Evaluate(map.data(), nullptr), 1e-12);
}

TEST(EdgePrior, GradientIsAddedAndMatchesDifferences) {
  for (const float size : {0.1f, 3.0f}) {
    EdgePrior prior(kHeight, kWidth, 1.0, 0.3);
    const std::vector<float> map = RandomLogMap(1, size);
    std::vector<float> gradient(kSize, 0.0f), twice;
    prior.Evaluate(map.data(), gradient.data());
    twice = gradient;
    prior.Evaluate(map.data(), twice.data());
    // Float sums of eight terms, begun elsewhere.
    for (int i = 0; i < kSize; ++i) {
      EXPECT_NEAR(2 * gradient[i], twice[i], 1e-5f * (1 + size));
    }
    for (const unsigned seed : {2u, 3u, 4u}) {
      const std::vector<float> v = RandomLogMap(seed, 1.0f);
      const double numeric = Differentiate(
          [&](double t) {
            std::vector<float> moved = map;
            for (int i = 0; i < kSize; ++i) {
              moved[i] += static_cast<float>(t * v[i]);
            }
            return std::vector<double>{prior.Evaluate(moved.data(), nullptr)};
          },
          0.1)[0];
      // Texels in float, over steps of 0.01.
      EXPECT_NEAR(numeric, Dot(gradient, v), 1e-4 * (1 + std::abs(numeric)));
    }
  }
}

TEST(EdgePrior, ProductIsSymmetricPositiveAndTouchesTheCostFromAbove) {
  EdgePrior prior(kHeight, kWidth, 1.0, 0.3);
  const std::vector<float> map = RandomLogMap(5, 0.5f);
  std::vector<float> gradient(kSize, 0.0f);
  const double cost = prior.Evaluate(map.data(), gradient.data());
  std::vector<float> u = RandomLogMap(6, 1.0f), v = RandomLogMap(7, 1.0f);
  std::vector<float> Hu(kSize, 0.0f), Hv(kSize, 0.0f);
  prior.AddProduct(u.data(), Hu.data());
  prior.AddProduct(v.data(), Hv.data());
  EXPECT_NEAR(Dot(u, Hv), Dot(v, Hu), 1e-4 * std::abs(Dot(u, Hu)));
  EXPECT_GT(Dot(u, Hu), 0.0);
  for (const float t : {-2.0f, -0.1f, 0.1f, 2.0f}) {
    std::vector<float> moved = map;
    for (int i = 0; i < kSize; ++i) moved[i] += t * v[i];
    const double bound = cost + t * Dot(gradient, v) + t * t * Dot(v, Hv) / 2;
    EXPECT_LE(prior.Evaluate(moved.data(), nullptr), bound + 1e-5 * cost);
  }
  // At a constant map the two have the same curvature: the Hessian.
  const std::vector<float> flat(kSize, 0.0f);
  std::vector<float> H(kSize, 0.0f);
  gradient.assign(kSize, 0.0f);
  prior.Evaluate(flat.data(), gradient.data());
  prior.AddProduct(v.data(), H.data());
  const float small = 1e-3f;
  std::vector<float> near = v;
  for (float& x : near) x *= small;
  EXPECT_NEAR(small * small * Dot(v, H) / 2,
              prior.Evaluate(near.data(), nullptr),
              1e-4 * small * small * Dot(v, H));
}

}  // namespace
}  // namespace ibrdf
