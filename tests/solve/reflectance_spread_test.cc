#include "ibrdf/solvers/solve/reflectance_spread.h"

#include <gtest/gtest.h>

#include <cmath>
#include <limits>

#include "ibrdf/brdf/flow_lobes.h"
#include "ibrdf/metrics/brdf_metrics.h"
#include "tests/support/solver_testing.h"

namespace ibrdf {
namespace {
using namespace testing;  // NOLINT

constexpr int kDraws = 400;

class ReflectanceSpreadTest : public ::testing::Test {
 protected:
  explicit ReflectanceSpreadTest(int num_lobes = 2)
      : model_(SmoothTinyModel(2)),
        distance_(FlowLobes::Factory(model_, num_lobes, 1)),
        parameters_(TinyLobes()) {
    parameters_.resize(distance_.lobes().num_parameters());
  }
  std::vector<double> Diagonal(double code, double colour) const {
    const size_t n = parameters_.size(), size = distance_.lobes().lobe_size();
    const size_t codes = distance_.lobes().code_size();
    std::vector<double> covariance(n * n, 0.0);
    for (size_t i = 0; i < n; ++i) {
      covariance[i * n + i] = i % size < codes ? code : colour;
    }
    return covariance;
  }
  double Spread(const std::vector<double>& covariance,
                bool level_known = false) const {
    return (level_known ? KnownLightSpread : ReflectanceSpread)(
        distance_, parameters_, covariance, kDraws, 1);
  }

  NeuralBrdfModel model_;
  LobeDistance distance_;
  std::vector<double> parameters_;
};

class OneLobe : public ReflectanceSpreadTest {
 protected:
  OneLobe() : ReflectanceSpreadTest(1) {}
};

// The slow reference: all bins of the tables.
TEST_F(ReflectanceSpreadTest, DistanceIsTheMetricsOfTables) {
  const FlowLobes lobes(model_, 2, {4, 4, 2}, 1);
  const MerlTable at = lobes.ToMerl(parameters_.data());
  for (const double step : {0.05, 0.3, 0.8}) {
    std::vector<double> other = parameters_;
    for (size_t i = 0; i < other.size(); ++i) {
      other[i] += step * std::sin(3.0 * static_cast<double>(i) + 1.0);
    }
    const BrdfMetrics table = *CompareBrdfs(lobes.ToMerl(other.data()), at);
    const std::vector<double> there = distance_.LogValues(other);
    const std::vector<double> here = distance_.LogValues(parameters_);
    EXPECT_NEAR(table.log_rmse_aligned, distance_.Aligned(there, here),
                0.05 * table.log_rmse_aligned)
        << step;
    EXPECT_NEAR(table.log_rmse, distance_.WithLevel(there, here),
                0.05 * table.log_rmse)
        << step;
  }
}

TEST_F(ReflectanceSpreadTest, NothingUnknownIsNoSpread) {
  EXPECT_NEAR(0.0, Spread(Diagonal(0.0, 0.0)), 1e-6);
}

// To first order the squares are a trace: of the distance's derivatives, here
// by differences, and the covariance.
TEST_F(ReflectanceSpreadTest, SmallCovariancesSpreadByTheDerivatives) {
  constexpr double kVariance = 1e-4, kStep = 1e-2;
  double trace = 0.0;
  for (size_t i = 0; i < parameters_.size(); ++i) {
    std::vector<double> up = parameters_, down = parameters_;
    up[i] += kStep;
    down[i] -= kStep;
    const double d =
        distance_.Aligned(distance_.LogValues(up), distance_.LogValues(down)) /
        (2.0 * kStep);
    trace += kVariance * d * d;
  }
  const double spread = Spread(Diagonal(kVariance, kVariance));
  // 400 draws of a sum of some independent squares.
  EXPECT_NEAR(std::sqrt(trace), spread, 0.1 * spread);
}

// A colour of the only lobe is a scale, which alignment takes off; but not
// where the level is known.
TEST_F(OneLobe, ColoursOfASingleLobeAreScales) {
  EXPECT_LT(Spread(Diagonal(0.0, 0.5)), 1e-3);
  // The median of chi squared of three channels is 2.366.
  const double median = std::sqrt(0.5 * 2.366 / 3.0);
  EXPECT_NEAR(median, Spread(Diagonal(0.0, 0.5), /*level_known=*/true),
              0.1 * median);
  EXPECT_GT(Spread(Diagonal(0.01, 0.0)), 1e-2);
}

TEST_F(ReflectanceSpreadTest, ExtremesAreFinite) {
  const double wide = Spread(Diagonal(1e6, 1e2));
  EXPECT_TRUE(std::isfinite(wide));
  EXPECT_GT(wide, Spread(Diagonal(0.01, 0.01)));
  // As rounding may leave it.
  std::vector<double> indefinite = Diagonal(0.01, 0.01);
  indefinite[0] = -1e-9;
  EXPECT_TRUE(std::isfinite(Spread(indefinite)));
  indefinite[0] = std::numeric_limits<double>::infinity();
  EXPECT_TRUE(std::isnan(Spread(indefinite)));
}

TEST(ExpectError, PosteriorsAreTooSure) {
  const ErrorToExpect error = ExpectError(0.5);
  EXPECT_GT(error.median, 0.5);
  EXPECT_GT(error.most, error.median);
  EXPECT_GT(ExpectError(0.6).most, error.most);
  EXPECT_EQ(0.0, ExpectError(0.0).most);
}

// What two models disagree in is in the spread already, and what neither
// explains of the image counts.
TEST(ExpectError, AMeanOverTwoModelsIsAsFarOffAsItsResidualsSay) {
  Solution solution;
  solution.spread = 0.5;
  solution.structured_misfit = 0.02;
  const auto expected = [&] { return ExpectError(solution, true); };
  solution.models = {{"a", nullptr}};
  EXPECT_EQ(ExpectError(0.5).median, expected().median);
  solution.models.push_back({"b", nullptr});
  EXPECT_NEAR(std::sqrt(0.01 + 0.09 + 0.24 * 0.24), expected().median, 1e-12);
  EXPECT_NEAR(std::sqrt(0.0225 + 0.2025 + 0.72 * 0.72), expected().most, 1e-12);
  solution.structured_misfit = 0.0;
  EXPECT_LT(expected().median, ExpectError(0.5).median);
  EXPECT_LT(expected().median, expected().most);
  // A small spread says little.
  solution.spread = 0.01;
  EXPECT_GT(expected().median, ExpectError(0.01).median);
}

// What the model cannot explain of the image is off in the BRDF too, however
// sure the posterior is.
TEST(ExpectError, UnderAKnownLightWhatIsNotExplainedCounts) {
  Solution solution;
  solution.spread = 0.1;
  solution.structured_misfit = 0.0;
  const double explained = ExpectError(solution, false).median;
  EXPECT_LT(explained, ExpectError(0.1).median);
  solution.structured_misfit = 0.04;
  EXPECT_GT(ExpectError(solution, false).median, 2.0 * explained);
  EXPECT_GT(ExpectError(solution, false).most,
            ExpectError(solution, false).median);
  // It does not matter how many models were searched.
  const double unexplained = ExpectError(solution, false).median;
  solution.models = {{"a", nullptr}, {"b", nullptr}};
  EXPECT_EQ(unexplained, ExpectError(solution, false).median);
}

}  // namespace
}  // namespace ibrdf
