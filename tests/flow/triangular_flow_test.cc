// The triangular flow's float kernels against the double reference.
#include "ibrdf/flow/triangular_flow.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <memory>
#include <random>
#include <vector>

#include "ibrdf/base/dual.h"
#include "ibrdf/flow/triangular_reference.h"
#include "tests/support/triangular_testing.h"

namespace ibrdf {
namespace {

// Log densities of magnitude 40 are differences of heights that float rounds to
// 4e-6, and derivatives are sums of some hundred rounded products.
constexpr double kValueRounding = 1e-5;
constexpr double kGradientRounding = 2e-4;
// Beside that, kernels may be as wrong as the exact answer for weights and
// points that are off by some roundings (a float's is 6e-8): matters where
// splines are steep or a code is far away.
constexpr double kWeightShift = 2.4e-7;
constexpr double kPointShift = 4e-7;
constexpr double kShiftFactor = 4.0;  // the worst of three random shifts x 4

struct Derivatives {
  double value = 0.0;
  std::vector<double> dcode;
  double dx[3] = {};
};

// Derivatives by x are of one side of a kink: `side` = 1 or -1.
Derivatives Differentiate(const TriangularReference<double>& flow,
                          const double* x, const std::vector<float>& code,
                          int side) {
  constexpr double kStep = 1e-7;
  const int n = static_cast<int>(code.size());
  std::vector<Dual> z;
  for (int k = 0; k < n; ++k) z.emplace_back(double{code[k]}, n, k);
  const Dual value = flow.LogDensity(x, z.data());
  Derivatives d;
  d.value = value.value;
  d.dcode = value.derivatives;
  d.dcode.resize(n, 0.0);
  const std::vector<double> plain(code.begin(), code.end());
  for (int i = 0; i < 3; ++i) {
    double y[3] = {x[0], x[1], x[2]};
    y[i] += side * kStep;
    d.dx[i] = (flow.LogDensity(y, plain.data()) - d.value) / (side * kStep);
  }
  return d;
}

// The reference with what rounding may do to it.
class Judge {
 public:
  explicit Judge(const TriangularCase& c)
      : code_(c.code), exact_(c.shape, c.weights.data()) {
    std::mt19937_64 rng(17);
    std::uniform_real_distribution<double> uniform(-1.0, 1.0);
    for (int i = 0; i < 3; ++i) {
      std::vector<double> w(c.weights.begin(), c.weights.end());
      for (double& v : w) v *= 1 + kWeightShift * uniform(rng);
      shifted_.emplace_back(c.shape, w.data());
      for (double& v : point_shift_[i]) v = kPointShift * uniform(rng);
    }
  }

  void Expect(const double* x, double value, const std::vector<double>& dcode,
              const double* dx) const {
    const Derivatives right = Differentiate(exact_, x, code_, 1);
    const Derivatives left = Differentiate(exact_, x, code_, -1);
    double spread = 0.0, code_spread = 0.0, x_spread[3] = {};
    for (int i = 0; i < 3; ++i) {
      double y[3];
      for (int k = 0; k < 3; ++k) y[k] = x[k] + point_shift_[i][k];
      const Derivatives moved = Differentiate(shifted_[i], y, code_, 1);
      spread = std::max(spread, std::abs(moved.value - right.value));
      for (size_t k = 0; k < code_.size(); ++k) {
        code_spread =
            std::max(code_spread, std::abs(moved.dcode[k] - right.dcode[k]));
      }
      for (int k = 0; k < 3; ++k) {
        x_spread[k] =
            std::max(x_spread[k], std::abs(moved.dx[k] - right.dx[k]));
      }
    }
    EXPECT_NEAR(
        right.value, value,
        kValueRounding * (1 + std::abs(right.value)) + kShiftFactor * spread);
    double scale = 1.0;
    for (const double g : right.dcode) scale = std::max(scale, std::abs(g));
    for (size_t k = 0; k < dcode.size(); ++k) {
      EXPECT_NEAR(right.dcode[k], dcode[k],
                  kGradientRounding * scale + kShiftFactor * code_spread);
    }
    for (int i = 0; i < 3 && dx != nullptr; ++i) {
      const double error =
          std::min(std::abs(right.dx[i] - dx[i]), std::abs(left.dx[i] - dx[i]));
      EXPECT_LE(error, kGradientRounding * (1 + std::abs(right.dx[i])) +
                           kShiftFactor * x_spread[i])
          << "dimension " << i << ": " << right.dx[i] << " or " << left.dx[i]
          << ", found " << dx[i];
    }
  }

 private:
  std::vector<float> code_;
  TriangularReference<double> exact_;
  std::vector<TriangularReference<double>> shifted_;
  double point_shift_[3][3];
};

class TriangularFlowLevels : public testing::TestWithParam<SimdLevel> {
 protected:
  void SetUp() override {
    if (!SimdLevelSupported(GetParam())) {
      GTEST_SKIP() << "this machine lacks " << SimdLevelName(GetParam());
    }
  }
};
INSTANTIATE_TEST_SUITE_P(All, TriangularFlowLevels,
                         testing::Values(SimdLevel::kPortable, SimdLevel::kAvx2,
                                         SimdLevel::kAvx512),
                         [](const testing::TestParamInfo<SimdLevel>& level) {
                           return SimdLevelName(level.param);
                         });

TEST_P(TriangularFlowLevels, PointsAgreeWithTheReference) {
  for (const TriangularCase& c : TriangularCases()) {
    SCOPED_TRACE(c.name);
    const TriangularFlow flow(c.shape, c.weights, GetParam());
    const Judge judge(c);
    const int n = 75, size = c.shape.code_size;  // not a multiple of a block
    const std::vector<float> x = CubePoints(n);
    std::vector<float> value(n), dcode(n * size), dx(3 * n), plain(n);
    flow.LogDensity(x.data(), n, c.code.data(), 1, value.data(), dcode.data(),
                    dx.data());
    flow.LogDensity(x.data(), n, c.code.data(), 1, plain.data(), nullptr,
                    nullptr);
    EXPECT_EQ(plain, value);
    for (int p = 0; p < n; ++p) {
      const double xp[3] = {x[p], x[n + p], x[2 * n + p]};
      const double dxp[3] = {dx[p], dx[n + p], dx[2 * n + p]};
      std::vector<double> dz;
      for (int k = 0; k < size; ++k) dz.push_back(dcode[k * n + p]);
      judge.Expect(xp, value[p], dz, dxp);
    }
  }
}

TEST_P(TriangularFlowLevels, ColumnsAgreeWithTheReference) {
  for (const TriangularCase& c : TriangularCases()) {
    SCOPED_TRACE(c.name);
    const TriangularFlow flow(c.shape, c.weights, GetParam());
    const Judge judge(c);
    const FlowColumns columns = CubeColumns(37, 3);
    const int n = static_cast<int>(columns.num_points());
    const int size = c.shape.code_size;
    const std::vector<float> x = PointsOf(columns);
    std::vector<float> value(n), dcode(n * size), plain(n);
    flow.LogDensityOnColumns(columns, c.code.data(), 1, value.data(),
                             dcode.data());
    flow.LogDensityOnColumns(columns, c.code.data(), 1, plain.data(), nullptr);
    EXPECT_EQ(plain, value);
    for (int p = 0; p < n; ++p) {
      const double xp[3] = {x[p], x[n + p], x[2 * n + p]};
      std::vector<double> dz;
      for (int k = 0; k < size; ++k) dz.push_back(dcode[k * n + p]);
      judge.Expect(xp, value[p], dz, nullptr);
    }
  }
}

TEST_P(TriangularFlowLevels, ColumnsArePoints) {
  // Two ways of sums in float, of moderate flows.
  TriangularShape shape;
  const TriangularCase c = MakeCase("rough", shape, 4.0f, 1.0);
  const TriangularFlow flow(shape, c.weights, GetParam());
  const FlowColumns columns = CubeColumns(70, 11);
  const int n = static_cast<int>(columns.num_points()), size = shape.code_size;
  const std::vector<float> x = PointsOf(columns);
  std::vector<float> a(n), b(n), da(n * size), db(n * size);
  flow.LogDensity(x.data(), n, c.code.data(), 1, a.data(), da.data(), nullptr);
  flow.LogDensityOnColumns(columns, c.code.data(), 1, b.data(), db.data());
  for (int i = 0; i < n; ++i)
    EXPECT_NEAR(a[i], b[i], 1e-5 * (1 + std::abs(a[i])));
  float scale = 1.0f;
  for (const float g : da) scale = std::max(scale, std::abs(g));
  for (int i = 0; i < n * size; ++i) EXPECT_NEAR(da[i], db[i], 1e-4 * scale);
}

// sum adjoint * log density by the reference.
class Objective {
 public:
  Objective(const TriangularShape& shape, const FlowColumns& x,
            const std::vector<float>& adjoint, int columns_per_code)
      : shape_(shape), x_(x), adjoint_(adjoint), per_code_(columns_per_code) {}

  double At(const std::vector<double>& weights,
            const std::vector<double>& codes) const {
    const TriangularReference<double> flow(shape_, weights.data());
    double sum = 0.0;
    for (size_t i = 0; i < adjoint_.size(); ++i) {
      const int column = static_cast<int>(i) % x_.columns;
      const double x[3] = {x_.x_h[i], x_.x_d[column], x_.x_p[column]};
      sum += adjoint_[i] *
             flow.LogDensity(
                 x, codes.data() + column / per_code_ * shape_.code_size);
    }
    return sum;
  }

  // By one of the weights or codes.
  double Difference(std::vector<double> weights, std::vector<double> codes,
                    bool by_code, size_t at) const {
    constexpr double kStep = 1e-6;
    double& v = by_code ? codes[at] : weights[at];
    v += kStep;
    const double up = At(weights, codes);
    v -= 2 * kStep;
    return (up - At(weights, codes)) / (2 * kStep);
  }

 private:
  const TriangularShape& shape_;
  const FlowColumns& x_;
  const std::vector<float>& adjoint_;
  int per_code_;
};

TEST_P(TriangularFlowLevels, TrainingGradientMatchesFiniteDifferences) {
  // Sums of a hundred points' float derivatives against differences that are
  // exact to 1e-7, relative to the gradient's size.
  constexpr double kTolerance = 1e-3;
  for (const TriangularCase& c : TriangularCases()) {
    if (c.name == "far code") continue;  // the unit ball's edge is "rough"
    SCOPED_TRACE(c.name);
    const TriangularFlow flow(c.shape, c.weights, GetParam());
    // Three codes of 16 columns: a block holds two, the last is half empty.
    constexpr int kCodes = 3, kPoints = 3;
    const int per_code = flow.TrainingColumns(), size = c.shape.code_size;
    ASSERT_EQ(16, per_code);
    const int columns = kCodes * per_code;
    const FlowColumns x = CubeColumns(columns, kPoints, 21);
    std::vector<float> codes;
    for (int i = 0; i < kCodes; ++i) {
      const std::vector<float> z = RandomCode(size, 0.3 + 0.3 * i, 30 + i);
      codes.insert(codes.end(), z.begin(), z.end());
    }
    std::vector<float> value(columns * kPoints), adjoint(columns * kPoints);
    std::mt19937_64 rng(1);
    std::normal_distribution<float> normal;
    for (float& a : adjoint) a = normal(rng);
    const std::unique_ptr<BrdfFlow::TrainingPass> pass = flow.NewTrainingPass();
    pass->Forward(x, kCodes, codes.data(), value.data());
    std::vector<float> buffer(flow.GradientSize(), 0.0f);
    std::vector<float> dz(codes.size(), 0.0f), dw(c.weights.size(), 0.0f);
    pass->Backward(adjoint.data(), buffer.data(), dz.data());
    flow.AddGradient(buffer.data(), dw.data());

    // Values are those of each code alone.
    const std::vector<float> points = PointsOf(x);
    std::vector<float> alone(value.size());
    for (int k = 0; k < kCodes; ++k) {
      flow.LogDensity(points.data(), columns * kPoints, codes.data() + k * size,
                      1, alone.data(), nullptr, nullptr);
      for (int i = 0; i < columns * kPoints; ++i) {
        if (i % columns / per_code != k) continue;
        EXPECT_NEAR(alone[i], value[i],
                    5 * kValueRounding * (1 + std::abs(alone[i])));
      }
    }

    const Objective objective(c.shape, x, adjoint, per_code);
    const std::vector<double> w(c.weights.begin(), c.weights.end());
    const std::vector<double> z(codes.begin(), codes.end());
    std::vector<size_t> picks;
    size_t begin = 0;
    for (const ConditionerShape& conditioner : c.shape.Conditioners()) {
      const size_t n = conditioner.num_weights;
      std::uniform_int_distribution<size_t> pick(0, n - 1);
      for (int i = 0; i < 12; ++i) picks.push_back(begin + pick(rng));
      // Weights and bias of the last layer, and the code's part.
      for (size_t i = 1; i <= 4; ++i) picks.push_back(begin + n - i);
      picks.push_back(begin + conditioner.code_offset);
      begin += n;
    }
    const auto check = [&](const std::vector<float>& found, bool by_code,
                           const std::vector<size_t>& at) {
      std::vector<double> expected;
      double square = 0.0;
      for (const size_t i : at) {
        expected.push_back(objective.Difference(w, z, by_code, i));
        square += expected.back() * expected.back();
      }
      const double scale = std::sqrt(square / static_cast<double>(at.size()));
      EXPECT_TRUE(scale > 1e-4) << scale;
      for (size_t i = 0; i < at.size(); ++i) {
        EXPECT_NEAR(expected[i], found[at[i]],
                    kTolerance * (scale + std::abs(expected[i])))
            << (by_code ? "code " : "weight ") << at[i];
      }
    };
    check(dw, false, picks);
    std::vector<size_t> all(codes.size());
    for (size_t i = 0; i < all.size(); ++i) all[i] = i;
    check(dz, true, all);

    // A second call adds to the buffers.
    const std::vector<float> once = dz;
    pass->Backward(adjoint.data(), buffer.data(), dz.data());
    for (size_t i = 0; i < dz.size(); ++i) {
      EXPECT_NEAR(2 * once[i], dz[i], 1e-5 * (1 + std::abs(once[i])));
    }
  }
}

TEST_P(TriangularFlowLevels, StaysFiniteForExtremeWeightsAndCodes) {
  TriangularShape usual;
  TriangularShape many;
  many.bins = {64, 64, 64};
  many.widths = {16};
  many.marginal_widths = {16};
  for (const TriangularShape& shape : {usual, many}) {
    for (const float scale : {0.0f, 100.0f, 1e4f}) {
      for (const double norm : {0.0, 1.0, 1e3}) {
        TriangularCase c = MakeCase("", shape, scale, norm);
        const TriangularFlow flow(shape, c.weights, GetParam());
        const int n = 100, size = shape.code_size;
        const std::vector<float> x = CubePoints(n);
        std::vector<float> v(n), dz(n * size), dx(3 * n);
        flow.LogDensity(x.data(), n, c.code.data(), 1, v.data(), dz.data(),
                        dx.data());
        const FlowColumns columns = CubeColumns(32, 4);
        std::vector<float> cv(128), cdz(128 * size);
        flow.LogDensityOnColumns(columns, c.code.data(), 1, cv.data(),
                                 cdz.data());
        const auto pass = flow.NewTrainingPass();
        std::vector<float> codes(c.code), tv(128);
        codes.insert(codes.end(), c.code.begin(), c.code.end());
        std::vector<float> g(flow.GradientSize()), gz(2 * size);
        pass->Forward(columns, 2, codes.data(), tv.data());
        pass->Backward(std::vector<float>(128, 1.0f).data(), g.data(),
                       gz.data());
        const std::vector<double> from(x.begin(), x.end());
        std::vector<double> u(3 * n), y(3 * n);
        flow.Latent(from.data(), n, c.code.data(), 1, u.data());
        flow.Inverse(from.data(), n, c.code.data(), 1, y.data());
        for (const auto* values : {&v, &dz, &dx, &cv, &cdz, &tv, &g, &gz}) {
          for (const float a : *values) {
            ASSERT_TRUE(std::isfinite(a)) << scale << " " << norm;
          }
        }
        for (const auto* values : {&u, &y}) {
          for (const double a : *values) {
            ASSERT_TRUE(a >= 0.0 && a <= 1.0) << scale << " " << norm;
          }
        }
      }
    }
  }
}

TEST(TriangularFlow, SameBitsForAnyNumberOfThreads) {
  const TriangularShape shape;
  const TriangularCase c = MakeCase("", shape, 4.0f, 1.0);
  const TriangularFlow flow(shape, c.weights);
  const int n = 500, size = shape.code_size;
  const std::vector<float> x = CubePoints(n);
  const std::vector<double> from(x.begin(), x.end());
  const FlowColumns columns = CubeColumns(100, 5);
  const auto run = [&](int threads) {
    std::vector<float> v(n), dz(n * size), dx(3 * n), cv(n), cdz(n * size);
    std::vector<double> u(3 * n), y(3 * n), all;
    const float* z = c.code.data();
    flow.LogDensity(x.data(), n, z, threads, v.data(), dz.data(), dx.data());
    flow.LogDensityOnColumns(columns, z, threads, cv.data(), cdz.data());
    flow.Latent(from.data(), n, z, threads, u.data());
    flow.Inverse(from.data(), n, z, threads, y.data());
    for (const auto* part : {&v, &dz, &dx, &cv, &cdz}) {
      all.insert(all.end(), part->begin(), part->end());
    }
    all.insert(all.end(), u.begin(), u.end());
    all.insert(all.end(), y.begin(), y.end());
    return all;
  };
  const std::vector<double> one = run(1);
  for (const int threads : {2, 8, 0}) EXPECT_EQ(one, run(threads));
}

}  // namespace
}  // namespace ibrdf
