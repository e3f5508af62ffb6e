// Light from directions of its own (TransportOptions::bright) in the transport.
#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <memory>
#include <random>

#include "ibrdf/transport/transport.h"
#include "ibrdf/visibility/radiosity_patches.h"
#include "tests/support/render_testing.h"
#include "tests/support/shadow_testing.h"

namespace ibrdf {
namespace {
using namespace testing;  // NOLINT

constexpr int kHeight = 128, kWidth = 256;
constexpr int kSunRow = 30, kSunColumn = 30;

Image MapOfOneSun(int row = kSunRow, int column = kSunColumn) {
  Image map = SmoothMap(kHeight, kWidth);
  for (int c = 0; c < 3; ++c) map.At(column, row)[c] = 1e4f;
  return map;
}

// From the mirrored view of the sun to where no peak of a lobe is.
std::vector<ShadingPoint> SunnyPoints() {
  return PointsAroundTheHighlight(
      MapDirection(kSunRow + 0.5, kSunColumn + 0.5, kHeight, kWidth),
      {0, 1, 2, 5, 8, 11, 20, 40});
}

TransportOptions WithBright(const BrightTexels& split,
                            TransportOptions options = {}) {
  options.bright = SampleBrightTexels(split.texels, kHeight, kWidth, 4);
  return options;
}

std::vector<double> Render(const Transport& transport, const BrdfGrid& grid,
                           const Image& map) {
  std::vector<double> L_o(3 * static_cast<size_t>(transport.num_points()));
  transport.Render(grid, map.rgb.data(), L_o.data());
  return L_o;
}

TEST(BrightTransport, ShowsASunThatRingsMiss) {
  const Image map = MapOfOneSun();
  const BrightTexels split = SplitBrightTexels(map);
  ASSERT_EQ(1u, split.texels.size());
  const std::vector<ShadingPoint> points = SunnyPoints();
  const Transport by_rings(points, kHeight, kWidth, {});
  const Transport by_samples(points, kHeight, kWidth, WithBright(split));
  for (const BrdfFunction& brdf :
       {Lambertian(0.7), Glossy(0.1, 0.5, 10), Glossy(0.02, 0.5, 3)}) {
    const BrdfGrid grid = BrdfGrid::FromFunction(brdf, {});
    const BrdfFunction tabulated = [&grid](double h, double d, double p) {
      return grid.Evaluate(h, d, p);
    };
    const std::vector<double> L_o = Render(by_samples, grid, split.rest);
    const std::vector<double> rings = Render(by_rings, grid, map);
    double most = 0.0, most_rings = 0.0;
    for (size_t i = 0; i < points.size(); ++i) {
      const Eigen::Array3d slow =
          BruteForceRadiance(points[i], tabulated, map, 500, 1000);
      for (int c = 0; c < 3; ++c) {
        most = std::max(most, std::abs(L_o[3 * i + c] / slow[c] - 1.0));
        most_rings =
            std::max(most_rings, std::abs(rings[3 * i + c] / slow[c] - 1.0));
      }
    }
    EXPECT_LT(most, 0.02);
    EXPECT_GT(most_rings, 3.0 * most);
  }
}

// The same light, given in full to both.
TEST(BrightTransport, ProductsAgree) {
  const Image map = MapOfOneSun();
  const BrightTexels split = SplitBrightTexels(map);
  const std::vector<ShadingPoint> points = SunnyPoints();
  const Transport transport(points, kHeight, kWidth, WithBright(split));
  const BrdfGrid grid = BrdfGrid::FromFunction(Glossy(0.1, 0.5, 4), {});
  const std::vector<double> L_o = Render(transport, grid, split.rest);

  const float* fields[] = {grid.Channel(0), grid.Channel(1), grid.Channel(2)};
  std::vector<float> lobes(9 * points.size()), stored(lobes.size());
  transport.RenderLobes(fields, 3, split.rest.rgb.data(), lobes.data());
  transport.ByReflectance(split.rest.rgb.data())
      .Apply(fields, 3, stored.data());
  EXPECT_EQ(lobes, stored);
  for (size_t i = 0; i < L_o.size(); ++i) {
    EXPECT_NEAR(L_o[i], lobes[i / 3 * 9 + i % 3 * 4], 2e-5 * L_o[i]) << i;
  }

  // L_o is linear in the grid.
  std::mt19937 rng(4);
  std::normal_distribution<double> gauss;
  std::vector<double> adjoint(L_o.size());
  for (double& a : adjoint) a = gauss(rng);
  std::vector<float> gradient(grid.values.size());
  transport.GridGradient(grid, split.rest.rgb.data(), adjoint.data(),
                         gradient.data());
  double by_points = 0.0, by_nodes = 0.0, size = 0.0;
  for (size_t i = 0; i < L_o.size(); ++i) {
    by_points += adjoint[i] * L_o[i];
    size += std::abs(adjoint[i] * L_o[i]);
  }
  for (size_t i = 0; i < gradient.size(); ++i) {
    by_nodes += static_cast<double>(gradient[i]) * grid.values[i];
  }
  EXPECT_NEAR(by_points, by_nodes, 1e-5 * size);

  // The light operator is what the map alone adds, and an offset.
  const LightOperator by_light = transport.ByLight(grid);
  std::vector<double> by_map(L_o.size()), with_bright(L_o.size());
  by_light.ApplyLinear(split.rest.rgb.data(), by_map.data());
  by_light.Apply(split.rest.rgb.data(), with_bright.data());
  const std::vector<double> rest =
      Render(Transport(points, kHeight, kWidth, {}), grid, split.rest);
  for (size_t i = 0; i < rest.size(); ++i) {
    EXPECT_NEAR(rest[i], by_map[i], 2e-5 * rest[i]) << i;
    EXPECT_NEAR(L_o[i], with_bright[i], 2e-5 * L_o[i]) << i;
  }
}

TEST(BrightTransport, ADenseMatrixRefusesIt) {
  GTEST_FLAG_SET(death_test_style, "threadsafe");
  TransportOptions options;
  options.grid = {12, 8, 6};
  options.bright = {{Eigen::Vector3d::UnitY(), Eigen::Array3d::Ones()}};
  const Transport transport({PointAt(0.3, 0.2)}, 8, 16, options);
  std::vector<float> field(options.grid.num_nodes(), 1.0f), matrix(8 * 16);
  EXPECT_DEATH(transport.LightMatrix(field.data(), matrix.data()),
               "no bright light");
}

class ShadowedSun : public ::testing::Test {
 protected:
  ShadowedSun() : scene_(Scene::FromMesh(UnitTorusMesh(64, 32)).value()) {
    points_ = FindShadingPoints(scene_, TorusCamera(), 9, 9, Mask(), 1).value();
    TransportOptions options;
    auto visibility =
        std::make_shared<Visibility>(scene_, points_, VisibilityOptions());
    options.visibility = visibility;
    RadiosityOptions how;
    how.bounces = 2;
    options.patches =
        std::make_shared<RadiosityPatches>(scene_, points_, visibility, how);
    options_ = WithBright(split_, options);
  }

  const BrightTexels split_ = SplitBrightTexels(MapOfOneSun(60, 64));  // low
  const Image black_{kWidth, kHeight};
  const Scene scene_;
  std::vector<ShadingPoint> points_;
  TransportOptions options_;
};

// Under the bright light alone: dark where every sample is hidden or behind the
// point, but for what comes back from elsewhere.
TEST_F(ShadowedSun, IsSeenWhereNothingHidesIt) {
  const BrdfGrid matte = BrdfGrid::FromFunction(Lambertian(0.6), {});
  TransportOptions no_bounce = options_;
  no_bounce.patches = nullptr;
  const std::vector<double> L_o =
      Render(Transport(points_, kHeight, kWidth, no_bounce), matte, black_);
  const std::vector<double> lit =
      Render(Transport(points_, kHeight, kWidth, options_), matte, black_);
  const VisibilityGrid& grid = options_.visibility->grid();
  int hidden = 0, faced = 0;
  for (size_t i = 0; i < points_.size(); ++i) {
    const Eigen::Vector3d n = points_[i].normal.cast<double>().normalized();
    double slow = 0.0;
    faced += n.dot(options_.bright[0].direction) > 0.05;
    for (const BrightSample& s : options_.bright) {
      const double cosine = n.dot(s.direction);
      if (cosine <= 0.0) continue;
      const uint64_t* const hidden_bits =
          options_.visibility->Hidden(points_[i]);
      slow += cosine * s.power[0] * 0.6 / kPi *
              (hidden_bits != nullptr
                   ? grid.VisibleAlong(hidden_bits, n, s.direction)
                   : 1.0);
    }
    EXPECT_NEAR(slow, L_o[3 * i], 1e-4 * slow) << i;
    EXPECT_GE(lit[3 * i], L_o[3 * i]) << i;
    hidden += n.dot(options_.bright[0].direction) > 0.05 && slow == 0.0;
  }
  EXPECT_GT(hidden, 1);
  EXPECT_GT(faced, hidden + 3);
  double direct = 0.0, all = 0.0;
  for (size_t i = 0; i < L_o.size(); ++i) direct += L_o[i], all += lit[i];
  EXPECT_GT(all, 1.004 * direct);
}

// The operator that a solver of the map gets has all light that Render has, and
// its derivatives are those of the map alone.
TEST_F(ShadowedSun, TheLightOperatorHasItAsAnOffset) {
  const Transport transport(points_, kHeight, kWidth, options_);
  const BrdfGrid grid = BrdfGrid::FromFunction(Glossy(0.3, 0.4, 5), {});
  const std::vector<double> L_o = Render(transport, grid, split_.rest);
  const LightOperator op = transport.ByLight(grid);
  std::vector<double> by_light(L_o.size());
  op.Apply(split_.rest.rgb.data(), by_light.data());
  ASSERT_EQ(L_o.size(), op.offset().size());
  double offset = 0.0, all = 0.0;
  for (size_t i = 0; i < L_o.size(); ++i) {
    EXPECT_NEAR(L_o[i], by_light[i], 2e-5 * L_o[i]) << i;
    offset += op.offset()[i];
    all += L_o[i];
  }
  EXPECT_GT(offset, 0.1 * all);
  // The offset is the radiance under a black map.
  const std::vector<double> dark = Render(transport, grid, black_);
  for (size_t i = 0; i < dark.size(); ++i) {
    EXPECT_NEAR(dark[i], op.offset()[i], 2e-5 * dark[i] + 1e-12) << i;
  }
  // A step of the map moves Apply by ApplyLinear of the step.
  Image moved = split_.rest;
  for (float& v : moved.rgb) v *= 3.0f;
  std::vector<double> by_moved(L_o.size()), step(L_o.size());
  op.Apply(moved.rgb.data(), by_moved.data());
  Image difference = split_.rest;
  for (float& v : difference.rgb) v *= 2.0f;
  op.ApplyLinear(difference.rgb.data(), step.data());
  for (size_t i = 0; i < L_o.size(); ++i) {
    EXPECT_NEAR(by_moved[i] - by_light[i], step[i], 1e-5 * by_moved[i]) << i;
  }
}

// Through two bounces radiance is a cubic of the grid's values, to which five
// differences are exact.
TEST_F(ShadowedSun, GridGradientMatchesDifferences) {
  const Transport transport(points_, kHeight, kWidth, options_);
  const BrdfGrid at = BrdfGrid::FromFunction(Glossy(0.3, 0.4, 5), {});
  std::mt19937 rng(8);
  std::normal_distribution<double> gauss;
  std::uniform_real_distribution<float> uniform(-1.0f, 1.0f);
  std::vector<double> adjoint(3 * points_.size());
  for (double& a : adjoint) a = gauss(rng);
  std::vector<float> gradient(at.values.size());
  transport.GridGradient(at, split_.rest.rgb.data(), adjoint.data(),
                         gradient.data());
  BrdfGrid direction = at;
  for (float& v : direction.values) v *= uniform(rng);
  double slope = 0.0;
  for (size_t i = 0; i < gradient.size(); ++i) {
    slope += static_cast<double>(gradient[i]) * direction.values[i];
  }
  double size = 0.0;
  const auto value = [&](float step) {
    BrdfGrid moved = at;
    for (size_t i = 0; i < moved.values.size(); ++i) {
      moved.values[i] += step * direction.values[i];
    }
    const std::vector<double> L_o = Render(transport, moved, split_.rest);
    double sum = 0.0;
    size = 0.0;
    for (size_t i = 0; i < L_o.size(); ++i) {
      sum += adjoint[i] * L_o[i];
      size += std::abs(adjoint[i] * L_o[i]);
    }
    return sum;
  };
  const double numeric =
      (8 * (value(0.25f) - value(-0.25f)) - (value(0.5f) - value(-0.5f))) /
      (12 * 0.25);
  EXPECT_NEAR(numeric, slope, 1e-5 * size);
}

}  // namespace
}  // namespace ibrdf
