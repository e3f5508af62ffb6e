#include "ibrdf/solvers/estimation/optimum_average.h"

#include <gtest/gtest.h>

#include <cmath>
#include <limits>
#include <memory>
#include <numeric>

#include "ibrdf/metrics/brdf_metrics.h"
#include "tests/solve/ball_problem.h"
#include "tests/support/solver_testing.h"

namespace ibrdf {
namespace {
using namespace testing;  // NOLINT

TEST(OptimumWeights, FallWithCost) {
  const std::vector<double> weights = OptimumWeights({-700.0, -720.0, -700.0});
  EXPECT_NEAR(1.0, std::accumulate(weights.begin(), weights.end(), 0.0), 1e-12);
  EXPECT_NEAR(std::exp(-1.0), weights[0] / weights[1], 1e-12);
  EXPECT_EQ(weights[0], weights[2]);
}

TEST(OptimumWeights, WhatIsFarOffCountsNothing) {
  EXPECT_EQ((std::vector<double>{0.0, 1.0}), OptimumWeights({0.0, -1e6}));
  EXPECT_EQ((std::vector<double>{1.0}), OptimumWeights({1e300}));
  EXPECT_TRUE(OptimumWeights({}).empty());
}

class AverageOptimaTest : public ::testing::Test {
 protected:
  AverageOptimaTest() : problem_(BallProblem(12)), other_(BallProblem(12)) {
    for (InverseProblem* p : {&problem_, &other_}) {
      p->image.rgb.assign(p->image.rgb.size(), 1.0f);
    }
    other_.model =
        std::make_shared<const NeuralBrdfModel>(SmoothTinyModel(4, 7));
    setup_ = std::make_unique<SolveSetup>(ibrdf::SetUp(problem_).value());
    of_other_ = std::make_unique<SolveSetup>(ibrdf::SetUp(other_).value());
  }

  // The optimum at one of the model's materials.
  static MaterialCandidate At(const SolveSetup& setup, int material,
                              double cost) {
    MaterialCandidate candidate;
    const MaterialPrior::Material& m = setup.materials.materials[material];
    candidate.name = m.name;
    candidate.cost = cost;
    candidate.parameters.assign(m.parameters.begin(), m.parameters.end());
    return candidate;
  }

  static ModelOptima Search(const SolveSetup& setup,
                            std::vector<MaterialCandidate> candidates) {
    ModelOptima search;
    search.setup = &setup;
    search.gauge = std::make_shared<const LevelGauge>(*setup.problem->model,
                                                      setup.materials, 1);
    search.estimate.lobes = candidates.front().parameters;
    search.estimate.light.mode = LogMap({4, 2});
    search.estimate.candidates = std::move(candidates);
    return search;
  }

  static MerlTable TableOf(const SolveSetup& setup,
                           const std::vector<double>& lobes) {
    return setup.lobes->ToMerl(lobes.data());
  }
  // Aligned log-RMSE of lobes to a table.
  static double Distance(const SolveSetup& setup,
                         const std::vector<double>& lobes,
                         const MerlTable& table) {
    return CompareBrdfs(TableOf(setup, lobes), table)->log_rmse_aligned;
  }

  static MerlTable GeometricMean(const MerlTable& a, const MerlTable& b) {
    constexpr double kFloor = 1e-6;
    MerlTable mean = a;  // keeps the bins without values
    for (size_t i = 0; i < mean.raw.size(); ++i) {
      if (a.raw[i] < 0.0) continue;
      mean.raw[i] =
          std::sqrt((a.raw[i] + kFloor) * (b.raw[i] + kFloor)) - kFloor;
    }
    return mean;
  }

  InverseProblem problem_, other_;
  std::unique_ptr<SolveSetup> setup_, of_other_;
};

TEST_F(AverageOptimaTest, OneOptimumStaysAsItIs) {
  const MaterialCandidate best = At(*setup_, 0, -800.0);
  const OptimumAverage average =
      AverageOptima({Search(*setup_, {best, At(*setup_, 1, 1000.0)})});
  EXPECT_EQ(best.parameters, average.estimate.lobes);
  EXPECT_EQ(0.0, average.estimate.between_optima);
  EXPECT_EQ((std::vector<double>{1.0}), average.model_weights);
}

TEST_F(AverageOptimaTest, OptimaOfNoFiniteCostDoNotCount) {
  const double infinity = std::numeric_limits<double>::infinity();
  const MaterialCandidate best = At(*setup_, 0, -800.0);
  const MaterialCandidate lost = At(*setup_, 1, infinity);
  EXPECT_EQ(best.parameters,
            AverageOptima({Search(*setup_, {best, lost})}).estimate.lobes);
  const ModelOptima none = Search(*setup_, {lost});
  const OptimumAverage average = AverageOptima({none});
  EXPECT_EQ(none.estimate.lobes, average.estimate.lobes);
  EXPECT_EQ((std::vector<double>{1.0}), average.model_weights);
}

// The lobes are nearer to the mean of the logarithms than either optimum.
TEST_F(AverageOptimaTest, TwoOptimaAreMetHalfway) {
  const MaterialCandidate a = At(*setup_, 0, -800.0);
  const MaterialCandidate b = At(*setup_, 2, -800.0);
  const MerlTable half = GeometricMean(TableOf(*setup_, a.parameters),
                                       TableOf(*setup_, b.parameters));
  const OptimumAverage average = AverageOptima({Search(*setup_, {a, b})});
  const double of_either = Distance(*setup_, a.parameters, half);
  EXPECT_GT(of_either, 0.01);
  EXPECT_LT(Distance(*setup_, average.estimate.lobes, half), 0.5 * of_either);
  // Each is as far from the middle, give or take what the lobes cannot meet.
  EXPECT_NEAR(of_either, average.estimate.between_optima, 0.5 * of_either);
}

TEST_F(AverageOptimaTest, LobesAreOfTheModelWhoseOptimumCostsLeast) {
  const OptimumAverage average =
      AverageOptima({Search(*setup_, {At(*setup_, 0, -800.0)}),
                     Search(*of_other_, {At(*of_other_, 0, -810.0)})});
  EXPECT_EQ(1u, average.model);
  EXPECT_GT(average.model_weights[1], average.model_weights[0]);
  EXPECT_GT(average.model_weights[0], 0.3);
  EXPECT_EQ(static_cast<size_t>(of_other_->lobes->num_parameters()),
            average.estimate.lobes.size());
}

// The slow reference: whole tables of both models. The program looks at some
// thousands of their bins.
TEST_F(AverageOptimaTest, DistanceBetweenOptimaIsThatOfTheirTables) {
  const MaterialCandidate a = At(*setup_, 0, -800.0);
  const MaterialCandidate b = At(*of_other_, 0, -810.0);
  const OptimumAverage average =
      AverageOptima({Search(*setup_, {a}), Search(*of_other_, {b})});
  const MerlTable mean = TableOf(*of_other_, average.estimate.lobes);
  const double squares =
      average.model_weights[0] *
          std::pow(Distance(*setup_, a.parameters, mean), 2) +
      average.model_weights[1] *
          std::pow(Distance(*of_other_, b.parameters, mean), 2);
  EXPECT_GT(squares, 1e-4);
  EXPECT_NEAR(std::sqrt(squares), average.estimate.between_optima,
              0.1 * std::sqrt(squares));
}

// What the reflectance gains by a mean, the light loses.
TEST_F(AverageOptimaTest, ProductOfReflectanceAndLightKeepsItsLevel) {
  const MaterialCandidate a = At(*setup_, 0, -800.0);
  const OptimumAverage average =
      AverageOptima({Search(*setup_, {a, At(*setup_, 2, -800.0)})});
  const MerlTable before = TableOf(*setup_, a.parameters);
  const MerlTable after = TableOf(*setup_, average.estimate.lobes);
  for (int c = 0; c < 3; ++c) {
    double gain = 0.0, count = 0.0;
    for (int bin = 0; bin < kMerlBins; ++bin) {
      if (before.Raw(c, bin) < 0.0) continue;
      gain +=
          std::log((after.Raw(c, bin) + 1e-6) / (before.Raw(c, bin) + 1e-6));
      count += 1.0;
    }
    // The program sums over some thousands of nodes.
    EXPECT_GT(std::abs(gain / count), 0.05);
    EXPECT_NEAR(-gain / count, average.estimate.light.mode.Plane(c)(0, 0), 3e-3)
        << c;
  }
}

}  // namespace
}  // namespace ibrdf
