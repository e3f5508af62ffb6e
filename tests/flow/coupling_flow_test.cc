#include "ibrdf/flow/coupling_flow.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <memory>
#include <random>
#include <vector>

#include "ibrdf/flow/coupling_flow_reference.h"

namespace ibrdf {
namespace {

// Weights well away from the identity, so that a test sees curved maps:
// scale 1 is the trainer's start, 4 is rougher than trained models are.
std::vector<float> Weights(const CouplingShape& shape, float scale,
                           uint64_t seed = 3) {
  std::vector<float> w = InitialCouplingWeights(shape, seed);
  const DenseLayer last = shape.DenseLayers().back();
  for (int l = 0; l < shape.layers; ++l) {
    float* layer = w.data() + l * shape.WeightsPerLayer();
    for (int k = 0; k < last.in_count * last.out_count; ++k) {
      layer[last.weight_offset + k] *= scale;
    }
  }
  return w;
}

std::vector<float> Code(int size, double norm, uint64_t seed = 5) {
  std::mt19937_64 rng(seed);
  std::normal_distribution<double> normal;
  std::vector<float> z(size);
  double sum = 0.0;
  for (float& v : z) {
    v = static_cast<float>(normal(rng));
    sum += static_cast<double>(v) * v;
  }
  for (float& v : z) v *= static_cast<float>(norm / std::sqrt(sum));
  return z;
}

// Random points of the closed cube: inside, on faces, edges and corners.
std::vector<float> Points(int count, uint64_t seed = 7) {
  std::mt19937_64 rng(seed);
  std::uniform_real_distribution<float> uniform(0.0f, 1.0f);
  std::uniform_int_distribution<int> kind(0, 9);
  std::vector<float> x(3 * static_cast<size_t>(count));
  for (float& v : x) {
    const int k = kind(rng);
    v = k == 0 ? 0.0f : (k == 1 ? 1.0f : uniform(rng));
  }
  return x;
}

// Columns whose first is at the cube's faces.
FlowColumns RandomColumns(int count, int points, uint64_t seed = 13) {
  std::mt19937_64 rng(seed);
  std::uniform_real_distribution<float> uniform(0.0f, 1.0f);
  FlowColumns x(count, points);
  for (int c = 0; c < count; ++c) {
    x.SetColumn(c, c == 0 ? 0.0f : uniform(rng), c == 0 ? 1.0f : uniform(rng));
  }
  for (float& v : x.x_h) v = uniform(rng);
  return x;
}

using Reference = CouplingFlowReference<double>;

struct Case {
  CouplingShape shape;
  float scale;
  double code_norm;
};

std::vector<Case> Cases() {
  CouplingShape usual;
  CouplingShape odd;
  odd.layers = 5;
  odd.bins = 5;
  odd.code_size = 3;
  odd.widths = {19, 7};
  CouplingShape flat;
  flat.layers = 3;
  flat.bins = 32;
  flat.widths = {33};
  return {{usual, 1.0f, 0.5},
          {usual, 4.0f, 1.0},
          {usual, 4.0f, 30.0},
          {odd, 3.0f, 1.0},
          {flat, 3.0f, 0.0}};
}

TEST(CouplingFlowReference, GradientsMatchFiniteDifferences) {
  // Central differences in double, step 1e-6: truncation 1e-12 and rounding
  // 1e-10 relative to values of order one. Points near a knot, where the
  // density has a kink in x, are told by the one-sided differences.
  constexpr double kTolerance = 2e-6, kStep = 1e-6;
  for (const Case& c : Cases()) {
    const std::vector<float> w = Weights(c.shape, c.scale);
    const Reference flow(c.shape, w.data());
    const std::vector<float> zf = Code(c.shape.code_size, c.code_norm);
    std::vector<double> z(zf.begin(), zf.end());
    std::mt19937_64 rng(11);
    std::uniform_real_distribution<double> uniform(0.001, 0.999);
    int checked = 0;
    for (int trial = 0; trial < 6; ++trial) {
      double x[3] = {uniform(rng), uniform(rng), uniform(rng)}, u[3], dx[3];
      std::vector<double> dz(c.shape.code_size), dw;
      const double value =
          flow.LogDensityWithGradient(x, z.data(), dx, dz.data(), &dw);
      EXPECT_NEAR(value, flow.LogDensity(x, z.data(), u), 1e-12);
      const auto check = [&](double analytic, double minus, double plus) {
        const double left = (value - minus) / kStep;
        const double right = (plus - value) / kStep;
        if (std::abs(left - right) > 1e-3 * (1 + std::abs(analytic))) return;
        ++checked;
        EXPECT_NEAR(analytic, (left + right) / 2,
                    kTolerance * (1 + std::abs(analytic)));
      };
      for (int i = 0; i < 3; ++i) {
        double y[3] = {x[0], x[1], x[2]};
        y[i] -= kStep;
        const double minus = flow.LogDensity(y, z.data(), u);
        y[i] += 2 * kStep;
        check(dx[i], minus, flow.LogDensity(y, z.data(), u));
      }
      for (int i = 0; i < c.shape.code_size; ++i) {
        std::vector<double> y = z;
        y[i] -= kStep;
        const double minus = flow.LogDensity(x, y.data(), u);
        y[i] += 2 * kStep;
        check(dz[i], minus, flow.LogDensity(x, y.data(), u));
      }
      std::uniform_int_distribution<size_t> pick(0, w.size() - 1);
      for (int i = 0; i < 60; ++i) {
        const size_t at = pick(rng);
        std::vector<double> y(w.begin(), w.end());
        y[at] -= kStep;
        const double minus =
            Reference(c.shape, y.data()).LogDensity(x, z.data(), u);
        y[at] += 2 * kStep;
        check(dw[at], minus,
              Reference(c.shape, y.data()).LogDensity(x, z.data(), u));
      }
    }
    EXPECT_GT(checked, 6 * (60 + c.shape.code_size));  // kinks are rare
  }
}

TEST(CouplingFlowReference, InverseUndoesForwardOnTheClosedCube) {
  for (const Case& c : Cases()) {
    const std::vector<float> w = Weights(c.shape, c.scale);
    const Reference flow(c.shape, w.data());
    const std::vector<float> zf = Code(c.shape.code_size, c.code_norm);
    const std::vector<double> z(zf.begin(), zf.end());
    const int n = 300;
    const std::vector<float> points = Points(n);
    for (int p = 0; p < n; ++p) {
      const double x[3] = {points[p], points[n + p], points[2 * n + p]};
      double u[3], back[3];
      const double forward = flow.LogDensity(x, z.data(), u);
      const double inverse = flow.Inverse(u, z.data(), back);
      for (int i = 0; i < 3; ++i) EXPECT_NEAR(x[i], back[i], 1e-9);
      EXPECT_NEAR(forward, inverse, 1e-7);
    }
  }
}

TEST(CouplingFlowReference, DensityIntegratesToOne) {
  // Midpoint rule on 80^3 cells. Its error is of second order in the cell for
  // densities whose bins are wider than a cell; rougher flows than these
  // (Cases() at scale 4) need a finer rule than a test can afford.
  constexpr double kTolerance = 5e-3;
  for (const Case& c :
       {Case{CouplingShape(), 1.0f, 0.5}, Case{CouplingShape(), 2.0f, 1.0}}) {
    const CouplingFlow flow(c.shape, Weights(c.shape, c.scale));
    const std::vector<float> z = Code(c.shape.code_size, c.code_norm);
    constexpr int kCells = 80;
    const int64_t n = int64_t{kCells} * kCells * kCells;
    std::vector<float> x(3 * n), log_density(n);
    for (int64_t i = 0; i < n; ++i) {
      x[i] = (static_cast<float>(i / (kCells * kCells)) + 0.5f) / kCells;
      x[n + i] = (static_cast<float>(i / kCells % kCells) + 0.5f) / kCells;
      x[2 * n + i] = (static_cast<float>(i % kCells) + 0.5f) / kCells;
    }
    flow.LogDensity(x.data(), n, z.data(), 2, log_density.data(), nullptr,
                    nullptr);
    double sum = 0.0, spread = 0.0;
    for (const float v : log_density) {
      sum += std::exp(static_cast<double>(v));
      spread = std::max(spread, std::abs(static_cast<double>(v)));
    }
    EXPECT_NEAR(1.0, sum / static_cast<double>(n), kTolerance);
    EXPECT_GT(spread, 0.1);  // not just the identity
  }
}

class CouplingFlowLevels : public testing::TestWithParam<SimdLevel> {
 protected:
  void SetUp() override {
    if (!SimdLevelSupported(GetParam())) {
      GTEST_SKIP() << "this machine lacks " << SimdLevelName(GetParam());
    }
  }
};

TEST_P(CouplingFlowLevels, AgreesWithTheReference) {
  // A coordinate's rounding error e moves the next layers' log slopes by about
  // e times their derivative, which the rough cases make as large as 1e3: 5e-4
  // relative is some thousand roundings.
  constexpr double kTolerance = 5e-4;
  for (const Case& c : Cases()) {
    const std::vector<float> w = Weights(c.shape, c.scale);
    const CouplingFlow flow(c.shape, w, GetParam());
    const Reference reference(c.shape, w.data());
    const std::vector<float> zf = Code(c.shape.code_size, c.code_norm);
    const std::vector<double> z(zf.begin(), zf.end());
    const int n = 150;  // not a multiple of the block
    const std::vector<float> x = Points(n);
    std::vector<float> value(n), dcode(n * c.shape.code_size), dx(3 * n);
    flow.LogDensity(x.data(), n, zf.data(), 2, value.data(), dcode.data(),
                    dx.data());
    std::vector<float> plain(n);
    flow.LogDensity(x.data(), n, zf.data(), 1, plain.data(), nullptr, nullptr);
    EXPECT_EQ(plain, value);
    int values_off = 0, gradients_off = 0;
    for (int p = 0; p < n; ++p) {
      const double xp[3] = {x[p], x[n + p], x[2 * n + p]};
      double gx[3];
      std::vector<double> gz(c.shape.code_size);
      const double v = reference.LogDensityWithGradient(xp, z.data(), gx,
                                                        gz.data(), nullptr);
      values_off += std::abs(v - value[p]) > kTolerance * (1 + std::abs(v));
      double scale = 1.0;
      for (const double g : gz) scale = std::max(scale, std::abs(g));
      bool off = false;
      for (int k = 0; k < c.shape.code_size; ++k) {
        off |= std::abs(gz[k] - dcode[k * n + p]) > 5e-3 * scale;
      }
      gradients_off += off;
    }
    // A point within rounding of a knot may fall in the next bin, where the
    // derivatives differ, and later layers see that.
    EXPECT_LE(values_off, n / 30);
    EXPECT_LE(gradients_off, n / 30);
  }
}

TEST_P(CouplingFlowLevels, InverseUndoesForwardToFloatPrecision) {
  // Rounding of a latent coordinate comes back divided by the slopes: densities
  // here stay within e^+-2.5, so 2e-5 is some twenty roundings of the steepest.
  for (const Case& c :
       {Case{CouplingShape(), 1.0f, 0.5}, Case{CouplingShape(), 2.0f, 1.0}}) {
    const CouplingFlow flow(c.shape, Weights(c.shape, c.scale), GetParam());
    const std::vector<float> z = Code(c.shape.code_size, c.code_norm);
    const int n = 1000;
    const std::vector<float> points = Points(n);
    const std::vector<double> x(points.begin(), points.end());
    std::vector<double> latent(3 * n), back(3 * n);
    flow.Latent(x.data(), n, z.data(), 1, latent.data());
    flow.Inverse(latent.data(), n, z.data(), 2, back.data());
    const std::vector<float> found(back.begin(), back.end());
    std::vector<float> value(n), inverse(n);
    flow.LogDensity(points.data(), n, z.data(), 1, value.data(), nullptr,
                    nullptr);
    flow.LogDensity(found.data(), n, z.data(), 1, inverse.data(), nullptr,
                    nullptr);
    for (int p = 0; p < n; ++p) {
      EXPECT_NEAR(value[p], inverse[p], 1e-3);
      for (int i = 0; i < 3; ++i) {
        EXPECT_NEAR(x[i * n + p], back[i * n + p], 2e-5);
      }
    }
  }
}

TEST_P(CouplingFlowLevels, LatentIsTheReferences) {
  // The same bound as of log densities: layers feed each other.
  constexpr double kTolerance = 5e-4;
  for (const Case& c : Cases()) {
    const std::vector<float> w = Weights(c.shape, c.scale);
    const CouplingFlow flow(c.shape, w, GetParam());
    const Reference reference(c.shape, w.data());
    const std::vector<float> zf = Code(c.shape.code_size, c.code_norm);
    const std::vector<double> z(zf.begin(), zf.end());
    const int n = 150;
    const std::vector<float> points = Points(n);
    const std::vector<double> x(points.begin(), points.end());
    std::vector<double> latent(3 * n);
    flow.Latent(x.data(), n, zf.data(), 1, latent.data());
    for (int p = 0; p < n; ++p) {
      const double xp[3] = {x[p], x[n + p], x[2 * n + p]};
      double u[3];
      reference.LogDensity(xp, z.data(), u);
      for (int i = 0; i < 3; ++i) {
        EXPECT_NEAR(u[i], latent[i * n + p], kTolerance);
      }
    }
  }
}

TEST_P(CouplingFlowLevels, ColumnsArePoints) {
  const CouplingShape shape;
  const CouplingFlow flow(shape, Weights(shape, 3.0f), GetParam());
  const std::vector<float> z = Code(shape.code_size, 0.8);
  const int n = 21, points = 9, count = n * points;
  const FlowColumns columns = RandomColumns(n, points);
  std::vector<float> x(3 * count);
  for (int i = 0; i < count; ++i) {
    x[i] = columns.x_h[i];
    x[count + i] = columns.x_d[i % n];
    x[2 * count + i] = columns.x_p[i % n];
  }
  std::vector<float> a(count), b(count);
  std::vector<float> da(count * shape.code_size), db(da);
  flow.LogDensity(x.data(), count, z.data(), 1, a.data(), da.data(), nullptr);
  flow.LogDensityOnColumns(columns, z.data(), 2, b.data(), db.data());
  EXPECT_EQ(a, b);
  EXPECT_EQ(da, db);
}

TEST_P(CouplingFlowLevels, TrainingGradientMatchesTheReference) {
  const CouplingShape shape;
  const std::vector<float> w = Weights(shape, 3.0f);
  const CouplingFlow flow(shape, w, GetParam());
  const Reference reference(shape, w.data());
  // Two codes of 16 columns of 8 points: two blocks of points each.
  constexpr int kCodes = 2, kPoints = 8;
  const int per_code = flow.TrainingColumns(), n = kCodes * per_code;
  const FlowColumns x = RandomColumns(n, kPoints);
  std::vector<float> codes = Code(shape.code_size, 0.8);
  const std::vector<float> other = Code(shape.code_size, 0.5, 9);
  codes.insert(codes.end(), other.begin(), other.end());
  std::vector<float> value(n * kPoints), adjoint(n * kPoints);
  std::mt19937_64 rng(1);
  std::normal_distribution<float> normal;
  for (float& a : adjoint) a = normal(rng);
  const std::unique_ptr<BrdfFlow::TrainingPass> pass = flow.NewTrainingPass();
  pass->Forward(x, kCodes, codes.data(), value.data());
  std::vector<float> buffer(flow.GradientSize(), 0.0f);
  std::vector<float> dz(codes.size(), 0.0f), dw(w.size(), 0.0f);
  pass->Backward(adjoint.data(), buffer.data(), dz.data());
  flow.AddGradient(buffer.data(), dw.data());
  std::vector<double> rw(w.size(), 0.0), rz(codes.size(), 0.0);
  for (int i = 0; i < n * kPoints; ++i) {
    const int column = i % n, code = column / per_code;
    const double xp[3] = {x.x_h[i], x.x_d[column], x.x_p[column]};
    const std::vector<double> z(codes.begin() + code * shape.code_size,
                                codes.begin() + (code + 1) * shape.code_size);
    std::vector<double> gz(shape.code_size), gw;
    const double v =
        reference.LogDensityWithGradient(xp, z.data(), nullptr, gz.data(), &gw);
    EXPECT_NEAR(v, value[i], 1e-3 * (1 + std::abs(v)));
    for (size_t k = 0; k < gw.size(); ++k) rw[k] += adjoint[i] * gw[k];
    for (int k = 0; k < shape.code_size; ++k) {
      rz[code * shape.code_size + k] += adjoint[i] * gz[k];
    }
  }
  double error = 0.0, norm = 0.0;
  for (size_t i = 0; i < rw.size(); ++i) {
    error += (rw[i] - dw[i]) * (rw[i] - dw[i]);
    norm += rw[i] * rw[i];
  }
  EXPECT_LT(std::sqrt(error / norm), 1e-3);
  for (size_t k = 0; k < rz.size(); ++k) EXPECT_NEAR(rz[k], dz[k], 1e-2);
}

INSTANTIATE_TEST_SUITE_P(All, CouplingFlowLevels,
                         testing::Values(SimdLevel::kPortable, SimdLevel::kAvx2,
                                         SimdLevel::kAvx512),
                         [](const testing::TestParamInfo<SimdLevel>& level) {
                           return SimdLevelName(level.param);
                         });

TEST(CouplingFlow, SameBitsForAnyNumberOfThreads) {
  const CouplingShape shape;
  const CouplingFlow flow(shape, Weights(shape, 3.0f));
  const std::vector<float> z = Code(shape.code_size, 1.0);
  const int n = 1000;
  const std::vector<float> x = Points(n);
  std::vector<float> first(n), first_dz(n * shape.code_size);
  flow.LogDensity(x.data(), n, z.data(), 1, first.data(), first_dz.data(),
                  nullptr);
  for (const int threads : {2, 8}) {
    std::vector<float> value(n), dz(n * shape.code_size);
    flow.LogDensity(x.data(), n, z.data(), threads, value.data(), dz.data(),
                    nullptr);
    EXPECT_EQ(first, value);
    EXPECT_EQ(first_dz, dz);
  }
}

TEST(CouplingFlow, StaysFiniteForExtremeWeightsAndCodes) {
  const CouplingShape shape;
  for (const float scale : {0.0f, 100.0f, 1e4f}) {
    for (const double norm : {0.0, 1.0, 1e3}) {
      const CouplingFlow flow(shape, Weights(shape, scale));
      const std::vector<float> z = Code(shape.code_size, norm);
      const int n = 500;
      const std::vector<float> x = Points(n);
      const std::vector<double> latent(x.begin(), x.end());
      std::vector<float> v(n), dz(n * shape.code_size), dx(3 * n);
      std::vector<double> u(3 * n);
      flow.LogDensity(x.data(), n, z.data(), 1, v.data(), dz.data(), dx.data());
      flow.Inverse(latent.data(), n, z.data(), 1, u.data());
      for (const float a : v) ASSERT_TRUE(std::isfinite(a));
      for (const float a : dz) ASSERT_TRUE(std::isfinite(a));
      for (const float a : dx) ASSERT_TRUE(std::isfinite(a));
      for (const double a : u) ASSERT_TRUE(a >= 0.0 && a <= 1.0);
    }
  }
}

}  // namespace
}  // namespace ibrdf
