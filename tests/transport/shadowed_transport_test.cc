// Shadows in the renderer, its derivatives and the reference renderers.
#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <memory>
#include <random>

#include "ibrdf/brdf/cook_torrance.h"
#include "ibrdf/brdf/sample_merl.h"
#include "ibrdf/render/reference_batch.h"
#include "ibrdf/render/reference_renderer.h"
#include "ibrdf/transport/transport.h"
#include "tests/support/render_testing.h"
#include "tests/support/shadow_testing.h"
#include "tests/transport/float_sums.h"

namespace ibrdf {
namespace {
using namespace testing;  // NOLINT

const Scene& Torus() {
  static const Scene scene = Scene::FromMesh(UnitTorusMesh(64, 32)).value();
  return scene;
}

std::vector<ShadingPoint> TorusPoints(int size) {
  return FindShadingPoints(Torus(), TorusCamera(), size, size, Mask(), 1)
      .value();
}

TransportOptions Shadowed(const Scene& scene,
                          const std::vector<ShadingPoint>& points,
                          int threads = 0) {
  TransportOptions options;
  options.num_threads = threads;
  VisibilityOptions rays;
  rays.num_threads = threads;
  options.visibility = std::make_shared<Visibility>(scene, points, rays);
  return options;
}

double MeanLogError(const std::vector<double>& a,
                    const std::vector<double>& b) {
  double sum = 0.0;
  for (size_t i = 0; i < a.size(); ++i) {
    sum += std::abs(std::log(a[i] / b[i])) / a.size();
  }
  return sum;
}

TEST(ShadowedTransport, TorusMatchesBruteForceFromMatteToGlossy) {
  const std::vector<ShadingPoint> points = TorusPoints(9);
  const Image map = SmoothMap(64, 128);
  const TransportOptions options = Shadowed(Torus(), points);
  ReferenceOptions reference;
  reference.shadows =
      std::make_shared<VisibilityGrid>(Torus(), kReferenceShadowRows);
  for (const BrdfFunction& brdf :
       {Lambertian(0.7), Glossy(0.1, 0.5, 12), Glossy(0.05, 0.6, 3)}) {
    std::vector<double> brute, L_o(3 * points.size()), R(L_o.size()),
        bare(L_o.size());
    for (const ShadingPoint& p : points) {
      const Eigen::Array3d e =
          BruteForceShadowed(Torus(), p, brdf, map, 0, 90, 180, 3);
      for (int c = 0; c < 3; ++c) brute.push_back(e[c]);
    }
    const BrdfGrid grid = BrdfGrid::FromFunction(brdf, options.grid);
    Transport(points, 64, 128, options)
        .Render(grid, map.rgb.data(), L_o.data());
    Transport(points, 64, 128, {}).Render(grid, map.rgb.data(), bare.data());
    ReferenceRenderer(map, reference).Render(points, brdf, R.data());
    // What the transport differs by without shadows, plus edges of the grid.
    EXPECT_LT(MeanLogError(L_o, brute), 0.015);
    EXPECT_LT(MeanLogError(R, brute), 0.005);
    // The test can tell: shadows are worth several times that.
    EXPECT_GT(MeanLogError(bare, brute), 0.04);
  }
}

// Hard light of one texel: a wall's shadow ends where the texel sets, not
// where its block of the far rule does.
TEST(ShadowedTransport, SunBehindAWallIsDarkAndBesideItIsNot) {
  TriangleMesh mesh;
  AddQuad({{0, -500, 0}, {0, 500, 0}, {0, 500, 1}, {0, -500, 1}}, &mesh);
  const Scene scene = Scene::FromMesh(mesh).value();
  const int height = 128, width = 256;  // blocks of 4x4 texels
  int row = 0, column = 0;
  Image map = ConstantMap(height, width, 0.0f);
  for (int r = 0; r < height; ++r) {
    for (int c = 0; c < width; ++c) {
      const Eigen::Vector3d d = MapDirection(r + 0.5, c + 0.5, height, width);
      const Eigen::Vector3d best =
          MapDirection(row + 0.5, column + 0.5, height, width);
      const Eigen::Vector3d wanted(-0.8, 0.1, 0.6);
      if (d.dot(wanted) > best.dot(wanted)) {
        row = r;
        column = c;
      }
    }
  }
  std::fill_n(map.At(column, row), 3, 1e4f);
  const Eigen::Vector3d sun =
      MapDirection(row + 0.5, column + 0.5, height, width);
  const double edge = -sun.x() / sun.z();  // of the shadow, wall at x = 0
  std::vector<ShadingPoint> points;
  for (const double x : {0.5, edge - 0.06, edge + 0.06, 4.0}) {
    ShadingPoint p = PointAt(0, 0);
    p.position = {x, 0, 0};
    p.index = static_cast<int>(points.size());
    points.push_back(p);
  }
  const TransportOptions options = Shadowed(scene, points);
  const BrdfGrid white = BrdfGrid::FromFunction(Lambertian(1), options.grid);
  std::vector<double> L_o(12), R(12), bare(12), bare_reference(12);
  Transport(points, height, width, options)
      .Render(white, map.rgb.data(), L_o.data());
  Transport(points, height, width, {})
      .Render(white, map.rgb.data(), bare.data());
  ReferenceOptions reference;
  reference.shadows =
      std::make_shared<VisibilityGrid>(scene, kReferenceShadowRows);
  ReferenceRenderer(map, reference).Render(points, Lambertian(1), R.data());
  ReferenceRenderer(map, {}).Render(points, Lambertian(1),
                                    bare_reference.data());
  for (const auto& [e, lit] :
       {std::pair{L_o, bare}, std::pair{R, bare_reference}}) {
    EXPECT_EQ(0.0, e[0]);
    EXPECT_EQ(0.0, e[3]);
    EXPECT_NEAR(lit[6], e[6], kFloatSums * lit[6]);
    EXPECT_NEAR(lit[9], e[9], kFloatSums * lit[9]);
  }
}

TEST(ShadowedTransport, ThePointInTheDarkIsBlackAndItsDerivativesAreZero) {
  TriangleMesh mesh;
  for (const double z : {-1.0, 1.0}) {
    AddQuad({{-1e3, -1e3, z}, {1e3, -1e3, z}, {1e3, 1e3, z}, {-1e3, 1e3, z}},
            &mesh);
  }
  const Scene scene = Scene::FromMesh(mesh).value();
  ShadingPoint p = PointAt(0, 0);
  p.position = {0, 0, -0.999};
  const TransportOptions options = Shadowed(scene, {p});
  const Transport transport({p}, 16, 32, options);
  const BrdfGrid white = BrdfGrid::FromFunction(Lambertian(1), options.grid);
  const Image map = ConstantMap(16, 32, 1.0f);
  double L_o[3];
  transport.Render(white, map.rgb.data(), L_o);
  // A slit of a thousandth of a radian all around.
  EXPECT_LT(L_o[0], 1e-4);
}

class ShadowedDerivatives : public ::testing::Test {
 protected:
  std::vector<double> Render(const BrdfGrid& grid, const Image& map) const {
    std::vector<double> L_o(3 * points_.size());
    transport_.Render(grid, map.rgb.data(), L_o.data());
    return L_o;
  }
  std::vector<double> Adjoint() {
    std::vector<double> a;
    while (a.size() < 3 * points_.size()) a.push_back(gauss_(rng_));
    return a;
  }

  const std::vector<ShadingPoint> points_ = TorusPoints(10);
  // Blocks of 2x2 texels: some are split by shadows.
  const Transport transport_{points_, 64, 128, Shadowed(Torus(), points_)};
  const BrdfGrid glossy_ =
      BrdfGrid::FromFunction(Glossy(0.1, 0.5, 3), BrdfGridShape());
  std::mt19937 rng_{8};
  std::normal_distribution<double> gauss_;
};

TEST_F(ShadowedDerivatives, LightGradientMatchesFiniteDifferences) {
  const LightOperator op = transport_.ByLight(glossy_);
  const std::vector<double> adjoint = Adjoint();
  std::vector<float> gradient(size_t{3} * 64 * 128);
  op.ApplyTranspose(adjoint.data(), gradient.data());
  Image map = SmoothMap(64, 128);
  const std::vector<double> L_o = Render(glossy_, map);
  for (const auto& [r, c] : {std::pair{0, 0},
                             {0, 127},
                             {12, 64},
                             {20, 0},
                             {30, 77},
                             {35, 127},
                             {5, 40}}) {
    for (int k = 0; k < 3; ++k) {
      float& L = map.At(c, r)[k];
      const float before = L;
      L = before + 100.0f;
      const double derivative =
          (Dot(adjoint, Render(glossy_, map)) - Dot(adjoint, L_o)) / 100.0;
      L = before;
      double size = 0.0;
      for (const double a : adjoint) size += std::abs(a);
      // Linear: what is left is rounding, of sums over all points.
      EXPECT_NEAR(derivative, gradient[3 * (r * 128 + c) + k],
                  1e-3 * std::abs(derivative) + 1e-7 * size);
    }
  }
}

TEST_F(ShadowedDerivatives, OperatorIsTheRenderAndItsTransposeItsAdjoint) {
  const LightOperator op = transport_.ByLight(glossy_);
  const Image map = RandomMap(64, 128, 3);
  const std::vector<double> L_o = Render(glossy_, map), adjoint = Adjoint();
  std::vector<double> applied(L_o.size());
  op.Apply(map.rgb.data(), applied.data());
  for (size_t i = 0; i < L_o.size(); ++i) {
    EXPECT_NEAR(L_o[i], applied[i], kFloatSums * L_o[i]);
  }
  std::vector<float> gradient(map.rgb.size());
  op.ApplyTranspose(adjoint.data(), gradient.data());
  double right = 0.0, size = 0.0;
  for (size_t i = 0; i < gradient.size(); ++i) {
    right += static_cast<double>(gradient[i]) * map.rgb[i];
    size += std::abs(static_cast<double>(gradient[i]) * map.rgb[i]);
  }
  EXPECT_NEAR(Dot(adjoint, applied), right, 1e-6 * size);
}

TEST_F(ShadowedDerivatives, GridGradientMatchesFiniteDifferences) {
  const Image map = RandomMap(64, 128, 4);
  const std::vector<double> adjoint = Adjoint();
  std::vector<float> gradient(glossy_.values.size());
  transport_.GridGradient(glossy_, map.rgb.data(), adjoint.data(),
                          gradient.data());
  // The largest entries, one per channel and some by the way.
  std::vector<size_t> nodes(gradient.size());
  for (size_t i = 0; i < nodes.size(); ++i) nodes[i] = i;
  std::partial_sort(nodes.begin(), nodes.begin() + 12, nodes.end(),
                    [&](size_t a, size_t b) {
                      return std::abs(gradient[a]) > std::abs(gradient[b]);
                    });
  const double at = Dot(adjoint, Render(glossy_, map));
  for (int k = 0; k < 12; ++k) {
    BrdfGrid moved = glossy_;
    moved.values[nodes[k]] += 10.0f;
    const double derivative =
        (Dot(adjoint, Render(moved, map)) - at) /
        (moved.values[nodes[k]] - glossy_.values[nodes[k]]);
    EXPECT_NEAR(derivative, gradient[nodes[k]], 1e-4 * std::abs(derivative));
  }
}

TEST_F(ShadowedDerivatives, LobesAddUpToTheRender) {
  const Image map = RandomMap(64, 128, 5);
  const float* fields[] = {glossy_.Channel(0), glossy_.Channel(1),
                           glossy_.Channel(2)};
  std::vector<float> lobes(points_.size() * 9);
  transport_.RenderLobes(fields, 3, map.rgb.data(), lobes.data());
  const std::vector<double> L_o = Render(glossy_, map);
  for (size_t i = 0; i < points_.size(); ++i) {
    for (int c = 0; c < 3; ++c) {
      EXPECT_NEAR(L_o[3 * i + c], lobes[(3 * i + c) * 3 + c],
                  kFloatSums * L_o[3 * i + c]);
    }
  }
}

TEST_F(ShadowedDerivatives, LightMatrixIsTheRenderAndItsGradientTheTranspose) {
  const Transport small(points_, 12, 24, Shadowed(Torus(), points_));
  const size_t texels = 12 * 24;
  std::vector<float> matrix(points_.size() * texels), adjoint(matrix.size());
  small.LightMatrix(glossy_.Channel(1), matrix.data());
  const Image map = RandomMap(12, 24, 6);
  std::vector<double> L_o(3 * points_.size());
  small.Render(glossy_, map.rgb.data(), L_o.data());
  for (size_t i = 0; i < points_.size(); ++i) {
    double sum = 0.0;
    for (size_t t = 0; t < texels; ++t) {
      sum += static_cast<double>(matrix[i * texels + t]) * map.rgb[3 * t + 1];
    }
    EXPECT_NEAR(L_o[3 * i + 1], sum, 1e-4 * L_o[3 * i + 1]);
  }
  for (float& v : adjoint) v = static_cast<float>(gauss_(rng_));
  std::vector<float> gradient(BrdfGridShape().num_nodes());
  small.LightMatrixGradient(adjoint.data(), gradient.data());
  double left = 0.0, right = 0.0, size = 0.0;
  for (size_t i = 0; i < matrix.size(); ++i) {
    left += static_cast<double>(matrix[i]) * adjoint[i];
    size += std::abs(static_cast<double>(matrix[i]) * adjoint[i]);
  }
  for (size_t i = 0; i < gradient.size(); ++i) {
    right += static_cast<double>(glossy_.Channel(1)[i]) * gradient[i];
  }
  EXPECT_NEAR(left, right, 1e-5 * size);
}

TEST_F(ShadowedDerivatives, SameBitsForAnyNumberOfThreads) {
  const Image map = RandomMap(64, 128, 6);
  const auto compute = [&](int threads) {
    const Transport t(points_, 64, 128, Shadowed(Torus(), points_, threads));
    std::vector<double> L_o(3 * points_.size());
    t.Render(glossy_, map.rgb.data(), L_o.data());
    std::vector<float> light(map.rgb.size()), grid(glossy_.values.size());
    t.ByLight(glossy_).ApplyTranspose(L_o.data(), light.data());
    t.GridGradient(glossy_, map.rgb.data(), L_o.data(), grid.data());
    ReferenceOptions options;
    options.num_threads = threads;
    options.shadows = std::make_shared<VisibilityGrid>(Torus(), 64);
    std::vector<double> R(L_o.size());
    ReferenceRenderer(map, options)
        .Render(points_, Glossy(0.1, 0.5, 3), R.data());
    return std::make_tuple(L_o, light, grid, R);
  };
  const auto one = compute(1);
  EXPECT_EQ(one, compute(2));
  EXPECT_EQ(one, compute(3));
}

TEST(ShadowedReference, BatchIsTheSingleRenderer) {
  const std::vector<ShadingPoint> points = TorusPoints(7);
  const std::vector<MerlTable> tables = {SampleMerl(Lambertian(0.6)),
                                         SampleMerl(Glossy(0.1, 0.5, 8))};
  MerlTableStack stack(2);
  for (int m = 0; m < 2; ++m) stack.Set(m, tables[m]);
  Image sunny = SmoothMap(32, 64);
  std::fill_n(sunny.At(30, 8), 3, 1e5f);
  const std::vector<Image> maps = {sunny, RandomMap(32, 64, 3)};
  ReferenceOptions options;
  options.near_rings = 24;
  options.near_ring_samples = 64;
  options.split_bright = false;
  for (const int far_width : {64, 32}) {
    options.far_width = far_width;
    options.shadows = std::make_shared<VisibilityGrid>(Torus(), 128);
    std::vector<double> L_o(2 * 2 * 3 * points.size());
    ReferenceBatch(stack, {&maps[0], &maps[1]}, options)
        .Render(points, L_o.data());
    size_t next = 0;
    for (const MerlTable& table : tables) {
      for (const Image& map : maps) {
        std::vector<double> single(3 * points.size());
        ReferenceRenderer(map, options).Render(points, table, single.data());
        const std::vector<double> batch(L_o.begin() + next,
                                        L_o.begin() + next + single.size());
        next += single.size();
        // Every texel: float sums. Blocks: the two share out light differently.
        EXPECT_LT(MeanLogError(single, batch), far_width == 64 ? 2e-5 : 0.05);
      }
    }
  }
}

}  // namespace
}  // namespace ibrdf
