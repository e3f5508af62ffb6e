#include "ibrdf/solvers/estimation/level_gauge.h"

#include <gtest/gtest.h>

#include <cmath>

#include "ibrdf/brdf/flow_lobes.h"
#include "tests/support/solver_testing.h"

namespace ibrdf {
namespace {
using namespace testing;  // NOLINT

// Of log reflectance: the shapes are floats.
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

}  // namespace
}  // namespace ibrdf
