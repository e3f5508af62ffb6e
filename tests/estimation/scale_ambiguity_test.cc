#include "ibrdf/solvers/estimation/scale_ambiguity.h"

#include <gtest/gtest.h>

#include <cmath>
#include <limits>

#include "ibrdf/brdf/flow_lobes.h"
#include "ibrdf/light/environment_map.h"
#include "tests/support/solver_testing.h"

namespace ibrdf {
namespace {
using namespace testing;  // NOLINT

// The error of log reflectance: the shapes are floats.
constexpr double kRounding = 1e-5;

class LevelGaugeTest : public ::testing::Test {
 protected:
  LevelGaugeTest()
      : model_(TinyModel(3)),
        prior_(JointMaterialPrior(model_, 2, 0.5)),
        gauge_(model_, prior_, 1) {}

  // Lobes between materials, at no level in particular.
  std::vector<double> Parameters() const {
    return {0.3,  -0.4, 0.2, 0.1,  5.0, 4.6, 4.2,
            -0.5, 0.1,  0.3, -0.2, 3.0, 3.5, 3.3};
  }

  NeuralBrdfModel model_;
  MaterialPrior prior_;
  LevelGauge gauge_;
};

TEST_F(LevelGaugeTest, MaterialsAreThereOnAverage) {
  double sum = 0.0, spread = 0.0;
  for (const MaterialPrior::Material& m : prior_.materials) {
    std::vector<double> x(m.parameters.data(),
                          m.parameters.data() + m.parameters.size());
    const double shift = gauge_.Fix(x.data());
    sum += shift;
    spread += std::abs(shift);
  }
  EXPECT_NEAR(0.0, sum, kRounding);
  EXPECT_GT(spread, 100 * kRounding);
}

TEST_F(LevelGaugeTest, ShiftsAllLobesAndChannelsAlike) {
  const std::vector<double> before = Parameters();
  std::vector<double> after = before;
  const double shift = gauge_.Fix(after.data());
  EXPECT_GT(std::abs(shift), 100 * kRounding);
  const FlowLobes lobes(model_, 2, {4, 4, 2}, 1);
  const size_t size = lobes.lobe_size(), codes = lobes.code_size();
  for (size_t i = 0; i < before.size(); ++i) {
    EXPECT_EQ(before[i] + (i % size < codes ? 0.0 : shift), after[i]) << i;
  }
}

TEST_F(LevelGaugeTest, AnyLevelEndsAtTheSameOne) {
  std::vector<double> expected = Parameters();
  gauge_.Fix(expected.data());
  EXPECT_NEAR(0.0, gauge_.Fix(expected.data()), kRounding);
  // Not darker: the floor of the logarithm would then show.
  for (const double level : {-4.0, 0.5, 8.0}) {
    std::vector<double> x = Parameters();
    const FlowLobes lobes(model_, 2, {4, 4, 2}, 1);
    const double shift[3] = {level, level, level};
    lobes.ShiftColours(shift, x.data());
    gauge_.Fix(x.data());
    for (size_t i = 0; i < x.size(); ++i) {
      EXPECT_NEAR(expected[i], x[i], kRounding) << level << " " << i;
    }
  }
}

TEST_F(LevelGaugeTest, BlackAndBlindingLobesStayFinite) {
  for (const double colour : {-1e3, -1e6, 1e3}) {
    std::vector<double> x = Parameters();
    for (const int i : {4, 5, 6, 11, 12, 13}) x[i] = colour;
    EXPECT_TRUE(std::isfinite(gauge_.Fix(x.data()))) << colour;
  }
}

// A map of another hue, and its mean after the gauge's shift.
Image Reddish() {
  Image map = testing::SmoothMap(16, 32);
  for (size_t i = 0; i < map.rgb.size(); i += 3) map.rgb[i] *= 3.0f;
  return map;
}
Eigen::Array3d MeanAfter(SolverGauge gauge, const Image& map) {
  return (MeanRadiance(map).log() - LightGaugeShift(gauge, map)).exp();
}

TEST(LightGauge, PriorsAreLeftAsTheyAre) {
  EXPECT_TRUE((LightGaugeShift(SolverGauge::kPrior, Reddish()) == 0.0).all());
}

TEST(LightGauge, GreyLightKeepsTheLevel) {
  const Image map = Reddish();
  const Eigen::Array3d shift = LightGaugeShift(SolverGauge::kGreyLight, map);
  EXPECT_NEAR(0.0, shift.sum(), 1e-12);
  EXPECT_GT(shift[0], 0.5);  // the red goes to the reflectance
  const Eigen::Array3d mean = MeanAfter(SolverGauge::kGreyLight, map);
  EXPECT_NEAR(mean[0], mean[1], 1e-12 * mean[0]);
  EXPECT_NEAR(mean[0], mean[2], 1e-12 * mean[0]);
  EXPECT_NEAR(MeanRadiance(map).log().mean(), std::log(mean[0]), 1e-12);
}

TEST(LightGauge, UnitsOfRadianceLeaveTheBitsOfGreyLight) {
  const Image map = Reddish();
  const Eigen::Array3d shift = LightGaugeShift(SolverGauge::kGreyLight, map);
  for (const int exponent : {-100, -3, 100}) {
    Image scaled = map;
    for (float& v : scaled.rgb) v = std::ldexp(v, exponent);
    EXPECT_TRUE(
        (LightGaugeShift(SolverGauge::kGreyLight, scaled) == shift).all())
        << exponent;
  }
}

TEST(LightGauge, UnitLightHasMeanOneInAnyUnit) {
  Image map = Reddish();
  for (const float unit : {1e-20f, 1.0f, 1e20f}) {
    Image scaled = map;
    for (float& v : scaled.rgb) v *= unit;
    const Eigen::Array3d mean = MeanAfter(SolverGauge::kUnitLight, scaled);
    EXPECT_LT((mean - 1.0).abs().maxCoeff(), 1e-12) << unit;
  }
}

TEST(LightGauge, LightThatHasNoMeanMovesNothing) {
  Image black = Reddish(), infinite = Reddish();
  for (size_t i = 1; i < black.rgb.size(); i += 3) black.rgb[i] = 0.0f;
  infinite.rgb[5] = std::numeric_limits<float>::infinity();
  for (const Image& map : {black, infinite}) {
    for (const SolverGauge gauge :
         {SolverGauge::kGreyLight, SolverGauge::kUnitLight}) {
      EXPECT_TRUE((LightGaugeShift(gauge, map) == 0.0).all());
    }
  }
}

// 1/2 sum of squared residuals of the prior.
double LobePriorCostValue(const LobeModel& lobes, const LobePrior& prior,
                          const std::vector<double>& parameters) {
  const LobePriorCost cost(lobes.layout(), prior);
  std::vector<double> residuals(cost.num_residuals());
  const double* blocks[] = {parameters.data()};
  cost.Evaluate(blocks, residuals.data(), nullptr);
  double sum = 0.0;
  for (const double r : residuals) sum += r * r;
  return sum / 2;
}

class GaugeShiftTest : public ::testing::Test {
 protected:
  GaugeShiftTest() {
    prior_.sigma = 0.5;
    for (double& m : prior_.colour_mean) m = 4.0;
  }
  // The function that the shift minimises, from the header's words.
  double Value(const std::vector<double>& d) const {
    std::vector<double> p = truth_;
    for (int k = 0; k < 2; ++k) {
      for (int c = 0; c < 3; ++c) p[7 * k + 4 + c] += d[c];
    }
    double sum = LobePriorCostValue(scene_.lobes, prior_, p);
    for (const int c : {0, 2}) {
      const double chroma = (mean_[c] - d[c]) - (mean_[1] - d[1]);
      sum += 0.5 * chroma * chroma / (kLightStd * kLightStd);
    }
    return sum;
  }

  const TinyScene scene_;
  const std::vector<float> map_ = SmoothMap(8, 16).rgb;
  const std::vector<double> truth_ = scene_.Parameters();
  LobePrior prior_;
  static constexpr double kLightStd = 0.3;
  const double mean_[3] = {1.0, 0.2, -2.0};
};

TEST_F(GaugeShiftTest, IsTheMinimiser) {
  const std::vector<double> d =
      GaugeShift(scene_.lobes, prior_, truth_, mean_, kLightStd);
  ASSERT_EQ(size_t{3}, d.size());
  EXPECT_GT(Norm(d), 0.1);
  for (int c = 0; c < 3; ++c) {
    std::vector<double> up = d, down = d;
    up[c] += 0.1;
    down[c] -= 0.1;
    // Quadratic, so central differences are exact.
    EXPECT_NEAR(0.0, (Value(up) - Value(down)) / 0.2, 1e-9);
    EXPECT_GT(Value(up), Value(d));
  }
}

TEST_F(GaugeShiftTest, LeavesTheImageAsItIs) {
  const std::vector<double> d =
      GaugeShift(scene_.lobes, prior_, truth_, mean_, kLightStd);
  std::vector<double> p = truth_;
  std::vector<float> map = map_;
  for (int c = 0; c < 3; ++c) {
    for (int k = 0; k < 2; ++k) p[7 * k + 4 + c] += d[c];
    for (size_t t = c; t < map.size(); t += 3) {
      map[t] *= static_cast<float>(std::exp(-d[c]));
    }
  }
  const std::vector<double> before = scene_.Render(truth_, map_);
  const std::vector<double> after = scene_.Render(p, map);
  // Some roundings of float per term.
  for (size_t i = 0; i < before.size(); ++i) {
    EXPECT_NEAR(before[i], after[i], 2e-6 * before[i]);
  }
}

TEST(SetGauge, MovesTheLightAndAllMaterials) {
  Solution solution;
  solution.map = Reddish();
  const Image before = solution.map;
  MaterialSolution material;
  material.lobe_parameters = {0.1, 1.0, 2.0, 3.0, 0.2, 4.0, 5.0, 6.0};
  material.brdf.raw.assign(size_t{3} * kMerlBins, 2.0);
  material.brdf.raw[7] = -1.0;  // invalid
  material.alternatives = {{"other", 0.0, 0.0, material.lobe_parameters},
                           {"without lobes"}};
  material.slices.resize(1);
  material.slices[0].value.fill({3.0, 4.0});
  material.slices[0].low.fill({1.0});
  material.slices[0].high.fill({9.0});
  solution.materials = {material, material};
  solution.lobe_parameters = material.lobe_parameters;
  solution.brdf = material.brdf;
  solution.alternatives = material.alternatives;
  solution.slices = material.slices;
  const Eigen::Array3d shift = LightGaugeShift(SolverGauge::kUnitLight, before);
  ASSERT_GT(std::abs(shift[0] - shift[2]), 0.1);
  SetGauge(SolverGauge::kUnitLight, 1, &solution);
  for (const MaterialSolution& moved : solution.materials) {
    EXPECT_EQ(solution.lobe_parameters, moved.lobe_parameters);
    EXPECT_EQ(solution.brdf.raw, moved.brdf.raw);
    EXPECT_EQ(-1.0, moved.brdf.raw[7]);
    EXPECT_EQ(moved.lobe_parameters, moved.alternatives[0].lobe_parameters);
    EXPECT_EQ(solution.alternatives[0].lobe_parameters,
              moved.alternatives[0].lobe_parameters);
    EXPECT_TRUE(moved.alternatives[1].lobe_parameters.empty());
    for (int c = 0; c < 3; ++c) {
      EXPECT_NEAR(1.0 + c + shift[c], moved.lobe_parameters[1 + c], 1e-12);
      EXPECT_NEAR(4.0 + c + shift[c], moved.lobe_parameters[5 + c], 1e-12);
      EXPECT_NEAR(2.0 * std::exp(shift[c]),
                  moved.brdf.raw[size_t{kMerlBins} * c + 8], 1e-12);
      EXPECT_NEAR(before.rgb[c] / std::exp(shift[c]), solution.map.rgb[c],
                  1e-5);
      const double factor = std::exp(shift[c]);
      for (const BrdfSlice& slice : {moved.slices[0], solution.slices[0]}) {
        EXPECT_NEAR(4.0 * factor, slice.value[c][1], 1e-12);
        EXPECT_NEAR(1.0 * factor, slice.low[c][0], 1e-12);
        EXPECT_NEAR(9.0 * factor, slice.high[c][0], 1e-12);
      }
    }
  }
}

}  // namespace
}  // namespace ibrdf
