#include "ibrdf/approximation/harmonic_transport.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <random>

#include "ibrdf/render/scene_probe.h"
#include "tests/support/render_testing.h"

namespace ibrdf {
namespace {
using namespace testing;  // NOLINT

constexpr BrdfGridShape kHarmonicGrid = {36, 16, 12};

HarmonicOptions Order(int order) {
  HarmonicOptions options;
  options.order = order;
  options.grid = kHarmonicGrid;
  return options;
}

std::vector<double> ByHarmonics(const std::vector<ShadingPoint>& points,
                                const BrdfGrid& grid, const Image& map,
                                int order) {
  std::vector<double> L_o(3 * points.size());
  HarmonicTransport(points, map.height, map.width, Order(order))
      .Render(grid, map.rgb.data(), L_o.data());
  return L_o;
}

TEST(HarmonicTransport, WhiteFurnaceIsOneAtEveryOrderAndPoint) {
  const BrdfGrid grid = BrdfGrid::FromFunction(Lambertian(1.0), kHarmonicGrid);
  const std::vector<ShadingPoint> points = PolarAndGrazingPoints();
  for (const int order : {0, 2, 8}) {
    for (const double e :
         ByHarmonics(points, grid, ConstantMap(16, 32, 1.0f), order)) {
      EXPECT_NEAR(1.0, e, 1e-6);
    }
  }
}

TEST(HarmonicTransport, LambertUnderALinearMapMatchesTheClosedForm) {
  // L = 1 + u.w: L_o = 1 + (2/3) n.u.
  const Eigen::Vector3d u = Eigen::Vector3d(0.3, 0.5, 0.8).normalized();
  const int height = 128, width = 256;
  Image map(width, height);
  for (int r = 0; r < height; ++r) {
    for (int c = 0; c < width; ++c) {
      const double d = u.dot(MapDirection(r + 0.5, c + 0.5, height, width));
      map.At(c, r)[0] = static_cast<float>(1.0 + d);
    }
  }
  const std::vector<ShadingPoint> points = PolarAndGrazingPoints();
  const BrdfGrid grid = BrdfGrid::FromFunction(Lambertian(1.0), kHarmonicGrid);
  const std::vector<double> L_o = ByHarmonics(points, grid, map, 2);
  for (size_t i = 0; i < points.size(); ++i) {
    const double cosine = points[i].normal.cast<double>().dot(u);
    // Quadrature of 5.6 degree cells, as Transport's.
    EXPECT_NEAR(1.0 + cosine * 2.0 / 3.0, L_o[3 * i], 3e-3) << i;
  }
}

// Too smooth for a texel's interpolation to matter.
Image Blurred(const Image& map, int height, int width) {
  Image out(width, height);
  for (int r = 0; r < height; ++r) {
    for (int c = 0; c < width; ++c) {
      const Eigen::Array3d L =
          LookUpMap(map, MapDirection(r + 0.5, c + 0.5, height, width));
      for (int k = 0; k < 3; ++k) out.At(c, r)[k] = static_cast<float>(L[k]);
    }
  }
  return out;
}

// Every material converges to Transport as the order grows, at a rate that its
// roughness and the light's set.
TEST(HarmonicTransport, ConvergesToTransport) {
  std::vector<ShadingPoint> points = SpherePoints(14);
  for (const ShadingPoint& p : PolarAndGrazingPoints()) points.push_back(p);
  struct Case {
    BrdfFunction brdf;
    Image map;
    int order;
    double error;
  };
  // What is left at the high orders is the difference of the two: this one
  // takes texels as constant and interpolates between view angles.
  const Case cases[] = {
      {Lambertian(0.5), SmoothMap(32, 64), 4, 3e-3},
      {Lambertian(0.5), RandomMap(16, 32, 2), 4, 1e-2},
      {Glossy(0.1, 0.5, 20), SmoothMap(32, 64), 8, 5e-3},
      {Glossy(0.1, 0.5, 20), Blurred(RandomMap(8, 16, 2), 32, 64), 16, 1e-2}};
  for (const Case& test : cases) {
    const BrdfGrid grid = BrdfGrid::FromFunction(test.brdf, kHarmonicGrid);
    const std::vector<double> direct = Direct(points, grid, test.map);
    const double coarse =
        MeanAbsLogRatio(ByHarmonics(points, grid, test.map, 1), direct);
    const double fine = MeanAbsLogRatio(
        ByHarmonics(points, grid, test.map, test.order), direct);
    EXPECT_LT(fine, test.error);
    EXPECT_LT(fine, 0.3 * coarse);
  }
}

TEST(HarmonicTransport, BothGradientsAreTransposes) {
  std::vector<ShadingPoint> points = PolarAndGrazingPoints();
  for (const ShadingPoint& p : SpherePoints(6)) points.push_back(p);
  const HarmonicTransport transport(points, 8, 16, Order(5));
  std::mt19937 rng(4);
  std::normal_distribution<float> g;
  BrdfGrid grid(kHarmonicGrid);
  for (float& v : grid.values) v = g(rng);
  std::vector<float> map(3 * 8 * 16), by_map(map.size());
  for (float& v : map) v = g(rng);
  std::vector<double> L_o(3 * points.size()), adjoint(L_o.size());
  for (double& v : adjoint) v = g(rng);
  transport.Render(grid, map.data(), L_o.data());
  std::vector<float> by_grid(grid.values.size());
  transport.GridGradient(map.data(), adjoint.data(), by_grid.data());
  transport.ByLight(grid).ApplyTranspose(adjoint.data(), by_map.data());
  const auto dot = [](const auto& a, const auto& b) {
    double sum = 0.0;
    for (size_t k = 0; k < a.size(); ++k) sum += double{a[k]} * b[k];
    return sum;
  };
  double size = 0.0;
  for (size_t k = 0; k < L_o.size(); ++k) size += std::abs(L_o[k] * adjoint[k]);
  // Float results of double sums.
  EXPECT_NEAR(dot(L_o, adjoint), dot(by_grid, grid.values), 1e-6 * size);
  EXPECT_NEAR(dot(L_o, adjoint), dot(by_map, map), 1e-6 * size);
}

TEST(HarmonicTransport, SameBitsForAnyNumberOfThreads) {
  const std::vector<ShadingPoint> points = PolarAndGrazingPoints();
  const BrdfGrid grid =
      BrdfGrid::FromFunction(Glossy(0.1, 0.5, 20), kHarmonicGrid);
  const Image map = RandomMap(8, 16, 2);
  const std::vector<double> adjoint(3 * points.size(), 0.7);
  std::vector<double> L_o[2];
  std::vector<float> by_grid[2], by_map[2];
  for (const int k : {0, 1}) {
    HarmonicOptions options = Order(4);
    options.num_threads = k == 0 ? 1 : 5;
    const HarmonicTransport transport(points, 8, 16, options);
    L_o[k].resize(3 * points.size());
    by_grid[k].resize(grid.values.size());
    by_map[k].resize(map.rgb.size());
    transport.Render(grid, map.rgb.data(), L_o[k].data());
    transport.GridGradient(map.rgb.data(), adjoint.data(), by_grid[k].data());
    transport.ByLight(grid).ApplyTranspose(adjoint.data(), by_map[k].data());
  }
  EXPECT_EQ(L_o[0], L_o[1]);
  EXPECT_EQ(by_grid[0], by_grid[1]);
  EXPECT_EQ(by_map[0], by_map[1]);
}

TEST(HarmonicTransport, PredictsItsErrorByOrder) {
  const std::vector<ShadingPoint> points = SpherePoints(14);
  const HarmonicTransport probe(points, 16, 32, Order(20));
  for (const BrdfFunction& brdf : {Lambertian(0.5), Glossy(0.1, 0.5, 20)}) {
    for (const Image& map : {SmoothMap(16, 32), RandomMap(16, 32, 5)}) {
      const BrdfGrid grid = BrdfGrid::FromFunction(brdf, kHarmonicGrid);
      const std::vector<double> predicted =
          probe.PredictLogErrors(grid, map.rgb.data());
      const std::vector<double> full = ByHarmonics(points, grid, map, 20);
      ASSERT_EQ(21u, predicted.size());
      EXPECT_EQ(0.0, predicted[20]);
      for (const int order : {1, 2, 4, 6, 8}) {
        const double found =
            MeanAbsLogRatio(ByHarmonics(points, grid, map, order), full);
        // The map is not turned at random and its degrees are few: a factor.
        EXPECT_LT(predicted[order], 3.0 * found + 1e-5) << order;
        EXPECT_GT(predicted[order], found / 3.0 - 1e-5) << order;
        EXPECT_LE(predicted[order], predicted[order - 1]);
      }
    }
  }
}

}  // namespace
}  // namespace ibrdf
