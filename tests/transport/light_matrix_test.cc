#include <gtest/gtest.h>

#include <random>

#include "ibrdf/transport/transport.h"
#include "tests/support/render_testing.h"

namespace ibrdf {
namespace {
using namespace testing;  // NOLINT

class LightMatrixTest : public ::testing::Test {
 protected:
  static TransportOptions Options(int threads) {
    TransportOptions options;
    options.grid = {24, 12, 8};
    options.num_threads = threads;
    return options;
  }
  std::vector<float> RandomField() const {
    std::mt19937 rng(3);
    std::uniform_real_distribution<float> u(0.1f, 2.0f);
    std::vector<float> field(transport_.grid_shape().num_nodes());
    for (float& v : field) v = u(rng);
    return field;
  }

  const std::vector<ShadingPoint> points_ = SpherePoints(7);
  const Transport transport_{points_, 8, 16, Options(1)};
  const size_t texels_ = 8 * 16;
};

TEST_F(LightMatrixTest, TimesTheMapIsTheRender) {
  const std::vector<float> field = RandomField();
  std::vector<float> matrix(points_.size() * texels_);
  transport_.LightMatrix(field.data(), matrix.data());
  BrdfGrid grid(transport_.grid_shape());
  for (int c = 0; c < 3; ++c) {
    std::copy(field.begin(), field.end(), grid.Channel(c));
  }
  const Image map = RandomMap(8, 16, 5);
  std::vector<double> L_o(3 * points_.size());
  transport_.Render(grid, map.rgb.data(), L_o.data());
  for (size_t i = 0; i < points_.size(); ++i) {
    for (int c = 0; c < 3; ++c) {
      double sum = 0.0;
      for (size_t t = 0; t < texels_; ++t) {
        sum +=
            static_cast<double>(matrix[i * texels_ + t]) * map.rgb[3 * t + c];
      }
      // Sums of some thousand floats.
      EXPECT_NEAR(L_o[3 * i + c], sum, 1e-4 * L_o[3 * i + c]) << i;
    }
  }
}

// Five fields are one more than are taken at once.
TEST_F(LightMatrixTest, SeveralFieldsHaveTheBitsOfEach) {
  std::vector<std::vector<float>> fields(5, RandomField());
  for (size_t k = 0; k < fields.size(); ++k) {
    for (size_t i = 0; i < fields[k].size(); ++i) {
      fields[k][i] *= 1.0f + 0.1f * static_cast<float>((i + k) % 7);
    }
  }
  std::vector<std::vector<float>> matrices(
      fields.size(), std::vector<float>(points_.size() * texels_));
  std::vector<const float*> from;
  std::vector<float*> to;
  for (size_t k = 0; k < fields.size(); ++k) {
    from.push_back(fields[k].data());
    to.push_back(matrices[k].data());
  }
  transport_.LightMatrices(from, to);
  for (size_t k = 0; k < fields.size(); ++k) {
    std::vector<float> alone(matrices[k].size());
    transport_.LightMatrix(fields[k].data(), alone.data());
    EXPECT_EQ(alone, matrices[k]) << k;
    EXPECT_NE(matrices[(k + 1) % fields.size()], matrices[k]);
  }
}

TEST_F(LightMatrixTest, GradientIsTheTranspose) {
  const std::vector<float> field = RandomField();
  std::vector<float> matrix(points_.size() * texels_), adjoint(matrix.size());
  transport_.LightMatrix(field.data(), matrix.data());
  std::mt19937 rng(4);
  std::normal_distribution<float> g;
  for (float& v : adjoint) v = g(rng);
  std::vector<float> gradient(field.size());
  transport_.LightMatrixGradient(adjoint.data(), gradient.data());
  double left = 0.0, right = 0.0, size = 0.0;
  for (size_t i = 0; i < matrix.size(); ++i) {
    left += static_cast<double>(matrix[i]) * adjoint[i];
    size += std::abs(static_cast<double>(matrix[i]) * adjoint[i]);
  }
  for (size_t i = 0; i < field.size(); ++i) {
    right += static_cast<double>(field[i]) * gradient[i];
  }
  EXPECT_NEAR(left, right, 1e-5 * size);
}

TEST_F(LightMatrixTest, ThreadsDoNotChangeBits) {
  const Transport two(points_, 8, 16, Options(2));
  const std::vector<float> field = RandomField();
  std::vector<float> a(points_.size() * texels_), b(a.size());
  transport_.LightMatrix(field.data(), a.data());
  two.LightMatrix(field.data(), b.data());
  EXPECT_EQ(a, b);
  std::vector<float> ga(field.size()), gb(field.size());
  transport_.LightMatrixGradient(a.data(), ga.data());
  two.LightMatrixGradient(a.data(), gb.data());
  EXPECT_EQ(ga, gb);
}

}  // namespace
}  // namespace ibrdf
