// What holds of every rendered image.
#include <gtest/gtest.h>
#include <rapidcheck/gtest.h>

#include <Eigen/Geometry>
#include <cmath>

#include "ibrdf/base/pi.h"
#include "ibrdf/brdf/cook_torrance.h"
#include "ibrdf/transport/transport.h"
#include "tests/properties/generators.h"

namespace ibrdf {
namespace {

constexpr int kHeight = 8, kWidth = 16;

TransportOptions Options() {
  TransportOptions options;
  options.quadrature.near_rings = 6;
  options.quadrature.near_ring_samples = 16;
  options.grid = {12, 8, 6};
  options.num_threads = 1;
  return options;
}

// A point seen by a viewer anywhere above its horizon.
ShadingPoint AnyPoint() {
  ShadingPoint p{};
  const Eigen::Vector3d local = AnyDirectionAbove(1e-3);
  const Eigen::Quaterniond turn =
      Eigen::AngleAxisd(*Between(-kPi, kPi), Eigen::Vector3d::UnitY()) *
      Eigen::AngleAxisd(*Between(-kPi, kPi), Eigen::Vector3d::UnitX());
  p.normal = (turn * Eigen::Vector3d::UnitZ()).cast<float>();
  p.wo = (turn * local).cast<float>();
  p.coverage = 1.0f;
  return p;
}

BrdfGrid AnyGrid() {
  CookTorrance brdf;
  brdf.diffuse.setConstant(*Unit());
  brdf.specular.setConstant(*Unit());
  brdf.roughness.setConstant(*Magnitude(0.01, 1.0));
  brdf.f0.setConstant(*Unit());
  return BrdfGrid::FromFunction(brdf.Function(), Options().grid);
}

std::vector<double> Render(const std::vector<ShadingPoint>& points,
                           const BrdfGrid& grid, const Image& map) {
  const Transport transport(points, kHeight, kWidth, Options());
  std::vector<double> L_o(3 * points.size());
  transport.Render(grid, map.rgb.data(), L_o.data());
  return L_o;
}

RC_GTEST_PROP(RenderProperty, IsLinearInLight, ()) {
  const std::vector<ShadingPoint> points = {AnyPoint()};
  const BrdfGrid grid = AnyGrid();
  const Image a = AnyMap(kHeight, kWidth), b = AnyMap(kHeight, kWidth);
  const double s = *Magnitude(1e-6, 1e6);
  Image sum = a;
  for (size_t i = 0; i < sum.rgb.size(); ++i) {
    sum.rgb[i] = static_cast<float>(a.rgb[i] + s * b.rgb[i]);
  }
  const std::vector<double> of_a = Render(points, grid, a),
                            of_b = Render(points, grid, b),
                            of_sum = Render(points, grid, sum);
  for (int c = 0; c < 3; ++c) {
    const double expected = of_a[c] + s * of_b[c];
    RC_ASSERT(std::isfinite(of_sum[c]) && of_sum[c] >= 0.0);
    RC_ASSERT(std::abs(of_sum[c] - expected) <= 1e-5 * expected);
  }
}

RC_GTEST_PROP(RenderProperty, PowersOfTwoOfLightChangeNoDigit, ()) {
  const std::vector<ShadingPoint> points = {AnyPoint()};
  const BrdfGrid grid = AnyGrid();
  const Image map = AnyMap(kHeight, kWidth);
  const int exponent = *rc::gen::inRange(-30, 31);
  Image scaled = map;
  for (float& v : scaled.rgb) v = std::ldexp(v, exponent);
  const std::vector<double> L_o = Render(points, grid, map),
                            F = Render(points, grid, scaled);
  for (int c = 0; c < 3; ++c) RC_ASSERT(F[c] == std::ldexp(L_o[c], exponent));
}

// Lambertian of albedo 1 under light of 1.
RC_GTEST_PROP(RenderProperty, WhiteFurnaceIsWhite, ()) {
  const std::vector<ShadingPoint> points = {AnyPoint()};
  Image map(kWidth, kHeight);
  std::fill(map.rgb.begin(), map.rgb.end(), 1.0f);
  BrdfGrid grid(Options().grid);
  std::fill(grid.values.begin(), grid.values.end(),
            static_cast<float>(1.0 / kPi));
  for (const double L_o : Render(points, grid, map)) {
    RC_ASSERT(std::abs(L_o - 1.0) <= 1e-4);
  }
}

// Turning object, viewer and light together by whole texels about the map's
// axis.
RC_GTEST_PROP(RenderProperty, TurningEverythingChangesNothing, ()) {
  ShadingPoint p = AnyPoint();
  const BrdfGrid grid = AnyGrid();
  const Image map = AnyMap(kHeight, kWidth);
  const std::vector<double> L_o = Render({p}, grid, map);
  const int texels = *rc::gen::inRange(0, kWidth);
  Image turned = map;
  for (int y = 0; y < kHeight; ++y) {
    for (int x = 0; x < kWidth; ++x) {
      std::copy_n(map.At(x, y), 3, turned.At((x + texels) % kWidth, y));
    }
  }
  // phi counts from +z towards +x.
  const Eigen::AngleAxisd turn(2 * kPi * texels / kWidth,
                               Eigen::Vector3d::UnitY());
  p.normal = (turn * p.normal.cast<double>()).cast<float>();
  p.wo = (turn * p.wo.cast<double>()).cast<float>();
  const std::vector<double> F = Render({p}, grid, turned);
  // Samples lie in a frame of normal and viewer, which turns along; a viewer
  // along the normal has no such frame, and a sharp lobe beside a bright texel
  // multiplies the normals' rounding.
  if (p.normal.dot(p.wo) > 1 - 1e-6f) return;
  const double bright = *std::max_element(map.rgb.begin(), map.rgb.end());
  for (int c = 0; c < 3; ++c) {
    RC_ASSERT(std::abs(L_o[c] - F[c]) <=
              1e-4 * (L_o[c] + F[c]) + 1e-5 * bright);
  }
}

// No more light leaves than arrives, if the reflectance is a plain albedo.
RC_GTEST_PROP(RenderProperty, MatteIsBetweenTheDarkestAndBrightestLight, ()) {
  const Image map = AnyMap(kHeight, kWidth);
  const double albedo = *Unit();
  BrdfGrid grid(Options().grid);
  std::fill(grid.values.begin(), grid.values.end(),
            static_cast<float>(albedo / kPi));
  const std::vector<double> L_o = Render({AnyPoint()}, grid, map);
  for (int c = 0; c < 3; ++c) {
    float low = map.rgb[c], high = low;
    for (size_t i = c; i < map.rgb.size(); i += 3) {
      low = std::min(low, map.rgb[i]);
      high = std::max(high, map.rgb[i]);
    }
    RC_ASSERT(L_o[c] >= albedo * low * (1 - 1e-4));
    RC_ASSERT(L_o[c] <= albedo * high * (1 + 1e-4));
  }
}

RC_GTEST_PROP(RenderProperty, OperatorsAndTransposesAgree, ()) {
  std::vector<ShadingPoint> points;
  for (int i = 0; i < 3; ++i) points.push_back(AnyPoint());
  const BrdfGrid grid = AnyGrid();
  const Image map = AnyMap(kHeight, kWidth);
  const Transport transport(points, kHeight, kWidth, Options());
  const LightOperator light = transport.ByLight(grid);
  std::vector<double> L_o(9), applied(9), adjoint(9);
  transport.Render(grid, map.rgb.data(), L_o.data());
  light.Apply(map.rgb.data(), applied.data());
  for (double& v : adjoint) v = *Between(0.0, 1.0);
  std::vector<float> by_map(map.rgb.size()), by_grid(grid.values.size());
  light.ApplyTranspose(adjoint.data(), by_map.data());
  transport.GridGradient(grid, map.rgb.data(), adjoint.data(), by_grid.data());
  double left = 0.0, by_light = 0.0, by_brdf = 0.0;
  for (int i = 0; i < 9; ++i) {
    RC_ASSERT(std::abs(L_o[i] - applied[i]) <= 1e-5 * L_o[i]);
    left += adjoint[i] * L_o[i];
  }
  for (size_t i = 0; i < by_map.size(); ++i) {
    by_light += static_cast<double>(by_map[i]) * map.rgb[i];
  }
  for (size_t i = 0; i < by_grid.size(); ++i) {
    by_brdf += static_cast<double>(by_grid[i]) * grid.values[i];
  }
  RC_ASSERT(std::abs(by_light - left) <= 1e-5 * left);
  RC_ASSERT(std::abs(by_brdf - left) <= 1e-5 * left);
}

}  // namespace
}  // namespace ibrdf
