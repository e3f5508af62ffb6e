#include "ibrdf/transport/map_sources.h"

#include <gtest/gtest.h>

#include <cmath>
#include <random>

#include "ibrdf/light/illumination_unet_plan.h"
#include "tests/support/render_testing.h"

namespace ibrdf {
namespace {
using namespace testing;  // NOLINT

TEST(SumBlocks, BlocksAreSumsOfRadianceTimesSolidAngle) {
  const int H = 8, W = 16;
  const Image map = RandomMap(H, W, 1);
  for (const int block : {1, 2, 4, 8}) {
    const std::vector<float> sums = SumBlocks(map.rgb.data(), H, W, block);
    const int rows = H / block, columns = W / block;
    ASSERT_EQ(size_t(4) * rows * columns, sums.size());
    Eigen::Array3d total = Eigen::Array3d::Zero();
    for (int r = 0; r < rows; ++r) {
      for (int c = 0; c < columns; ++c) {
        const float* sum = &sums[size_t(4) * (r * columns + c)];
        EXPECT_EQ(0.0f, sum[3]);
        for (int k = 0; k < 3; ++k) {
          double expected = 0.0;
          for (int y = r * block; y < (r + 1) * block; ++y) {
            for (int x = c * block; x < (c + 1) * block; ++x) {
              expected += TexelSolidAngle(y, H, W) * map.At(x, y)[k];
            }
          }
          // Sums in double, one rounding to float.
          EXPECT_FLOAT_EQ(static_cast<float>(expected), sum[k]);
          total[k] += sum[k];
        }
      }
    }
    // 128 roundings to float.
    EXPECT_LT((total / (4 * kPi * MeanRadiance(map)) - 1).abs().maxCoeff(),
              1e-6);
  }
}

TEST(PaddedTexels, AMapGoesOnAcrossPolesAndSeam) {
  for (const int W : {2, 6, 16}) {
    const int H = 5;
    const std::vector<int> texel = PaddedTexels(H, W);
    ASSERT_EQ(static_cast<size_t>((H + 2) * (W + 1)), texel.size());
    for (int y = -1; y <= H; ++y) {
      for (int x = 0; x <= W; ++x) {
        const UnetTexelIndex on_sphere = UnetTexel(y, x, H, W);
        EXPECT_EQ(on_sphere.row * W + on_sphere.column,
                  texel[(y + 1) * (W + 1) + x])
            << y << " " << x;
      }
    }
  }
}

// Four neighbours in the padded map, without any wrapping, are those of a
// lookup on the sphere.
TEST(PaddedTexels, LookupsNeedNoWrapping) {
  const int H = 4, W = 8;
  const Image map = RandomMap(H, W, 2);
  const std::vector<int> texel = PaddedTexels(H, W);
  std::mt19937 rng(3);
  std::normal_distribution<double> g;
  for (int trial = 0; trial < 200; ++trial) {
    // Every other one close to a pole.
    const double flat = trial % 2 == 0 ? 1.0 : 0.1;
    const Eigen::Vector3d direction(flat * g(rng), g(rng), flat * g(rng));
    double row, column;
    MapPosition(direction, H, W, &row, &column);
    row += 0.5;  // of the frame's centres
    column -= 0.5;
    if (column < 0) column += W;
    const int y = static_cast<int>(row), x = static_cast<int>(column);
    const double fy = row - y, fx = column - x;
    const int at = y * (W + 1) + x;
    Eigen::Array3d value = Eigen::Array3d::Zero();
    const auto add = [&](int entry, double weight) {
      for (int k = 0; k < 3; ++k) {
        value[k] += weight * map.rgb[size_t(3) * texel[entry] + k];
      }
    };
    add(at, (1 - fy) * (1 - fx));
    add(at + 1, (1 - fy) * fx);
    add(at + W + 1, fy * (1 - fx));
    add(at + W + 2, fy * fx);
    // Positions in double.
    EXPECT_LT((value - LookUpMap(map, direction)).abs().maxCoeff(), 1e-11);
  }
}

}  // namespace
}  // namespace ibrdf
