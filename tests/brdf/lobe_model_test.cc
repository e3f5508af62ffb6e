#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <memory>
#include <vector>

#include "ibrdf/brdf/flow_lobes.h"
#include "ibrdf/brdf/merl_columns.h"
#include "tests/support/tiny_model.h"

namespace ibrdf {
namespace {

constexpr BrdfGridShape kGrid{10, 6, 5};
// Float kernels of log q against double, times the exponent: measured below
// 2e-5 for this model.
constexpr double kFloatLogDensity = 1e-4;

class LobeModelTest : public ::testing::Test {
 protected:
  const NeuralBrdfModel model_ = TinyModel(2);
  const FlowLobes lobes_{model_, 2, kGrid, 1};
  const std::vector<double> parameters_ = {
      0.3, -0.4, 0.2, 0.1, 4.0, 4.3, 3.8, -0.5, 0.1, 0.3, -0.2, 3.0, 2.5, 3.3};

  // log q of the flow at one point.
  double LogDensity(const Eigen::Vector3d& cube, const double* code) const {
    const std::unique_ptr<BrdfFlow> flow =
        BrdfFlow::Create(model_.shape, model_.weights);
    const Eigen::Vector3f x = cube.cast<float>();
    const std::vector<float> z(code, code + 4);
    float value = 0.0f;
    flow->LogDensity(x.data(), 1, z.data(), 1, &value, nullptr, nullptr);
    return value;
  }
  // Raw MERL value of both lobes.
  double Expected(const Eigen::Vector3d& cube, int channel) const {
    double sum = 0.0;
    for (int k = 0; k < 2; ++k) {
      const double* lobe = parameters_.data() + 7 * k;
      sum += std::exp(lobe[4 + channel] +
                      model_.exponent * LogDensity(cube, lobe));
    }
    return sum;
  }
  BrdfGrid Combined(const std::vector<double>& p) const {
    return lobes_.Grid(p.data());
  }
};

TEST_F(LobeModelTest, SizesAreThoseOfTheLayout) {
  EXPECT_EQ(7, lobes_.lobe_size());
  EXPECT_EQ(14, lobes_.num_parameters());
  EXPECT_EQ(10, lobes_.num_fields());
}

TEST_F(LobeModelTest, FloatTablesAreTheReferences) {
  std::vector<float> fast, slow;
  lobes_.Tabulate(parameters_.data(), true, &fast);
  lobes_.TabulateReference(parameters_.data(), true, &slow);
  const size_t n = kGrid.num_nodes();
  ASSERT_EQ(10 * n, fast.size());
  ASSERT_EQ(fast.size(), slow.size());
  for (int k = 0; k < 2; ++k) {
    for (size_t i = 0; i < n; ++i) {
      const double value = slow[(5 * k) * n + i];
      ASSERT_GT(value, 0.0);
      EXPECT_NEAR(value, fast[(5 * k) * n + i], kFloatLogDensity * value);
      // Derivatives of log q of order 1, times exponent and value; a knot of
      // a spline may lie between the float's and the double's point.
      double scale = value;
      for (int d = 1; d < 5; ++d) {
        scale = std::max(scale, std::abs(double{slow[(5 * k + d) * n + i]}));
      }
      for (int d = 1; d < 5; ++d) {
        EXPECT_NEAR(slow[(5 * k + d) * n + i], fast[(5 * k + d) * n + i],
                    10 * kFloatLogDensity * scale);
      }
    }
  }
}

TEST_F(LobeModelTest, ReferenceDerivativesMatchDifferences) {
  std::vector<float> slow, up, down;
  lobes_.TabulateReference(parameters_.data(), true, &slow);
  const size_t n = kGrid.num_nodes();
  // Tables hold floats: 6e-8 of a value over 2h = 2e-3 is 3e-5 of it, and
  // h^2 / 6 times a third derivative of hundreds as much. A knot of a spline
  // passes a node within h now and then, where the derivative jumps.
  constexpr double kStep = 1e-3, kTolerance = 2e-3;
  constexpr double kMostAtKnots = 0.02;  // share of nodes
  for (int k = 0; k < 2; ++k) {
    for (int d = 0; d < 4; ++d) {
      std::vector<double> p = parameters_;
      p[7 * k + d] += kStep;
      lobes_.TabulateReference(p.data(), false, &up);
      p[7 * k + d] -= 2 * kStep;
      lobes_.TabulateReference(p.data(), false, &down);
      double scale = 0.0;
      std::vector<double> errors;
      for (size_t i = 0; i < n; ++i) {
        const double value = slow[5 * k * n + i];
        const double numeric =
            (double{up[k * n + i]} - down[k * n + i]) / (2 * kStep) / value;
        const double analytic = slow[(5 * k + 1 + d) * n + i] / value;
        scale = std::max(scale, std::abs(analytic));
        errors.push_back(std::abs(numeric - analytic));
      }
      EXPECT_GT(scale, 0.05);  // codes matter in this model
      const auto wrong =
          std::count_if(errors.begin(), errors.end(),
                        [&](double e) { return e > kTolerance * (1 + scale); });
      EXPECT_LE(wrong, kMostAtKnots * n) << k << " " << d;
    }
  }
}

TEST_F(LobeModelTest, CombineIsTheSumOfLobesAtTheNodes) {
  const BrdfGrid grid = Combined(parameters_);
  for (int node = 0; node < kGrid.num_nodes(); node += 7) {
    for (int c = 0; c < 3; ++c) {
      const double expected =
          Expected(WithinMerlBins(kGrid.NodePoint(node)), c) * kMerlScale[c];
      EXPECT_NEAR(expected, grid.Channel(c)[node], kFloatLogDensity * expected);
    }
  }
}

TEST_F(LobeModelTest, CombineSkipsDerivativeFields) {
  std::vector<float> fields;
  lobes_.Tabulate(parameters_.data(), true, &fields);
  const BrdfGrid strided = lobes_.Combine(parameters_.data(), fields, 5);
  const BrdfGrid plain = Combined(parameters_);
  // The pass with derivatives may round otherwise.
  for (size_t i = 0; i < plain.values.size(); ++i) {
    EXPECT_NEAR(plain.values[i], strided.values[i],
                kFloatLogDensity * plain.values[i]);
  }
}

TEST_F(LobeModelTest, MerlTableIsTheSumOfLobesAboveTheHorizonAndMinusOneBelow) {
  const MerlTable table = lobes_.ToMerl(parameters_.data());
  ASSERT_EQ(size_t{3} * kMerlBins, table.raw.size());
  int below = 0, checked = 0;
  for (int i = 0; i < kMerlThetaH; ++i) {
    for (int j = 0; j < kMerlThetaD; ++j) {
      for (int k = 0; k < kMerlPhiD; ++k) {
        const int bin = MerlTable::Bin(i, j, k);
        if (!MerlBinAboveHorizon(i, j, k)) {
          ++below;
          for (int c = 0; c < 3; ++c) ASSERT_EQ(-1.0, table.Raw(c, bin));
          continue;
        }
        for (int c = 0; c < 3; ++c) ASSERT_GT(table.Raw(c, bin), 0.0);
        if (bin % 20011 != 0) continue;
        ++checked;
        const Eigen::Vector3d cube =
            ToUnitCube(MerlThetaH(i), MerlThetaD(j), MerlPhiD(k));
        for (int c = 0; c < 3; ++c) {
          const double expected = Expected(cube, c);
          EXPECT_NEAR(expected, table.Raw(c, bin), kFloatLogDensity * expected);
        }
      }
    }
  }
  EXPECT_GT(below, 0);
  EXPECT_GT(checked, 20);
}

TEST_F(LobeModelTest, ColourIsAnExactFactor) {
  const BrdfGrid one = Combined(parameters_);
  std::vector<double> doubled = parameters_;
  for (const int at : {5, 12}) doubled[at] += std::log(2.0);  // green
  const BrdfGrid two = Combined(doubled);
  for (int node = 0; node < kGrid.num_nodes(); ++node) {
    EXPECT_EQ(one.Channel(0)[node], two.Channel(0)[node]);
    EXPECT_EQ(one.Channel(2)[node], two.Channel(2)[node]);
    // One rounding each of the colour and of the sum.
    EXPECT_NEAR(2.0 * one.Channel(1)[node], two.Channel(1)[node],
                4e-7 * two.Channel(1)[node]);
  }
}

TEST_F(LobeModelTest, ColoursBeyondTheLargestAreClamped) {
  std::vector<double> large = parameters_, larger = parameters_;
  for (const int at : {4, 5, 6, 11, 12, 13}) {
    large[at] = kMaxLogColour;
    larger[at] = 1000.0;
  }
  EXPECT_EQ(Combined(large).values, Combined(larger).values);
  for (const float v : Combined(larger).values) EXPECT_TRUE(std::isfinite(v));
}

// Shapes are clamped at e^80: nodes where they are have no derivative.
TEST_F(LobeModelTest, ShapesBeyondTheLargestHaveNoDerivative) {
  NeuralBrdfModel model = TinyModel(1, 3, 4.0f);
  model.exponent = 200.0;
  const FlowLobes lobes(model, 1, kGrid, 1);
  const std::vector<double> p = {0.3, -0.4, 0.2, 0.1, 4.0, 4.0, 4.0};
  std::vector<float> fields, exact;
  lobes.Tabulate(p.data(), true, &fields);
  lobes.TabulateReference(p.data(), true, &exact);
  const float largest = static_cast<float>(std::exp(80.0));
  const size_t n = kGrid.num_nodes();
  int clamped = 0, free = 0;
  for (const std::vector<float>& f : {fields, exact}) {
    for (size_t i = 0; i < n; ++i) {
      double size = 0.0;
      for (size_t d = 1; d <= 4; ++d) size += std::abs(f[d * n + i]);
      if (f[i] == largest) {
        ++clamped;
        EXPECT_EQ(0.0, size) << i;
      } else if (f[i] > 1e-20f) {
        ++free;
        EXPECT_GT(size, 0.0) << i;
      }
    }
  }
  EXPECT_GT(clamped, 20);
  EXPECT_GT(free, 20);
}

TEST_F(LobeModelTest, IsFiniteForExtremeCodesColoursAndWeights) {
  // Weights 50 times the trainer's start drive the splines to their limits.
  const FlowLobes wild(TinyModel(1, 3, 50.0f), 2, kGrid, 1);
  for (const FlowLobes* lobes : {&lobes_, &wild}) {
    for (const double code : {0.0, 0.5, 1.0, -30.0, 1e4}) {
      for (const double colour : {-1e3, -30.0, 0.0, 40.0, 1e3}) {
        std::vector<double> p(14, code);
        for (const int at : {4, 5, 6, 11, 12, 13}) p[at] = colour;
        std::vector<float> fields;
        lobes->Tabulate(p.data(), true, &fields);
        for (const float v : fields) {
          ASSERT_TRUE(std::isfinite(v)) << code << " " << colour;
        }
        for (const float v : lobes->Combine(p.data(), fields, 5).values) {
          ASSERT_TRUE(std::isfinite(v) && v >= 0.0f) << code << " " << colour;
        }
      }
    }
  }
}

TEST_F(LobeModelTest, ThreadsDoNotChangeBits) {
  const FlowLobes many(model_, 2, kGrid, 2);
  std::vector<float> a, b;
  lobes_.Tabulate(parameters_.data(), true, &a);
  many.Tabulate(parameters_.data(), true, &b);
  EXPECT_EQ(a, b);
  EXPECT_EQ(lobes_.ToMerl(parameters_.data()).raw,
            many.ToMerl(parameters_.data()).raw);
}

// A sum of lobes, and the same beside a Lambertian one.
class LambertianLobeTest : public LobeModelTest {
 protected:
  std::vector<double> With(double log_colour) const {
    std::vector<double> p = parameters_;
    p.insert(p.end(), {log_colour, log_colour + 0.3, log_colour - 0.2});
    return p;
  }
  const FlowLobes with_{model_, lobes_.layout().WithLambertian(), kGrid, 1};
};

TEST_F(LambertianLobeTest, IsOneFieldOfOnesWithoutDerivatives) {
  EXPECT_EQ(3, with_.num_lobes());
  EXPECT_EQ(17, with_.num_parameters());
  EXPECT_EQ(11, with_.num_fields());
  const size_t n = kGrid.num_nodes();
  std::vector<float> fast, slow, without;
  for (const bool derivatives : {false, true}) {
    with_.Tabulate(With(2.0).data(), derivatives, &fast);
    with_.TabulateReference(With(2.0).data(), derivatives, &slow);
    lobes_.Tabulate(parameters_.data(), derivatives, &without);
    ASSERT_EQ(n * (derivatives ? 11 : 3), fast.size());
    ASSERT_EQ(fast.size(), slow.size());
    ASSERT_EQ(fast.size(), without.size() + n);
    for (size_t i = 0; i < fast.size(); ++i) {
      const bool of_flow = i < without.size();
      EXPECT_EQ(of_flow ? without[i] : 1.0f, fast[i]);
      if (!of_flow) {
        EXPECT_EQ(1.0f, slow[i]);
      }
    }
  }
}

TEST_F(LambertianLobeTest, AddsItsColourEverywhere) {
  const std::vector<double> p = With(2.0);
  const BrdfGrid grid = with_.Grid(p.data()), without = Combined(parameters_);
  const MerlTable table = with_.ToMerl(p.data());
  const MerlTable table_without = lobes_.ToMerl(parameters_.data());
  for (int c = 0; c < 3; ++c) {
    const double raw = std::exp(p[14 + c]), colour = raw * kMerlScale[c];
    for (int i = 0; i < kGrid.num_nodes(); ++i) {
      const double expected = without.Channel(c)[i] + colour;
      EXPECT_NEAR(expected, grid.Channel(c)[i], 1e-6 * expected);
    }
    for (int bin = 0; bin < kMerlBins; bin += 97) {
      const double before = table_without.Raw(c, bin);
      const double expected = before < 0.0 ? before : before + raw;
      EXPECT_NEAR(expected, table.Raw(c, bin), 1e-12 * std::abs(expected));
    }
  }
}

TEST_F(LambertianLobeTest, IsNothingWhereItsColourIsVeryDark) {
  const BrdfGrid without = Combined(parameters_);
  for (const double dark : {-60.0, -1e3, -1e300}) {
    const BrdfGrid grid = with_.Grid(With(dark).data());
    EXPECT_EQ(without.values, grid.values);
    EXPECT_EQ(lobes_.ToMerl(parameters_.data()).raw,
              with_.ToMerl(With(dark).data()).raw);
  }
}

}  // namespace
}  // namespace ibrdf
