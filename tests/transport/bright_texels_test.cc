#include "ibrdf/transport/bright_texels.h"

#include <gtest/gtest.h>

#include "ibrdf/render/reference_renderer.h"
#include "tests/support/render_testing.h"

namespace ibrdf {
namespace {
using namespace testing;  // NOLINT

// Texels of a sun, some of another colour, and one beside a pole.
Image SunnyMap(int height, int width) {
  Image map = SmoothMap(height, width);
  const auto set = [&](int row, int column, float r, float g, float b) {
    float* const rgb = map.At(column, row);
    rgb[0] = r, rgb[1] = g, rgb[2] = b;
  };
  set(height / 5, width / 3, 9e3f, 8e3f, 7e3f);
  set(height / 5, width / 3 + 1, 4e3f, 3e3f, 2e3f);
  set(0, width / 2, 5e2f, 2e3f, 1e3f);
  return map;
}

TEST(BrightTexels, RestAndExcessAreTheMap) {
  const Image map = SunnyMap(64, 128);
  const BrightTexels split = SplitBrightTexels(map);
  ASSERT_EQ(3u, split.texels.size());
  Image sum = split.rest;
  for (const BrightTexel& texel : split.texels) {
    for (int c = 0; c < 3; ++c) {
      EXPECT_GT(texel.excess[c], 0.9 * map.At(texel.column, texel.row)[c]);
      sum.At(texel.column, texel.row)[c] += static_cast<float>(texel.excess[c]);
    }
  }
  for (size_t k = 0; k < map.rgb.size(); ++k) {
    EXPECT_FLOAT_EQ(map.rgb[k], sum.rgb[k]) << k;
  }
}

TEST(BrightTexels, EvenLightHasNone) {
  EXPECT_TRUE(SplitBrightTexels(ConstantMap(64, 128, 2.0f)).texels.empty());
  EXPECT_TRUE(SplitBrightTexels(SmoothMap(64, 128)).texels.empty());
  const BrightTexels black = SplitBrightTexels(ConstantMap(64, 128, 0.0f));
  EXPECT_TRUE(black.texels.empty());
  EXPECT_EQ(ConstantMap(64, 128, 0.0f).rgb, black.rest.rgb);
}

TEST(BrightTexels, RingsDoNotMissCoarseTexels) {
  const Image map = SunnyMap(44, 88);
  const BrightTexels split = SplitBrightTexels(map);
  EXPECT_TRUE(split.texels.empty());
  EXPECT_EQ(map.rgb, split.rest.rgb);
}

TEST(BrightTexels, AWideDirectionalLightIsLeftToTheRings) {
  Image map = ConstantMap(64, 128, 0.01f);
  for (int r = 8; r < 16; ++r) {
    for (int c = 8; c < 16; ++c) {
      for (int k = 0; k < 3; ++k) map.At(c, r)[k] = 100.0f;
    }
  }
  EXPECT_TRUE(SplitBrightTexels(map).texels.empty());
}

// As LookUpMap has it, integrated by brute force.
TEST(BrightTexels, SamplesHoldTheLightOfTheirTents) {
  const int height = 32, width = 64;
  for (const int row : {0, 9, height - 1}) {
    const BrightTexel texel = {row, width - 1, {3e3, 2e3, 1e3}};
    Image map = ConstantMap(height, width, 0.0f);
    for (int c = 0; c < 3; ++c) {
      map.At(texel.column, row)[c] = static_cast<float>(texel.excess[c]);
    }
    Eigen::Array3d slow = Eigen::Array3d::Zero();
    Eigen::Vector3d slow_mean = Eigen::Vector3d::Zero();
    const int fine = 40;
    for (int r = 0; r < height * fine; ++r) {
      const double solid_angle =
          TexelSolidAngle(r, height * fine, width * fine);
      for (int c = 0; c < width * fine; ++c) {
        const Eigen::Vector3d w =
            MapDirection(r + 0.5, c + 0.5, height * fine, width * fine);
        const Eigen::Array3d power = LookUpMap(map, w) * solid_angle;
        slow += power;
        slow_mean += power[0] * w;
      }
    }
    for (const int per_side : {2, 4, 8}) {
      Eigen::Array3d sum = Eigen::Array3d::Zero();
      Eigen::Vector3d mean = Eigen::Vector3d::Zero();
      for (const BrightSample& s :
           SampleBrightTexels({texel}, height, width, per_side)) {
        EXPECT_NEAR(1.0, s.direction.norm(), 1e-12);
        sum += s.power;
        mean += s.power[0] * s.direction;
      }
      // Around a pole the measure has a kink.
      const double tolerance = row == 9 ? 2e-3 : 0.7 / (per_side * per_side);
      for (int c = 0; c < 3; ++c) {
        EXPECT_NEAR(1.0, sum[c] / slow[c], tolerance) << row << " " << per_side;
      }
      EXPECT_GT(mean.normalized().dot(slow_mean.normalized()), 0.9995);
    }
  }
}

// Together as one by one, in fewer directions; also across the map's seam.
TEST(BrightTexels, NeighboursShareDirections) {
  const int height = 32, width = 64, per_side = 4;
  const std::vector<BrightTexel> texels = {{9, width - 1, {3.0, 2.0, 1.0}},
                                           {9, 0, {1.0, 5.0, 2.0}},
                                           {10, width - 1, {4.0, 4.0, 4.0}}};
  const auto moments = [&](const std::vector<BrightTexel>& of, size_t* count) {
    Eigen::Matrix3d sum = Eigen::Matrix3d::Zero();
    const std::vector<BrightSample> samples =
        SampleBrightTexels(of, height, width, per_side);
    for (const BrightSample& s : samples) {
      sum += s.power.matrix() * s.direction.transpose();
    }
    *count += samples.size();
    return sum;
  };
  size_t together = 0, apart = 0;
  const Eigen::Matrix3d all = moments(texels, &together);
  Eigen::Matrix3d sum = Eigen::Matrix3d::Zero();
  for (const BrightTexel& texel : texels) sum += moments({texel}, &apart);
  EXPECT_LT((all - sum).norm(), 1e-12 * sum.norm());
  EXPECT_EQ(48u, apart);
  EXPECT_EQ(32u, together);  // 16 and twice the half of 16
}

// A sun of a degree, from the mirrored view to where no peak of a lobe is.
TEST(BrightTexels, CoarseRingsShowASunToo) {
  const int height = 128, width = 256;
  Image map = SmoothMap(height, width);
  for (int c = 0; c < 3; ++c) map.At(30, 30)[c] = 1e4f;
  const std::vector<ShadingPoint> points = PointsAroundTheHighlight(
      MapDirection(30.5, 30.5, height, width), {0, 2, 5, 8, 11, 14, 20, 40});
  for (const BrdfFunction& brdf :
       {Lambertian(0.7), Glossy(0.1, 0.5, 10), Glossy(0.02, 0.5, 3)}) {
    std::vector<double> L_o(3 * points.size());
    ReferenceRenderer(map, Coarser({})).Render(points, brdf, L_o.data());
    for (size_t i = 0; i < points.size(); ++i) {
      const Eigen::Array3d slow =
          BruteForceRadiance(points[i], brdf, map, 800, 1600);
      for (int c = 0; c < 3; ++c) {
        EXPECT_NEAR(1.0, L_o[3 * i + c] / slow[c], 0.01) << i << " " << c;
      }
    }
  }
}

}  // namespace
}  // namespace ibrdf
