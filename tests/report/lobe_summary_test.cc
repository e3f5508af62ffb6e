#include "ibrdf/solvers/report/lobe_summary.h"

#include <gtest/gtest.h>

#include <cmath>

#include "tests/support/tiny_model.h"

namespace ibrdf {
namespace {

// Two lobes of four code entries and three log colours.
struct TwoLobes {
  TwoLobes() {
    inverse.model = std::make_shared<const NeuralBrdfModel>(TinyModel(1));
    solution.lobe_parameters = {0.3,  -0.4, 0.2, 0.1,  4.0, 4.3, 3.8,
                                -0.5, 0.1,  0.3, -0.2, 3.0, 2.5, 3.3};
  }
  InverseProblem inverse;
  Solution solution;
};

TEST(SummariseLobes, ColoursAreRawMerlUnits) {
  const TwoLobes example;
  const std::vector<LobeSummary> lobes =
      SummariseLobes(example.inverse, example.solution);
  ASSERT_EQ(size_t{2}, lobes.size());
  EXPECT_EQ(std::vector<double>({-0.5, 0.1, 0.3, -0.2}), lobes[1].code);
  EXPECT_DOUBLE_EQ(std::exp(4.0), lobes[0].colour[0]);
  EXPECT_DOUBLE_EQ(std::exp(3.3), lobes[1].colour[2]);
  EXPECT_FALSE(lobes[0].deviation.has_value());
}

TEST(SummariseLobes, DeviationsAreTheDiagonalOfTheCovariance) {
  TwoLobes example;
  example.solution.lobe_covariance.assign(14 * 14, 0.001);
  for (size_t i = 0; i < 14; ++i) {
    const double deviation = 0.1 * (1.0 + static_cast<double>(i));
    example.solution.lobe_covariance[15 * i] = deviation * deviation;
  }
  const std::vector<LobeSummary> lobes =
      SummariseLobes(example.inverse, example.solution);
  ASSERT_EQ(size_t{2}, lobes.size());
  ASSERT_TRUE(lobes[1].deviation.has_value());
  ASSERT_EQ(size_t{4}, lobes[1].deviation->code.size());
  EXPECT_NEAR(0.8, lobes[1].deviation->code[0], 1e-12);
  EXPECT_NEAR(0.5, lobes[0].deviation->log_colour[0], 1e-12);
  EXPECT_NEAR(1.4, lobes[1].deviation->log_colour[2], 1e-12);
}

TEST(SummariseLobes, AKnownReflectanceHasNone) {
  const InverseProblem inverse;
  EXPECT_TRUE(SummariseLobes(inverse, Solution()).empty());
}

}  // namespace
}  // namespace ibrdf
