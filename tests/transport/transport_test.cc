#include "ibrdf/transport/transport.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <random>

#include "ibrdf/render/reference_renderer.h"
#include "tests/support/render_testing.h"
#include "tests/transport/float_sums.h"

namespace ibrdf {
namespace {
using namespace testing;  // NOLINT

class TransportTest : public ::testing::Test {
 protected:
  TransportTest() : transport_(points_, 64, 128, {}) {}

  std::vector<double> Render(const BrdfGrid& grid, const Image& map) const {
    std::vector<double> L_o(3 * points_.size());
    transport_.Render(grid, map.rgb.data(), L_o.data());
    return L_o;
  }

  const std::vector<ShadingPoint> points_ = SpherePoints(10);
  const Transport transport_;
  const BrdfGrid glossy_ =
      BrdfGrid::FromFunction(Glossy(0.1, 0.5, 3), BrdfGridShape());
  std::mt19937 rng_{8};
  std::normal_distribution<double> gauss_;
};

double Magnitude(const std::vector<double>& a, const std::vector<double>& b) {
  double sum = 0.0;
  for (size_t i = 0; i < a.size(); ++i) sum += std::abs(a[i] * b[i]);
  return sum;
}

TEST_F(TransportTest, WhiteFurnaceIsOneAtAllAngles) {
  std::vector<ShadingPoint> fan;
  for (double degrees = 0; degrees < 89.95; degrees += 1.0) {
    fan.push_back(PointAt(degrees * kPi / 180, degrees));
  }
  const BrdfGrid white = BrdfGrid::FromFunction(Lambertian(1), {});
  for (const int height : {8, 32, 64}) {
    const Image map = ConstantMap(height, 2 * height, 1.0f);
    std::vector<double> L_o(3 * fan.size());
    Transport(fan, height, 2 * height, {})
        .Render(white, map.rgb.data(), L_o.data());
    for (const double e : L_o) EXPECT_NEAR(1.0, e, kFloatSums);
  }
}

// Each point as if the object were of its material alone.
TEST_F(TransportTest, MaterialsAreThoseOfTheirPoints) {
  std::vector<ShadingPoint> points = points_;
  for (size_t i = 0; i < points.size(); ++i) points[i].material = i % 3;
  const BrdfGrid matte = BrdfGrid::FromFunction(Lambertian(0.4), {});
  const BrdfGrid rough = BrdfGrid::FromFunction(Glossy(0.3, 0.2, 20), {});
  const MaterialGrids grids = {&glossy_, &matte, &rough};
  const Image map = RandomMap(64, 128, 3);
  const Transport transport(points, 64, 128, {});
  std::vector<double> L_o(3 * points.size()), by_light(L_o.size());
  transport.Render(grids, map.rgb.data(), L_o.data());
  const LightOperator op = transport.ByLight(grids);
  op.Apply(map.rgb.data(), by_light.data());
  for (int m = 0; m < 3; ++m) {
    const std::vector<double> alone = Render(*grids[m], map);
    for (size_t i = m; i < points.size(); i += 3) {
      for (size_t k = 3 * i; k < 3 * i + 3; ++k) {
        EXPECT_EQ(alone[k], L_o[k]);
        EXPECT_NEAR(alone[k], by_light[k], kFloatSums * alone[k]);
      }
    }
  }
  // The transpose.
  std::vector<double> adjoint(L_o.size());
  for (double& a : adjoint) a = gauss_(rng_);
  std::vector<float> gradient(map.rgb.size());
  op.ApplyTranspose(adjoint.data(), gradient.data());
  double by_map = 0.0;
  for (size_t k = 0; k < gradient.size(); ++k) {
    by_map += static_cast<double>(gradient[k]) * map.rgb[k];
  }
  EXPECT_NEAR(Dot(adjoint, by_light), by_map,
              kFloatSums * Magnitude(adjoint, by_light));
}

TEST_F(TransportTest, RenderIsLinearInEachArgument) {
  const Image a = RandomMap(64, 128, 1), b = RandomMap(64, 128, 2);
  BrdfGrid f = glossy_;
  const BrdfGrid g = BrdfGrid::FromFunction(Glossy(0.3, 0.2, 20), {});
  Image sum_map = a;
  for (size_t i = 0; i < a.rgb.size(); ++i) sum_map.rgb[i] -= 0.5f * b.rgb[i];
  const auto Ea = Render(f, a), Eb = Render(f, b), Es = Render(f, sum_map);
  const auto Eg = Render(g, a);
  BrdfGrid sum_grid = f;
  for (size_t i = 0; i < f.values.size(); ++i) {
    sum_grid.values[i] += 2.0f * g.values[i];
  }
  const auto Et = Render(sum_grid, a);
  for (size_t i = 0; i < Ea.size(); ++i) {
    EXPECT_NEAR(Ea[i] - 0.5 * Eb[i], Es[i], kFloatSums * (Ea[i] + Eb[i]));
    EXPECT_NEAR(Ea[i] + 2 * Eg[i], Et[i], kFloatSums * Et[i]);
  }
}

TEST_F(TransportTest, LightOperatorIsRenderAndItsTransposeIsAdjoint) {
  const LightOperator op = transport_.ByLight(glossy_);
  const Image map = RandomMap(64, 128, 3);
  const std::vector<double> L_o = Render(glossy_, map);
  std::vector<double> applied(L_o.size());
  op.Apply(map.rgb.data(), applied.data());
  for (size_t i = 0; i < L_o.size(); ++i) {
    EXPECT_NEAR(L_o[i], applied[i], kFloatSums * L_o[i]);
  }
  // <a, A L> = <A^T a, L> for signed a and L.
  for (int trial = 0; trial < 3; ++trial) {
    Image tangent = map;
    for (float& v : tangent.rgb) v = static_cast<float>(gauss_(rng_));
    std::vector<double> adjoint(L_o.size());
    for (double& a : adjoint) a = gauss_(rng_);
    op.Apply(tangent.rgb.data(), applied.data());
    std::vector<float> gradient(map.rgb.size());
    op.ApplyTranspose(adjoint.data(), gradient.data());
    const std::vector<double> g(gradient.begin(), gradient.end());
    const std::vector<double> L(tangent.rgb.begin(), tangent.rgb.end());
    EXPECT_NEAR(Dot(adjoint, applied), Dot(g, L),
                1e-6 * (Magnitude(adjoint, applied) + Magnitude(g, L)));
  }
}

TEST_F(TransportTest, RowsAreTransposesOfUnitAdjoints) {
  const LightOperator op = transport_.ByLight(glossy_);
  const size_t size = size_t{3} * 64 * 128;
  std::vector<float> row(size, -1.0f), transposed(size);
  for (const size_t point :
       {size_t{0}, points_.size() / 2, points_.size() - 1}) {
    std::vector<double> adjoint(3 * points_.size(), 0.0);
    std::fill_n(&adjoint[3 * point], 3, 1.0);
    op.ApplyTranspose(adjoint.data(), transposed.data());
    ASSERT_TRUE(op.Row(static_cast<int>(point), row.data()));
    EXPECT_GT(*std::max_element(row.begin(), row.end()), 0.0f);
    for (size_t k = 0; k < size; ++k) {
      ASSERT_NEAR(transposed[k], row[k], 1e-6 * transposed[k]) << k;
    }
  }
}

TEST_F(TransportTest, TransposeMatchesFiniteDifferencesPerTexel) {
  const LightOperator op = transport_.ByLight(glossy_);
  std::vector<double> adjoint(3 * points_.size(), 0.0);
  for (double& a : adjoint) a = 0.5 + std::abs(gauss_(rng_));
  std::vector<float> gradient(size_t{3} * 64 * 128);
  op.ApplyTranspose(adjoint.data(), gradient.data());
  Image map(128, 64);
  std::vector<double> L_o(adjoint.size());
  // Poles and seam among them.
  for (const auto& [r, c] :
       {std::pair{0, 0}, {0, 127}, {63, 64}, {20, 0}, {40, 77}, {30, 127}}) {
    for (int k = 0; k < 3; ++k) {
      map.At(c, r)[k] = 1.0f;
      op.Apply(map.rgb.data(), L_o.data());
      map.At(c, r)[k] = 0.0f;
      const double derivative = Dot(adjoint, L_o);  // exact: linear
      EXPECT_NEAR(derivative, gradient[3 * (r * 128 + c) + k],
                  kFloatSums * derivative + 1e-12);
    }
  }
}

TEST_F(TransportTest, GridGradientIsTheTransposeOfRender) {
  const Image map = RandomMap(64, 128, 4);
  std::vector<double> adjoint(3 * points_.size(), 0.0);
  for (double& a : adjoint) a = gauss_(rng_);
  BrdfGrid tangent = glossy_;
  for (float& v : tangent.values) v = static_cast<float>(gauss_(rng_));
  const std::vector<double> L_o = Render(tangent, map);
  std::vector<float> gradient(tangent.values.size());
  transport_.GridGradient(glossy_, map.rgb.data(), adjoint.data(),
                          gradient.data());
  const std::vector<double> g(gradient.begin(), gradient.end());
  const std::vector<double> f(tangent.values.begin(), tangent.values.end());
  EXPECT_NEAR(Dot(adjoint, L_o), Dot(g, f),
              1e-6 * (Magnitude(adjoint, L_o) + Magnitude(g, f)));
}

TEST_F(TransportTest, LobesAddUpToTheRender) {
  const Image map = RandomMap(64, 128, 5);
  const int num_nodes = BrdfGridShape().num_nodes();
  for (const int num_fields : {1, 5, 34, 70}) {
    std::vector<std::vector<float>> fields(num_fields);
    std::vector<const float*> pointers;
    std::vector<double> colours(3 * num_fields);
    BrdfGrid sum{BrdfGridShape()};
    for (int k = 0; k < num_fields; ++k) {
      fields[k].resize(num_nodes);
      for (int c = 0; c < 3; ++c) colours[3 * k + c] = gauss_(rng_);
      for (int i = 0; i < num_nodes; ++i) {
        fields[k][i] = static_cast<float>(std::abs(gauss_(rng_)));
        for (int c = 0; c < 3; ++c) {
          sum.Channel(c)[i] +=
              static_cast<float>(colours[3 * k + c] * fields[k][i]);
        }
      }
      pointers.push_back(fields[k].data());
    }
    const std::vector<double> L_o = Render(sum, map);
    std::vector<float> lobes(points_.size() * 3 * num_fields);
    transport_.RenderLobes(pointers.data(), num_fields, map.rgb.data(),
                           lobes.data());
    const ReflectanceOperator op = transport_.ByReflectance(map.rgb.data());
    EXPECT_EQ(transport_.num_points(), op.num_points());
    std::vector<float> applied(lobes.size());
    op.Apply(pointers.data(), num_fields, applied.data());
    EXPECT_EQ(lobes, applied);
    for (size_t i = 0; i < points_.size(); ++i) {
      for (int c = 0; c < 3; ++c) {
        double total = 0.0, size = 0.0;
        for (int k = 0; k < num_fields; ++k) {
          const double term =
              colours[3 * k + c] * lobes[(i * num_fields + k) * 3 + c];
          total += term;
          size += std::abs(term);
        }
        ASSERT_NEAR(L_o[3 * i + c], total, kFloatSums * size);
      }
    }
  }
}

TEST_F(TransportTest, SameBitsForAnyNumberOfThreads) {
  const Image map = RandomMap(64, 128, 6);
  struct Results {
    std::vector<double> L_o, applied;
    std::vector<float> light, grid, lobes, reflected;
  };
  const auto compute = [&](int threads) {
    TransportOptions options;
    options.num_threads = threads;
    const Transport t(points_, 64, 128, options);
    Results r;
    r.L_o.resize(3 * points_.size());
    r.applied = r.L_o;
    r.light.resize(map.rgb.size());
    r.grid.resize(glossy_.values.size());
    r.lobes.resize(points_.size() * 6);
    t.Render(glossy_, map.rgb.data(), r.L_o.data());
    const LightOperator op = t.ByLight(glossy_);
    op.Apply(map.rgb.data(), r.applied.data());
    op.ApplyTranspose(r.L_o.data(), r.light.data());
    t.GridGradient(glossy_, map.rgb.data(), r.L_o.data(), r.grid.data());
    const float* fields[] = {glossy_.Channel(0), glossy_.Channel(1)};
    t.RenderLobes(fields, 2, map.rgb.data(), r.lobes.data());
    r.reflected.resize(r.lobes.size());
    t.ByReflectance(map.rgb.data()).Apply(fields, 2, r.reflected.data());
    return r;
  };
  const Results one = compute(1);
  for (const int threads : {2, 5}) {
    const Results many = compute(threads);
    EXPECT_EQ(one.L_o, many.L_o);
    EXPECT_EQ(one.applied, many.applied);
    EXPECT_EQ(one.light, many.light);
    EXPECT_EQ(one.grid, many.grid);
    EXPECT_EQ(one.lobes, many.lobes);
    EXPECT_EQ(one.reflected, many.reflected);
  }
}

TEST_F(TransportTest, QuarterTurnsOfLightAndObjectKeepTheRadiance) {
  const Image map = RandomMap(64, 128, 7);
  Image turned(128, 64);  // everything a quarter turn about y: phi + pi/2
  for (int r = 0; r < 64; ++r) {
    for (int c = 0; c < 128; ++c) {
      std::copy_n(map.At(c, r), 3, turned.At((c + 32) % 128, r));
    }
  }
  std::vector<ShadingPoint> points = points_;
  for (ShadingPoint& p : points) {
    // (x, y, z) = (sin phi, y, cos phi) goes to (z, y, -x).
    p.normal = Eigen::Vector3f(p.normal.z(), p.normal.y(), -p.normal.x());
    p.wo = Eigen::Vector3f(p.wo.z(), p.wo.y(), -p.wo.x());
  }
  const std::vector<double> L_o = Render(glossy_, map);
  std::vector<double> F(L_o.size());
  Transport(points, 64, 128, {}).Render(glossy_, turned.rgb.data(), F.data());
  // phi_d and texel positions round differently before they are quantised to
  // 1.5e-5 of a cell; a random map has log-differences of one per texel.
  for (size_t i = 0; i < L_o.size(); ++i)
    EXPECT_NEAR(L_o[i], F[i], 1e-4 * L_o[i]);
}

TEST_F(TransportTest, AgreesWithTheReferenceFromMatteToMirror) {
  struct Case {
    const char* name;
    BrdfFunction brdf;
    double tolerance;  // mean |log ratio|; twice what was measured
  };
  const Case cases[] = {{"matte", Glossy(0.5, 0, 10), 0.004},
                        {"rough", Glossy(0.05, 0.5, 10), 0.008},
                        {"glossy", Glossy(0.01, 0.5, 2.5), 0.012},
                        // Linear interpolation of a peak of two grid steps.
                        {"mirror", Glossy(0.001, 0.8, 0.5), 0.03}};
  for (const int height : {32, 64}) {
    const Image map = SmoothMap(height, 2 * height);
    const Transport transport(points_, height, 2 * height, {});
    const ReferenceRenderer reference(map, {});
    for (const Case& c : cases) {
      std::vector<double> L_o(3 * points_.size()), R(L_o.size());
      transport.Render(BrdfGrid::FromFunction(c.brdf, {}), map.rgb.data(),
                       L_o.data());
      reference.Render(points_, c.brdf, R.data());
      double sum = 0.0;
      for (size_t i = 0; i < L_o.size(); ++i)
        sum += std::abs(std::log(L_o[i] / R[i]));
      EXPECT_LT(sum / static_cast<double>(L_o.size()), c.tolerance)
          << c.name << " " << height;
    }
  }
}

TEST_F(TransportTest, ExtremesStayFinite) {
  std::vector<ShadingPoint> points = {PointAt(0, 0)};
  for (const double cosine : {1e-3, 0.01, 0.1, 1.0}) {
    points.push_back(PointAt(std::acos(cosine), 2.0));
  }
  const Transport transport(points, 32, 64, {});
  Image sun(64, 32);
  for (int c = 0; c < 3; ++c) sun.At(13, 15)[c] = 1e6f;
  BrdfGrid tiny{BrdfGridShape()}, chrome{BrdfGridShape()};
  for (int i = 0; i < chrome.shape.num_nodes(); ++i) {
    for (int c = 0; c < 3; ++c) {
      tiny.Channel(c)[i] = 1e-30f;
      // Raw 3.8e6 at the peak, 1e-5 1/sr elsewhere.
      chrome.Channel(c)[i] =
          chrome.shape.NodePoint(i)[0] < 0.03 ? 4200.0f : 1e-5f;
    }
  }
  for (const Image& map : {sun, Image(64, 32), ConstantMap(32, 64, 1e9f)}) {
    for (const BrdfGrid& grid : {tiny, chrome}) {
      std::vector<double> L_o(3 * points.size());
      transport.Render(grid, map.rgb.data(), L_o.data());
      std::vector<float> light(map.rgb.size()), g(grid.values.size());
      std::vector<double> applied(L_o.size());
      const LightOperator op = transport.ByLight(grid);
      op.Apply(map.rgb.data(), applied.data());
      op.ApplyTranspose(L_o.data(), light.data());
      transport.GridGradient(grid, map.rgb.data(), L_o.data(), g.data());
      for (const double e : L_o) {
        EXPECT_TRUE(std::isfinite(e));
        EXPECT_GE(e, 0.0);
      }
      for (const double e : applied) EXPECT_TRUE(std::isfinite(e));
      for (const float v : light) EXPECT_TRUE(std::isfinite(v));
      for (const float v : g) EXPECT_TRUE(std::isfinite(v));
    }
  }
}

TEST_F(TransportTest, SmallMapsAndOnePointWork) {
  const std::vector<ShadingPoint> one = {PointAt(0.4, 1.0)};
  for (const auto& [h, w] : {std::pair{1, 2}, {2, 4}, {3, 6}}) {
    const Image map = ConstantMap(h, w, 2.0f);
    double L_o[3];
    Transport(one, h, w, {})
        .Render(BrdfGrid::FromFunction(Lambertian(0.5), {}), map.rgb.data(),
                L_o);
    EXPECT_NEAR(1.0, L_o[1], kFloatSums);
  }
}

}  // namespace
}  // namespace ibrdf
