// Products and activations of the conditioners, at the portable width.
#define IBRDF_SIMD_NAMESPACE dense_kernels_test
#define IBRDF_SIMD_WIDTH 4
#include "ibrdf/flow/dense_kernels.h"

#include <gtest/gtest.h>

#include <cmath>
#include <random>
#include <vector>

namespace ibrdf {
namespace dense_kernels_test {
namespace {

std::vector<float> Random(size_t n, uint64_t seed) {
  std::mt19937_64 rng(seed);
  std::normal_distribution<float> normal;
  std::vector<float> v(n);
  for (float& x : v) x = normal(rng);
  return v;
}

TEST(DenseKernels, ProductIsTheSumForAnyNumberOfRows) {
  // Sums of up to 33 products of order 1.
  constexpr double kTolerance = 2e-5;
  const int columns = 16;
  for (const int rows : {1, 2, 3, 4, 5, 7, 13}) {
    for (const int depth : {0, 1, 8, 33}) {
      const std::vector<float> a = Random(rows * depth + 1, 1);
      const std::vector<float> b = Random(depth * columns + 1, 2);
      const std::vector<float> bias = Random(rows, 3);
      std::vector<float> c = Random(rows * columns, 4);
      const std::vector<float> before = c;
      std::vector<float> added = c;
      Product<false>(rows, columns, depth, a.data(), depth, 1, b.data(),
                     columns, c.data(), columns, bias.data());
      // A's transpose, added to what is there.
      Product<true>(rows, columns, depth, a.data(), 1, rows, b.data(), columns,
                    added.data(), columns, nullptr);
      for (int i = 0; i < rows; ++i) {
        for (int j = 0; j < columns; ++j) {
          double sum = bias[i], transposed = before[i * columns + j];
          for (int k = 0; k < depth; ++k) {
            sum += double{a[i * depth + k]} * b[k * columns + j];
            transposed += double{a[k * rows + i]} * b[k * columns + j];
          }
          EXPECT_NEAR(sum, c[i * columns + j], kTolerance);
          EXPECT_NEAR(transposed, added[i * columns + j], kTolerance);
        }
      }
    }
  }
}

TEST(DenseKernels, ActivationAndItsSlope) {
  std::vector<float> x;
  for (const float m : {0.0f, 1e-6f, 0.1f, 1.0f, 30.0f, 1e4f}) {
    for (const float s : {1.0f, -1.0f}) {
      x.push_back(s * m);
      x.push_back(s * 1.7f * m);
    }
  }
  std::vector<float> y = x;
  Activate(y.data(), static_cast<int>(y.size()));
  std::vector<float> g(x.size(), 2.0f);
  ActivationAdjoint(y.data(), g.data(), static_cast<int>(g.size()));
  for (size_t i = 0; i < x.size(); ++i) {
    const double v = x[i], root = std::sqrt(v * v + kSharpness);
    // Far left the value is 1/16 / |x|: no cancellation there.
    const double expected =
        v > 0 ? (v + root) / 2 : kSharpness / 2 / (root - v);
    EXPECT_NEAR(expected, y[i], 4e-7 * expected);
    EXPECT_NEAR(2 * 0.5 * (1 + v / root), g[i], 1e-6);
  }
}

TEST(DenseKernels, LayerGradientIsTheOuterProduct) {
  constexpr int kColumns = 8;
  DenseLayer d;
  d.in_count = 5;
  d.out_count = 3;
  const std::vector<float> inputs = Random(d.in_count * kColumns, 1);
  const std::vector<float> g = Random(d.out_count * kColumns, 2);
  std::vector<float> transposed(kColumns * PaddedCount(d.in_count));
  std::vector<float> gb(d.out_count, 1.0f);
  std::vector<float> gw(d.out_count * PaddedCount(d.in_count), 1.0f);
  AddLayerGradient<kColumns>(d, inputs.data(), g.data(), transposed.data(),
                             gb.data(), gw.data());
  for (int o = 0; o < d.out_count; ++o) {
    double bias = 1.0;
    for (int p = 0; p < kColumns; ++p) bias += g[o * kColumns + p];
    EXPECT_NEAR(bias, gb[o], 1e-5);  // eight numbers of order 1
    for (int k = 0; k < d.in_count; ++k) {
      double sum = 1.0;
      for (int p = 0; p < kColumns; ++p) {
        sum += double{g[o * kColumns + p]} * inputs[k * kColumns + p];
      }
      EXPECT_NEAR(sum, gw[o * PaddedCount(d.in_count) + k], 1e-5);
    }
  }
}

}  // namespace
}  // namespace dense_kernels_test
}  // namespace ibrdf
