#include "ibrdf/solvers/table_fit/lobe_table_fit.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <limits>
#include <tuple>
#include <vector>

#include "ibrdf/brdf/flow_lobes.h"
#include "ibrdf/metrics/brdf_metrics.h"
#include "ibrdf/solvers/bench/neural_fitters.h"
#include "ibrdf/solvers/costs/log_table_cost.h"
#include "ibrdf/solvers/table_fit/table_columns.h"
#include "tests/support/solver_testing.h"

namespace ibrdf {
namespace {

constexpr BrdfGridShape kNoGrid{2, 2, 1};

MerlTable TableOf(const NeuralBrdfModel& model,
                  const std::vector<double>& parameters) {
  return FlowLobes(
             model,
             LobeLayout::OfSize(parameters.size(), model.shape.code_size()),
             kNoGrid, 1)
      .ToMerl(parameters.data());
}

// Some columns of the cube with their faces, and random targets.
TableColumns SmallTable() {
  TableColumns table;
  table.points = FlowColumns(5, 4);
  for (int c = 0; c < 5; ++c) {
    table.points.SetColumn(c, 0.25 * c, 0.19 * c);
    for (int i = 0; i < 4; ++i) {
      table.points.x_h[i * 5 + c] = static_cast<float>(i) / 3.0f;
    }
  }
  for (int i = 0; i < 60; ++i) {
    table.log_raw.push_back(std::sin(1.7f * static_cast<float>(i)) + 3.0f);
  }
  return table;
}

// The log colour of the second lobe, and whether it is Lambertian.
class LogTableCostTest
    : public ::testing::TestWithParam<std::tuple<double, bool>> {};

TEST_P(LogTableCostTest, JacobianMatchesDifferences) {
  // The share of the column's largest entry; float kernels against Ridders'
  // differences.
  constexpr double kTolerance = 2e-3;
  const NeuralBrdfModel model = SmoothTinyModel(2);
  const auto flow = BrdfFlow::Create(model.shape, model.weights);
  const TableColumns table = SmallTable();
  const auto [colour, lambertian] = GetParam();
  // A floor among the values, so that its share matters.
  const LogTableCost cost(*flow, {2, 4, lambertian}, 1.5, table, 0.3, 2.0, 1);
  ASSERT_EQ(60, cost.num_residuals());
  // Far below the floor the second lobe vanishes.
  std::vector<double> at = {0.3, -0.4, 0.2, 0.1, 0.5, 0.3, -0.8};
  if (!lambertian) at.insert(at.end(), {-0.5, 0.1, 0.3, -0.2});
  at.insert(at.end(), 3, colour);
  const int n = static_cast<int>(at.size());
  const auto evaluate = [&](const std::vector<double>& p, double* jacobian) {
    std::vector<double> r(60);
    const double* block = p.data();
    EXPECT_TRUE(cost.Evaluate(&block, r.data(),
                              jacobian == nullptr ? nullptr : &jacobian));
    return r;
  };
  std::vector<double> jacobian(60 * n);
  const std::vector<double> with = evaluate(at, jacobian.data());
  const std::vector<double> without = evaluate(at, nullptr);
  for (int i = 0; i < 60; ++i) EXPECT_EQ(with[i], without[i]);
  for (int k = 0; k < n; ++k) {
    const std::vector<double> numeric = testing::Differentiate(
        [&](double t) {
          std::vector<double> p = at;
          p[k] += t;
          return evaluate(p, nullptr);
        },
        0.05);
    double scale = 1e-3;
    for (const double v : numeric) scale = std::max(scale, std::abs(v));
    for (int i = 0; i < 60; ++i) {
      EXPECT_NEAR(numeric[i], jacobian[i * n + k], kTolerance * scale)
          << "parameter " << k << " residual " << i;
    }
  }
}
INSTANTIATE_TEST_SUITE_P(Colours, LogTableCostTest,
                         ::testing::Combine(::testing::Values(0.4, 6.0, -40.0,
                                                              -1000.0),
                                            ::testing::Bool()));

TEST(LogTableCost, ExtremeColoursStayFiniteAndInfiniteOnesAreRefused) {
  const NeuralBrdfModel model = TinyModel(2);
  const auto flow = BrdfFlow::Create(model.shape, model.weights);
  const TableColumns table = SmallTable();
  const LogTableCost cost(*flow, {1, 4}, 1.0, table, 1e-6, 1.0, 1);
  std::vector<double> r(60), jacobian(60 * 7);
  double* j = jacobian.data();
  for (const double colour : {-1e4, -30.0, 700.0, 1e4}) {
    const std::vector<double> p = {1.0, 1.0, -1.0, 1.0, colour, colour, colour};
    const double* block = p.data();
    ASSERT_TRUE(cost.Evaluate(&block, r.data(), &j));
    for (const double v : r) EXPECT_TRUE(std::isfinite(v)) << colour;
    for (const double v : jacobian) EXPECT_TRUE(std::isfinite(v)) << colour;
  }
  const double inf = std::numeric_limits<double>::infinity();
  const std::vector<double> p = {0.1, 0.1, 0.1, 0.1, inf, 0.0, 0.0};
  const double* block = p.data();
  EXPECT_FALSE(cost.Evaluate(&block, r.data(), nullptr));
}

class LobeTableFitTest : public ::testing::Test {
 protected:
  const NeuralBrdfModel model_ = SmoothTinyModel(6);
  const LobeTableFitter fitter_{model_};
  LobeTableFitOptions options_;

  LobeTableFitTest() {
    options_.num_threads = 1;
    options_.prior_sigma = 5.0;
  }
  double Score(const MerlTable& table, int lobes) {
    options_.lobes = lobes;
    const StatusOr<LobeTableFit> fit = fitter_.Fit(table, options_);
    EXPECT_TRUE(fit.ok()) << fit.status().message();
    return CompareBrdfs(TableOf(model_, fit->parameters), table)->log_rmse;
  }
};

TEST_F(LobeTableFitTest, FindsOneLobeThatIsNoneOfTheEmbedding) {
  const MerlTable table =
      TableOf(model_, {0.35, -0.2, 0.25, -0.3, 4.0, 3.0, 2.0});
  // Its nearest code is off by more than a tenth; the prior pulls a little.
  EXPECT_LT(Score(table, 1), 0.02);
}

TEST_F(LobeTableFitTest, TwoLobesOfDifferentHueNeedTwo) {
  const MerlTable table =
      TableOf(model_, {0.5, -0.5, 0.3, 0.1, 5.0, 2.0, 1.0,  //
                       -0.4, 0.4, -0.2, 0.3, 1.0, 2.0, 4.0});
  const double one = Score(table, 1), two = Score(table, 2);
  EXPECT_LT(two, 0.05);
  EXPECT_GT(one, 2 * two);
}

// What a Lambertian lobe is for: a white standard, and a lobe of the flow on a
// matte body, neither of which the flow has.
TEST_F(LobeTableFitTest, LambertianLobeHoldsWhatIsMatte) {
  options_.lambertian = true;
  for (const double gloss : {-20.0, 3.0}) {
    const std::vector<double> truth = {0.35,  -0.2,  0.25, -0.3, gloss,
                                       gloss, gloss, 4.5,  4.0,  3.0};
    const MerlTable table = TableOf(model_, truth);
    EXPECT_LT(Score(table, 1), 0.01) << gloss;
    options_.lambertian = false;
    EXPECT_GT(Score(table, 1), 0.03) << gloss;
    options_.lambertian = true;
  }
}

// From a fit without the lobe: its own lobes stay the first ones.
TEST_F(LobeTableFitTest, LambertianLobeIsAddedToAFit) {
  const MerlTable table =
      TableOf(model_, {0.35, -0.2, 0.25, -0.3, 3.0, 3.0, 3.0, 3.2, 3.1, 3.0});
  options_.lobes = 1;
  const StatusOr<LobeTableFit> flow = fitter_.Fit(table, options_);
  ASSERT_TRUE(flow.ok());
  const StatusOr<LobeTableFit> both =
      fitter_.AddLambertian(table, *flow, options_);
  ASSERT_TRUE(both.ok());
  ASSERT_EQ(10u, both->parameters.size());
  EXPECT_LT(both->log_rmse, 0.5 * flow->log_rmse);
  MerlTable broken = table;
  std::fill(broken.raw.begin(), broken.raw.end(),
            std::numeric_limits<double>::quiet_NaN());
  EXPECT_EQ(StatusCode::kInvalidInput,
            fitter_.AddLambertian(broken, *flow, options_).status().code());
}

// Its log colours do not run away, and the fit is none the worse.
TEST_F(LobeTableFitTest, LambertianLobeIsHarmlessWhereNothingIsMatte) {
  const MerlTable table =
      TableOf(model_, {0.35, -0.2, 0.25, -0.3, 4.0, 3.0, 2.0});
  options_.lambertian = true;
  options_.lobes = 1;
  const StatusOr<LobeTableFit> fit = fitter_.Fit(table, options_);
  ASSERT_TRUE(fit.ok());
  ASSERT_EQ(10u, fit->parameters.size());
  EXPECT_LT(CompareBrdfs(TableOf(model_, fit->parameters), table)->log_rmse,
            0.02);
  for (int c = 0; c < 3; ++c) {
    EXPECT_LT(fit->parameters[7 + c], fit->parameters[4 + c] - 2.0);
    EXPECT_GT(fit->parameters[7 + c], -20.0);
  }
}

TEST(LogTableCost, BinsThatWereNotMeasuredCostNothing) {
  const NeuralBrdfModel model = TinyModel(2);
  const auto flow = BrdfFlow::Create(model.shape, model.weights);
  TableColumns table = SmallTable();
  const LogTableCost cost(*flow, {1, 4}, 1.0, table, 1e-6, 1.0, 1);
  const std::vector<double> p = {0.3, -0.4, 0.2, 0.1, 0.5, 0.3, -0.8};
  const double* block = p.data();
  std::vector<double> all(60), some(60), jacobian(60 * 7, 1.0);
  double* j = jacobian.data();
  ASSERT_TRUE(cost.Evaluate(&block, all.data(), nullptr));
  table.log_raw[17] = kNotMeasured;
  ASSERT_TRUE(cost.Evaluate(&block, some.data(), &j));
  for (int i = 0; i < 60; ++i) {
    EXPECT_EQ(i == 17 ? 0.0 : all[i], some[i]);
    double largest = 0.0;
    for (int k = 0; k < 7; ++k) {
      largest = std::max(largest, std::abs(jacobian[7 * i + k]));
    }
    EXPECT_EQ(i == 17, largest == 0.0) << i;
  }
}

// A third of the bins is void; elsewhere the table is a model's.
TEST_F(LobeTableFitTest, VoidBinsPlayNoPart) {
  const MerlTable table =
      TableOf(model_, {0.35, -0.2, 0.25, -0.3, 4.0, 3.0, 2.0});
  MerlTable part = table;
  for (size_t i = 0; i < part.raw.size(); i += 3) part.raw[i] = -1.0;
  for (const bool lambertian : {false, true}) {
    options_.lambertian = lambertian;
    options_.lobes = 1;
    const StatusOr<LobeTableFit> fit = fitter_.Fit(part, options_);
    ASSERT_TRUE(fit.ok());
    EXPECT_LT(CompareBrdfs(TableOf(model_, fit->parameters), table)->log_rmse,
              0.02);
    EXPECT_LT(fit->log_rmse, 0.02);
  }
  // No value in one channel.
  std::fill(part.raw.begin() + kMerlBins, part.raw.begin() + 2 * kMerlBins,
            -1.0);
  EXPECT_EQ(StatusCode::kInvalidInput,
            fitter_.Fit(part, options_).status().code());
}

TEST_F(LobeTableFitTest, CodesStayInTheBallAndScoreIsThatOfTheTable) {
  // A flow's table beyond the ball: the fit ends on the sphere.
  const MerlTable table = TableOf(model_, {2.0, -2.0, 1.0, 1.0, 4.0, 4.0, 4.0});
  options_.lobes = 2;
  const StatusOr<LobeTableFit> fit = fitter_.Fit(table, options_);
  ASSERT_TRUE(fit.ok());
  for (int k = 0; k < 2; ++k) {
    double square = 0.0;
    for (int d = 0; d < 4; ++d) {
      square += std::pow(fit->parameters[7 * k + d], 2);
    }
    EXPECT_LE(square, 1.0 + 1e-12);
  }
  // Its own score is over a seventieth of the bins.
  const double full =
      CompareBrdfs(TableOf(model_, fit->parameters), table)->log_rmse;
  EXPECT_NEAR(full, fit->log_rmse, 0.1 * full);
}

// Lobes stand for their table: the same bins, the same fit.
TEST_F(LobeTableFitTest, LogValuesOfLobesFitAsTheirTable) {
  const std::vector<double> lobes = {0.3,  -0.2, 0.1, 0.4,  2.0, 1.5, 1.0,
                                     -0.4, 0.3,  0.2, -0.1, 0.5, 0.9, 1.2};
  std::vector<double> start = lobes;
  for (double& x : start) x += 0.05;
  const std::vector<float> values = fitter_.LogValues(lobes, options_);
  const LobeTableFit by_values = *fitter_.FitLogValues(values, start, options_);
  const LobeTableFit by_table =
      *fitter_.FitFrom(TableOf(model_, lobes), start, options_);
  EXPECT_NEAR(by_table.log_rmse, by_values.log_rmse, 1e-3);
  EXPECT_LT(by_values.log_rmse, 0.02);
  for (size_t i = 0; i < lobes.size(); ++i) {
    EXPECT_NEAR(by_table.parameters[i], by_values.parameters[i], 0.02) << i;
  }
  // One channel brighter by a factor is that channel's log colours moved.
  std::vector<double> brighter = lobes;
  brighter[4] += 0.5;
  brighter[11] += 0.5;
  const std::vector<float> moved = fitter_.LogValues(brighter, options_);
  const size_t bins = values.size() / 3;
  for (size_t i = 0; i < values.size(); ++i) {
    EXPECT_NEAR(values[i] + (i < bins ? 0.5 : 0.0), moved[i], 1e-3) << i;
  }
}

TEST_F(LobeTableFitTest, OptionsOutOfRangeAreRefused) {
  EXPECT_TRUE(LobeTableFitOptions().Check().ok());
  const MerlTable table = TableOf(model_, {0.3, 0.3, 0.3, 0.3, 4.0, 3.0, 2.0});
  options_.prior_sigma = 0.0;
  const Status status = fitter_.Fit(table, options_).status();
  EXPECT_EQ(StatusCode::kInvalidInput, status.code());
  EXPECT_NE(std::string::npos, status.message().find("prior_sigma"));
}

TEST_F(LobeTableFitTest, ThreadsDoNotChangeTheFit) {
  const MerlTable table = TableOf(model_, {0.3, 0.3, 0.3, 0.3, 4.0, 3.0, 2.0});
  options_.lobes = 1;
  const StatusOr<LobeTableFit> one = fitter_.Fit(table, options_);
  options_.num_threads = 2;
  EXPECT_EQ(one->parameters, fitter_.Fit(table, options_)->parameters);
}

TEST_F(LobeTableFitTest, BadTablesAreRefusedAndFloorsAreNot) {
  MerlTable table = TableOf(model_, {0.3, 0.3, 0.3, 0.3, 4.0, 3.0, 2.0});
  MerlTable broken = table;
  std::fill(broken.raw.begin(), broken.raw.end(),
            std::numeric_limits<double>::quiet_NaN());
  const Status status = fitter_.Fit(broken, options_).status();
  EXPECT_EQ(StatusCode::kInvalidInput, status.code());
  EXPECT_EQ(0u, status.message().find("table"));
  MerlTable empty = table;
  std::fill(empty.raw.begin(), empty.raw.end(), -1.0);
  EXPECT_EQ(StatusCode::kInvalidInput,
            fitter_.Fit(empty, options_).status().code());
  // Half of the table on the floor.
  for (int bin = 0; bin < 3 * kMerlBins; bin += 2) {
    table.raw[bin] = std::min(table.raw[bin], 0.0);
  }
  const StatusOr<LobeTableFit> fit = fitter_.Fit(table, options_);
  ASSERT_TRUE(fit.ok());
  for (const double v : fit->parameters) EXPECT_TRUE(std::isfinite(v));
}

TEST_F(LobeTableFitTest, FittersOfTheSweepDoTheSame) {
  const MerlTable table = TableOf(model_, {0.3, 0.3, 0.3, 0.3, 4.0, 3.0, 2.0});
  options_.lobes = 1;
  TableFitContext context;
  context.material = "m";
  context.num_threads = 1;
  const auto flow =
      FlowFitter(std::make_shared<LobeTableFitter>(model_), "tiny", options_);
  EXPECT_EQ("flow", flow->method());
  LobeTableFitOptions matte = options_;
  matte.lambertian = true;
  EXPECT_EQ("flow_lambertian",
            FlowFitter(std::make_shared<LobeTableFitter>(model_), "tiny", matte)
                ->method());
  EXPECT_EQ("1", flow->lobes());
  EXPECT_EQ("tiny", flow->model());
  const StatusOr<FittedTable> fit = flow->Fit(table, context);
  ASSERT_TRUE(fit.ok());
  EXPECT_LT(CompareBrdfs(fit->table, table)->log_rmse, 0.02);

  // A flow of its own reaches the table too; 300 steps are a start.
  FreeFlowOptions free;
  free.shape.triangular = model_.shape.triangular;
  free.shape.triangular.code_size = 3;
  free.steps = 300;
  const auto own = FreeFlowFitter(free);
  EXPECT_EQ("flow_free", own->method());
  const StatusOr<FittedTable> trained = own->Fit(table, context);
  ASSERT_TRUE(trained.ok());
  EXPECT_LT(CompareBrdfs(trained->table, table)->log_rmse, 0.15);
  std::atomic<bool> stop{true};
  context.stop = &stop;
  EXPECT_EQ(StatusCode::kInterrupted, own->Fit(table, context).status().code());
}

}  // namespace
}  // namespace ibrdf
