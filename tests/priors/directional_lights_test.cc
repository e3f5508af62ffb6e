// DirectionalLights: where an image's highlights put them, and what they add to
// it.
#include "ibrdf/solvers/priors/directional_lights.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <limits>
#include <random>

#include "ibrdf/brdf/flow_lobes.h"
#include "ibrdf/geometry/half_diff.h"
#include "ibrdf/light/environment_map.h"
#include "ibrdf/solvers/marginal/directional_responses.h"
#include "ibrdf/solvers/marginal/marginal_reflectance.h"
#include "tests/support/solver_testing.h"

namespace ibrdf {
namespace {
using namespace testing;  // NOLINT

constexpr double kDegree = kPi / 180;

double DegreesBetween(const Eigen::Vector3d& a, const Eigen::Vector3d& b) {
  return std::atan2(a.cross(b).norm(), a.dot(b)) / kDegree;
}

struct Highlight {
  Eigen::Vector3d direction;
  double brightness;
  double degrees;  // its width over mirrored directions
};

// Grey light and highlights on a sphere, with 2 % noise.
std::vector<double> Highlights(const std::vector<ShadingPoint>& points,
                               const std::vector<Highlight>& highlights) {
  std::mt19937_64 rng(3);
  std::normal_distribution<double> g;
  std::vector<double> radiance;
  for (const ShadingPoint& p : points) {
    const Eigen::Vector3d n = p.normal.cast<double>(), wo = p.wo.cast<double>();
    const Eigen::Vector3d mirrored = 2.0 * n.dot(wo) * n - wo;
    double sum = 1.0;
    for (const Highlight& h : highlights) {
      const double x = DegreesBetween(mirrored, h.direction) / h.degrees;
      sum += h.brightness * std::exp(-0.5 * x * x);
    }
    // Luminance is weighted by the cosine, as mirrors grow towards the limb.
    for (int c = 0; c < 3; ++c) {
      radiance.push_back(sum / n.dot(wo) * std::exp(0.02 * g(rng)));
    }
  }
  return radiance;
}

Eigen::Vector3d Unit(double x, double y, double z) {
  return Eigen::Vector3d(x, y, z).normalized();
}

TEST(FindDirectionalLights, HighlightsTellDirectionsTheBrightestFirst) {
  const std::vector<ShadingPoint> points = SpherePoints(64);
  const Eigen::Vector3d front = Unit(0.5, 0.6, 0.6), back = Unit(-0.8, 0, -0.5);
  const std::vector<double> radiance =
      Highlights(points, {{front, 2.0, 5.0}, {back, 6.0, 4.0}});
  const std::vector<Eigen::Vector3d> directional_lights =
      FindDirectionalLights(points, radiance, 3);
  ASSERT_EQ(2u, directional_lights.size());
  EXPECT_LT(DegreesBetween(back, directional_lights[0]), 1.5);
  EXPECT_LT(DegreesBetween(front, directional_lights[1]), 1.0);
  EXPECT_EQ(1u, FindDirectionalLights(points, radiance, 1).size());
  EXPECT_TRUE(FindDirectionalLights(points, radiance, 0).empty());
}

TEST(FindDirectionalLights, ShouldersOfAWideHighlightAreNoDirectionalLights) {
  const std::vector<ShadingPoint> points = SpherePoints(64);
  const std::vector<double> radiance =
      Highlights(points, {{Unit(0.3, 0.6, 0.7), 20.0, 14.0}});
  EXPECT_EQ(1u, FindDirectionalLights(points, radiance, 5).size());
}

// A facet that mirrors a directional light has pixels of one normal and one
// radiance.
TEST(FindDirectionalLights, EqualPixelsAreOneDirectionalLight) {
  std::vector<ShadingPoint> points = SpherePoints(64);
  std::vector<double> radiance = Highlights(points, {});
  const size_t facet = points.size() / 2 + 10;
  for (int k = 0; k < 200; ++k) {
    points.push_back(points[facet]);
    radiance.insert(radiance.end(), {9.0, 9.0, 9.0});
  }
  EXPECT_EQ(1u, FindDirectionalLights(points, radiance, 3).size());
}

// The brightest pixels of a plateau are where it is seen best, and say nothing
// of where the light is.
TEST(FindDirectionalLights, AClippedHighlightIsInItsMiddle) {
  const std::vector<ShadingPoint> points = SpherePoints(96);
  const Eigen::Vector3d light = Unit(0.6, 0.5, 0.1);
  std::vector<double> radiance = Highlights(points, {{light, 300.0, 8.0}});
  std::vector<char> clipped(points.size(), 0);
  constexpr double kWhite = 4.0;
  for (size_t i = 0; i < radiance.size(); ++i) {
    if (radiance[i] < kWhite) continue;
    radiance[i] = kWhite;
    clipped[i / 3] = 1;
  }
  const std::vector<Eigen::Vector3d> found =
      FindDirectionalLights(points, radiance, 1, clipped);
  ASSERT_EQ(1u, found.size());
  EXPECT_LT(DegreesBetween(light, found[0]), 3.0);
  const std::vector<Eigen::Vector3d> unaware =
      FindDirectionalLights(points, radiance, 1);
  ASSERT_EQ(1u, unaware.size());
  EXPECT_GT(DegreesBetween(light, unaware[0]),
            1.5 * DegreesBetween(light, found[0]));
}

TEST(FindDirectionalLights, NoiseIsNoDirectionalLight) {
  const std::vector<ShadingPoint> points = SpherePoints(64);
  EXPECT_TRUE(FindDirectionalLights(points, Highlights(points, {}), 5).empty());
}

TEST(FindDirectionalLights, PixelsThatAreNotLightTakeNoPart) {
  const std::vector<ShadingPoint> points = SpherePoints(64);
  const Eigen::Vector3d directional_light = Unit(0.5, 0.6, 0.6);
  std::vector<double> radiance =
      Highlights(points, {{directional_light, 5.0, 5.0}});
  for (size_t i = 0; i < points.size(); i += 7) {
    for (int c = 0; c < 3; ++c) {
      radiance[3 * i + c] =
          i % 2 == 0 ? std::numeric_limits<double>::infinity() : -1.0;
    }
  }
  const std::vector<Eigen::Vector3d> directional_lights =
      FindDirectionalLights(points, radiance, 5);
  ASSERT_EQ(1u, directional_lights.size());
  EXPECT_LT(DegreesBetween(directional_light, directional_lights[0]), 1.0);
  EXPECT_TRUE(FindDirectionalLights({}, {}, 3).empty());
}

TEST(MovedDirectionalLight, OffsetsAreTangentsOfAngles) {
  const Eigen::Vector3d directional_light = Unit(-0.4, 0.3, -0.8);
  for (const auto& [x, y] : {std::pair(0.0, 0.0), std::pair(0.05, 0.0),
                             std::pair(0.0, -2.0), std::pair(0.3, 0.4)}) {
    const double offsets[2] = {x, y};
    const Eigen::Vector3d moved =
        MovedDirectionalLight(directional_light, offsets);
    EXPECT_NEAR(1.0, moved.norm(), 1e-12);
    EXPECT_NEAR(std::atan(std::hypot(x, y)) / kDegree,
                DegreesBetween(directional_light, moved), 1e-9);
  }
}

TEST(NearDirectionalLights, TexelsWithinSomeDegreesTheNearestMost) {
  const int H = 64, W = 128;
  // At the pole, across the map's edge, and two that meet.
  const std::vector<Eigen::Vector3d> directional_lights = {
      Unit(0.01, 1.0, 0.0), MapDirection(30.5, 0.1, H, W),
      MapDirection(40.5, 60.5, H, W), MapDirection(40.5, 62.5, H, W)};
  const std::vector<DirectionalLightTexel> near =
      NearDirectionalLights(directional_lights, H, W);
  std::vector<double> weights(H * W, 0.0);
  for (size_t i = 0; i < near.size(); ++i) {
    if (i > 0) {
      EXPECT_LT(near[i - 1].texel, near[i].texel);
    }
    weights[near[i].texel] = near[i].weight;
  }
  for (int r = 0; r < H; ++r) {
    for (int x = 0; x < W; ++x) {
      double nearest = 180.0;
      for (const Eigen::Vector3d& directional_light : directional_lights) {
        nearest = std::min(
            nearest, DegreesBetween(directional_light,
                                    MapDirection(r + 0.5, x + 0.5, H, W)));
      }
      const double weight = std::exp(-0.5 * nearest * nearest / 16.0);
      EXPECT_NEAR(weight < 0.05 ? 0.0 : weight, weights[r * W + x], 1e-9);
    }
  }
  EXPECT_TRUE(NearDirectionalLights({}, H, W).empty());
}

class DirectionalLightResponsesTest : public ::testing::Test {
 protected:
  DirectionalLightResponsesTest() {
    // Smooth, so that its table is close to it.
    const auto brdf = [](double h, double d, double p) -> Eigen::Array3d {
      return {0.4 + 0.3 * std::cos(2 * h) + 0.1 * d + 0.05 * std::cos(2 * p), 0,
              0};
    };
    grid_ = BrdfGrid::FromFunction(brdf, {48, 20, 12});
    const std::vector<ShadingPoint> points = SpherePoints(12);
    cells_ = BinByNormal(
        points, MakeObservations(std::vector<double>(3 * points.size(), 1.0)),
        {6, 3, 0.2});
  }
  BrdfGrid grid_;
  NormalBins cells_;
  // In front, grazing and behind.
  const std::vector<Eigen::Vector3d> directional_lights_ = {
      Unit(0.3, 0.5, 0.8), Unit(0.9, 0.1, -0.2), Unit(0.05, 0.0, -1.0)};
};

TEST_F(DirectionalLightResponsesTest, AreTheReflectedRadianceOfEachPoint) {
  const DirectionalLightResponses responses(cells_, grid_.shape, nullptr,
                                            directional_lights_);
  const RowMatrix found = responses.Of(grid_.Channel(0));
  ASSERT_EQ(cells_.num_bins(), found.rows());
  ASSERT_EQ(3, found.cols());
  double most = 0.0;
  for (int i = 0; i < cells_.num_bins(); ++i) {
    for (int k = 0; k < 3; ++k) {
      double sum = 0.0;
      for (int p = cells_.first[i]; p < cells_.first[i + 1]; ++p) {
        const Eigen::Vector3d n = cells_.points[p].normal.cast<double>();
        const Eigen::Vector3d wo = cells_.points[p].wo.cast<double>();
        const double cosine = n.dot(directional_lights_[k]);
        if (cosine <= 0.0) continue;
        const Eigen::Vector3d a = n.unitOrthogonal(), b = n.cross(a);
        const auto local = [&](const Eigen::Vector3d& v) {
          return Eigen::Vector3d(v.dot(a), v.dot(b), v.dot(n));
        };
        const HalfDiff x = ToHalfDiff(local(directional_lights_[k]), local(wo));
        sum += kDirectionalLightSolidAngle * cosine *
               grid_.Evaluate(x.theta_h, x.theta_d, x.phi_d)[0];
      }
      sum /= cells_.first[i + 1] - cells_.first[i];
      EXPECT_NEAR(sum, found(i, k), 1e-5 + 1e-4 * sum) << i << " " << k;
      most = std::max(most, sum);
    }
  }
  EXPECT_GT(most, 0.02);
  EXPECT_EQ(0.0, found.col(2).maxCoeff());  // seen by nothing
}

TEST_F(DirectionalLightResponsesTest, GradientIsTheTranspose) {
  const DirectionalLightResponses responses(cells_, grid_.shape, nullptr,
                                            directional_lights_);
  DirectionalLightResponses::Matrix adjoint(cells_.num_bins(), 3);
  for (Eigen::Index i = 0; i < adjoint.size(); ++i) {
    adjoint.data()[i] = static_cast<float>(std::sin(1.0 + 2.0 * i));
  }
  std::vector<float> gradient(grid_.shape.num_nodes(), 0.0f);
  responses.AddGradient(adjoint, gradient.data());
  double by_gradient = 0.0;
  for (size_t i = 0; i < gradient.size(); ++i) {
    by_gradient += static_cast<double>(gradient[i]) * grid_.Channel(0)[i];
  }
  const double expected =
      responses.Of(grid_.Channel(0)).cwiseProduct(adjoint.cast<double>()).sum();
  EXPECT_NEAR(expected, by_gradient, 1e-5 * std::abs(expected) + 1e-6);
  EXPECT_GT(std::abs(expected), 1e-3);
}

// A sun in one texel over dim light: with a directional light there the true
// reflectance is the more likely by far, and the map has the sun where it is.
TEST(DirectionalLights, ExplainASun) {
  const NeuralBrdfModel model = SmoothTinyModel(4);
  const std::vector<ShadingPoint> points = SpherePoints(24);
  const std::vector<double> truth = TinyLobes();
  const int height = 64, width = 128, row = 20, column = 50;
  Image map(width, height);
  std::fill(map.rgb.begin(), map.rgb.end(), 0.5f);
  const Eigen::Vector3d sun =
      MapDirection(row + 0.5, column + 0.5, height, width);
  for (int c = 0; c < 3; ++c) {
    map.rgb[3 * (row * width + column) + c] = 30000.0f;
  }
  const std::vector<double> radiance = RenderTinyLobes(model, points, map);

  MarginalResolution resolution;
  resolution.bins = {8, 3, 0.2};
  resolution.map_width = 16;
  resolution.map_height = 8;
  resolution.grid = TinyTransportOptions().grid;
  LightMode mode;
  const auto cost = [&](const MarginalReflectance& reflectance,
                        std::vector<double> x) {
    x.resize(reflectance.num_parameters(), 0.0);
    const MarginalLikelihood& likelihood = reflectance.likelihood();
    mode = {};
    const DataErrors errors = likelihood.FindErrors(
        reflectance.Matrices(x.data()), {}, 0.03, {}, 1e-6, &mode);
    return reflectance.Evaluate(x.data(), errors, {}, 1e-6, &mode, nullptr)
        .cost;
  };
  const MarginalReflectance without(FlowLobes::Factory(model, 2, 1), points,
                                    MakeObservations(radiance), LightProcess(),
                                    resolution, 1);
  const MarginalReflectance with(FlowLobes::Factory(model, 2, 1), points,
                                 MakeObservations(radiance), LightProcess(),
                                 resolution, 1, {sun});
  const double cost_without = cost(without, truth);
  EXPECT_LT(cost(with, truth), cost_without - 20.0);
  std::vector<double> x_with = truth;
  x_with.resize(with.num_parameters(), 0.0);
  const std::vector<double> log_radiance =
      with.LogRadiance(x_with.data(), mode);
  double y = 0.0, x = 0.0;
  MapPosition(sun, 8, 16, &y, &x);
  const auto brightest =
      std::max_element(log_radiance.begin(), log_radiance.begin() + 8 * 16) -
      log_radiance.begin();
  EXPECT_EQ(static_cast<int>(y) * 16 + static_cast<int>(x), brightest);
}

}  // namespace
}  // namespace ibrdf
