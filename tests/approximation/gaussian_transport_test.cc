#include "ibrdf/approximation/gaussian_transport.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <random>

#include "ibrdf/light/procedural_sky.h"
#include "ibrdf/render/scene_probe.h"
#include "tests/approximation/all_points.h"
#include "tests/support/render_testing.h"

namespace ibrdf {
namespace {
using namespace testing;  // NOLINT

constexpr BrdfGridShape kGaussianGrid = {36, 16, 12};

GaussianOptions Options(int num_threads = 0) {
  GaussianOptions options;
  options.grid = kGaussianGrid;
  options.num_threads = num_threads;
  return options;
}

std::vector<double> ByGaussians(const std::vector<ShadingPoint>& points,
                                const BrdfGrid& grid, const Image& map) {
  const GaussianLight light(map);
  const GaussianTransport transport(light.lobes(), Options());
  std::vector<double> L_o(3 * points.size());
  transport.Render(points, transport.Tabulate(grid), light.Fit(map.rgb.data()),
                   L_o.data());
  return L_o;
}

// From almost constant to the sun, above and below horizons, some dark.
std::vector<SphericalGaussian> LobesOfEverySharpness() {
  std::vector<SphericalGaussian> lobes;
  std::mt19937 rng(5);
  std::normal_distribution<double> g;
  for (const double sharpness :
       {0.0, 1e-3, 3.0, 17.0, 32.0, 33.0, 300.0, 1e4}) {
    for (int k = 0; k < 3; ++k) {
      lobes.push_back(
          {Eigen::Vector3d(g(rng), g(rng), g(rng)).normalized(), sharpness});
    }
  }
  return lobes;
}

GaussianColours RandomAmplitudes(size_t count, unsigned seed) {
  std::mt19937 rng(seed);
  std::normal_distribution<double> g;
  GaussianColours a(static_cast<Eigen::Index>(count), 3);
  for (Eigen::Index k = 0; k < a.size(); ++k) a.data()[k] = g(rng);
  return a;
}

TEST(GaussianTransport, WhiteFurnaceIsOneAtEveryPoint) {
  const BrdfGrid grid = BrdfGrid::FromFunction(Lambertian(1.0), kGaussianGrid);
  for (const double e :
       ByGaussians(PolarAndGrazingPoints(), grid, ConstantMap(16, 32, 1.0f))) {
    EXPECT_NEAR(1.0, e, 1e-5);
  }
}

// A Lambertian surface under one Gaussian, against a sum over its directions.
TEST(GaussianTransport, LambertUnderOneGaussianMatchesBruteForce) {
  const BrdfGrid grid = BrdfGrid::FromFunction(Lambertian(1.0), kGaussianGrid);
  const std::vector<ShadingPoint> points = AllPoints();
  const Eigen::Vector3d axis = Eigen::Vector3d(0.3, 0.5, 0.8).normalized();
  const Eigen::Vector3d t = axis.unitOrthogonal(), b = axis.cross(t);
  for (const double sharpness : {1e-3, 3.0, 17.0, 300.0, 1e4}) {
    const GaussianTransport transport({{axis, sharpness}}, Options());
    std::vector<double> L_o(3 * points.size());
    transport.Render(points, transport.Tabulate(grid),
                     GaussianColours::Ones(1, 3), L_o.data());
    double mean_error = 0.0;
    for (size_t i = 0; i < points.size(); ++i) {
      const Eigen::Vector3d n = points[i].normal.cast<double>().normalized();
      const double reach = std::min(2.0, 30.0 / sharpness);
      double sum = 0.0;
      for (int k = 0; k < 200; ++k) {
        const double u = reach * (k + 0.5) / 200;
        const double sine = std::sqrt(u * (2.0 - u));
        for (int j = 0; j < 60; ++j) {
          const double phi = 2.0 * kPi * (j + 0.5) / 60;
          const Eigen::Vector3d w =
              (1.0 - u) * axis + sine * (std::cos(phi) * t + std::sin(phi) * b);
          sum += std::exp(-sharpness * u) * std::max(w.dot(n), 0.0) * reach /
                 200 * 2.0 * kPi / 60 / kPi;
        }
      }
      // A share of the radiance that faces the axis.
      const double full = GaussianIntegral(sharpness) / kPi;
      mean_error += std::abs(L_o[3 * i] - sum) / full / points.size();
      EXPECT_NEAR(sum, L_o[3 * i], 6e-3 * full) << i << " " << sharpness;
    }
    EXPECT_LT(mean_error, 1e-3) << sharpness;
  }
}

TEST(GaussianTransport, AgreesWithTransport) {
  const std::vector<ShadingPoint> points = AllPoints();
  SkyOptions sky;
  sky.sun_irradiance = 0.0;
  const Image soft = RenderSky(sky, 64, 128);
  struct Case {
    const char* name;
    BrdfFunction brdf;
    Image map;
    double error;
  };
  const Case cases[] = {
      {"matte smooth", Lambertian(0.5), SmoothMap(32, 64), 6e-4},
      {"matte soft", Lambertian(0.5), soft, 1e-3},
      {"matte random", Lambertian(0.5), RandomMap(16, 32, 2), 5e-3},
      {"glossy smooth", Glossy(0.1, 0.5, 20), SmoothMap(32, 64), 2e-3},
      {"glossy soft", Glossy(0.1, 0.5, 20), soft, 3e-3}};
  for (const Case& test : cases) {
    const BrdfGrid grid = BrdfGrid::FromFunction(test.brdf, kGaussianGrid);
    const double error = MeanAbsLogRatio(ByGaussians(points, grid, test.map),
                                         Direct(points, grid, test.map));
    EXPECT_LT(error, test.error) << test.name;
  }
}

TEST(GaussianTransport, TheFunctionAndItsGridAgree) {
  const std::vector<ShadingPoint> points = AllPoints();
  const std::vector<SphericalGaussian> lobes = LobesOfEverySharpness();
  const GaussianColours a = RandomAmplitudes(lobes.size(), 3).cwiseAbs();
  const GaussianTransport transport(lobes, Options());
  const BrdfFunction brdf = Lambertian(0.5);
  const BrdfGrid grid = BrdfGrid::FromFunction(brdf, kGaussianGrid);
  std::vector<double> by_grid(3 * points.size()), by_function(by_grid.size());
  transport.Render(points, transport.Tabulate(grid), a, by_grid.data());
  transport.Render(points, transport.Tabulate(brdf), a, by_function.data());
  for (size_t k = 0; k < by_grid.size(); ++k) {
    EXPECT_NEAR(by_function[k], by_grid[k], 1e-5 * std::abs(by_function[k]));
  }
}

TEST(GaussianTransport, BothGradientsAreTransposes) {
  const std::vector<ShadingPoint> points = AllPoints();
  const std::vector<SphericalGaussian> lobes = LobesOfEverySharpness();
  const GaussianTransport transport(lobes, Options());
  std::mt19937 rng(4);
  std::normal_distribution<float> g;
  BrdfGrid grid(kGaussianGrid);
  for (float& v : grid.values) v = g(rng);
  GaussianColours a = RandomAmplitudes(lobes.size(), 6);
  a.row(1).setZero();
  std::vector<double> L_o(3 * points.size()), adjoint(L_o.size());
  for (double& v : adjoint) v = g(rng);
  const GaussianTransport::Tables tables = transport.Tabulate(grid);
  transport.Render(points, tables, a, L_o.data());
  std::vector<float> by_grid(grid.values.size());
  transport.GridGradient(points, a, adjoint.data(), by_grid.data());
  const GaussianColours by_amplitude =
      transport.AmplitudeGradient(points, tables, adjoint.data());
  double size = 0.0, sum = 0.0, grid_sum = 0.0;
  for (size_t k = 0; k < L_o.size(); ++k) {
    sum += L_o[k] * adjoint[k];
    size += std::abs(L_o[k] * adjoint[k]);
  }
  for (size_t k = 0; k < by_grid.size(); ++k) {
    grid_sum += double{by_grid[k]} * grid.values[k];
  }
  // Tables are float.
  EXPECT_NEAR(sum, grid_sum, 2e-6 * size);
  EXPECT_NEAR(sum, a.cwiseProduct(by_amplitude).sum(), 2e-6 * size);
}

// L_o is linear, so that differences have no error of their own but rounding:
// one point, one lobe and one node at a time, at ordinary and extreme ones.
TEST(GaussianTransport, GradientsMatchFiniteDifferences) {
  const std::vector<SphericalGaussian> lobes = LobesOfEverySharpness();
  GaussianOptions options = Options();
  options.view_angles = 6;
  const GaussianTransport transport(lobes, options);
  const BrdfGrid grid =
      BrdfGrid::FromFunction(Glossy(0.1, 0.5, 20), kGaussianGrid);
  const GaussianTransport::Tables tables = transport.Tabulate(grid);
  GaussianColours a = RandomAmplitudes(lobes.size(), 8);
  a.row(0).setZero();
  a.row(21).setZero();
  const std::vector<ShadingPoint> points = PolarAndGrazingPoints();
  for (const ShadingPoint& point : points) {
    const std::vector<double> adjoint = {0.7, -0.4, 1.3};
    const auto value = [&](const GaussianTransport::Tables& t,
                           const GaussianColours& amplitudes) {
      double L_o[3];
      transport.Render({point}, t, amplitudes, L_o);
      return adjoint[0] * L_o[0] + adjoint[1] * L_o[1] + adjoint[2] * L_o[2];
    };
    const GaussianColours by_amplitude =
        transport.AmplitudeGradient({point}, tables, adjoint.data());
    const double scale = by_amplitude.cwiseAbs().maxCoeff();
    for (Eigen::Index k = 0; k < a.size(); ++k) {
      GaussianColours up = a, down = a;
      up.data()[k] += 0.5;
      down.data()[k] -= 0.5;
      // Float sums of 15 tables.
      EXPECT_NEAR(by_amplitude.data()[k],
                  value(tables, up) - value(tables, down), 1e-5 * scale);
    }
    // Head on, grazing, and between.
    if (point.wo != points[6].wo) continue;
    std::vector<float> by_grid(grid.values.size());
    transport.GridGradient({point}, a, adjoint.data(), by_grid.data());
    const auto largest =
        static_cast<size_t>(std::max_element(by_grid.begin(), by_grid.end(),
                                             [](float x, float y) {
                                               return std::abs(x) < std::abs(y);
                                             }) -
                            by_grid.begin());
    for (const size_t node : {largest, size_t{0}}) {
      BrdfGrid up = grid, down = grid;
      up.values[node] += 8.0f;
      down.values[node] -= 8.0f;
      EXPECT_NEAR(by_grid[node],
                  (value(transport.Tabulate(up), a) -
                   value(transport.Tabulate(down), a)) /
                      (double{up.values[node]} - down.values[node]),
                  1e-5 * std::abs(by_grid[largest]))
          << node;
    }
  }
}

TEST(GaussianTransport, MapGradientGoesThroughTheFit) {
  const std::vector<ShadingPoint> points = PolarAndGrazingPoints();
  const Image map = RandomMap(8, 16, 3);
  const GaussianLight light(map);
  const GaussianTransport transport(light.lobes(), Options());
  const BrdfGrid grid =
      BrdfGrid::FromFunction(Glossy(0.1, 0.5, 20), kGaussianGrid);
  const GaussianTransport::Tables tables = transport.Tabulate(grid);
  std::vector<double> adjoint(3 * points.size(), 0.0);
  for (size_t k = 0; k < adjoint.size(); ++k) adjoint[k] = std::cos(1.0 + k);
  std::vector<float> gradient(map.rgb.size());
  light.Transpose(transport.AmplitudeGradient(points, tables, adjoint.data()),
                  gradient.data());
  float scale = 0.0f;
  for (const float v : gradient) scale = std::max(scale, std::abs(v));
  const auto value = [&](const Image& at) {
    std::vector<double> L_o(adjoint.size());
    transport.Render(points, tables, light.Fit(at.rgb.data()), L_o.data());
    double sum = 0.0;
    for (size_t k = 0; k < L_o.size(); ++k) sum += adjoint[k] * L_o[k];
    return sum;
  };
  for (size_t k = 0; k < gradient.size(); k += 7) {
    Image up = map, down = map;
    up.rgb[k] += 256.0f;
    down.rgb[k] -= 256.0f;
    EXPECT_NEAR(gradient[k],
                (value(up) - value(down)) / (double{up.rgb[k]} - down.rgb[k]),
                1e-5 * scale)
        << k;
  }
}

TEST(GaussianTransport, SameBitsForAnyNumberOfThreads) {
  const std::vector<ShadingPoint> points = AllPoints();
  const std::vector<SphericalGaussian> lobes = LobesOfEverySharpness();
  const GaussianColours a = RandomAmplitudes(lobes.size(), 2);
  const BrdfGrid grid =
      BrdfGrid::FromFunction(Glossy(0.1, 0.5, 20), kGaussianGrid);
  const std::vector<double> adjoint(3 * points.size(), 0.7);
  const int threads[] = {1, 2, 8};
  std::vector<double> L_o[3];
  std::vector<float> by_grid[3];
  GaussianColours by_amplitude[3];
  for (const int k : {0, 1, 2}) {
    const GaussianTransport transport(lobes, Options(threads[k]));
    const GaussianTransport::Tables tables = transport.Tabulate(grid);
    L_o[k].resize(3 * points.size());
    by_grid[k].resize(grid.values.size());
    transport.Render(points, tables, a, L_o[k].data());
    transport.GridGradient(points, a, adjoint.data(), by_grid[k].data());
    by_amplitude[k] =
        transport.AmplitudeGradient(points, tables, adjoint.data());
  }
  for (const int k : {1, 2}) {
    EXPECT_EQ(L_o[0], L_o[k]);
    EXPECT_EQ(by_grid[0], by_grid[k]);
    EXPECT_EQ(by_amplitude[0], by_amplitude[k]);
  }
}

}  // namespace
}  // namespace ibrdf
