#include "ibrdf/solvers/joint/joint_method.h"

#include <ceres/problem.h>
#include <gtest/gtest.h>

#include <cmath>
#include <limits>
#include <memory>
#include <string>

#include "ibrdf/solvers/costs/log_radiance_cost.h"
#include "ibrdf/solvers/illumination/natural_noise.h"
#include "tests/joint/joint_testing.h"

namespace ibrdf {
namespace {
using namespace testing;  // NOLINT

constexpr JointMethod kMethods[] = {
    JointMethod::kAlternating, JointMethod::kGaussNewton, JointMethod::kLbfgs,
    JointMethod::kAdam, JointMethod::kTrustRegion};

// Two float renders of one state, by fields and by their sum, over b = 0.1:
// 1e-6 / b of the cost where residuals are large, and as much of each of some
// 300 values where they are small.
constexpr double kRelativeRounding = 1e-4, kAbsoluteRounding = 1e-2;

// The objective from the cost functions of Ceres' problems, which share no
// more than the likelihood of one value with JointObjective.
double CeresCost(const JointScene& scene, const JointTerms& terms, bool unet,
                 const JointState& state) {
  std::vector<double> lobes = state.lobes;
  std::vector<double> light(state.light.begin(), state.light.end());
  ceres::Problem problem;
  const IlluminationUnet network(TiniestUnetOptions(),
                                 NaturalNoise(TiniestUnetOptions()));
  LogMap log_map;
  std::vector<float> map;
  scene.light->Forward(state.light.data(), &log_map);
  log_map.Exp(&map);
  if (unet) {
    problem.AddResidualBlock(
        new LogRadianceCost(&scene.transport, &scene.lobes, &network,
                            &scene.observed, terms.likelihood),
        nullptr, lobes.data(), light.data());
  } else {
    problem.AddResidualBlock(
        new LobeRadianceCost(&scene.transport, &scene.lobes, map,
                             &scene.observed, terms.likelihood),
        nullptr, lobes.data());
  }
  problem.AddResidualBlock(
      new LobePriorCost(scene.lobes.layout(), terms.lobe_prior), nullptr,
      lobes.data());
  problem.AddResidualBlock(
      new WeightPriorCost(terms.light_mean, scene.light->PriorStd(),
                          terms.light_sigma),
      nullptr, light.data());
  double cost = 0.0;
  EXPECT_TRUE(problem.Evaluate({}, &cost, nullptr, nullptr, nullptr));
  ProcessPrior process(8, 16, LightProcess(), LightHyperparameters::Average(),
                       0.0);
  return cost + process.Evaluate(log_map, nullptr);
}

JointMethodOptions ShortOptions() {
  JointMethodOptions options;
  options.max_iterations = 3;
  options.max_cg_iterations = 8;
  options.adam_rounds = 2;
  options.adam_light_steps = 20;
  options.adam_lobe_steps = 10;
  options.adam_light_rate = 0.03;
  return options;
}

class JointMethodTest
    : public ::testing::TestWithParam<std::tuple<JointMethod, bool>> {
 protected:
  JointMethod method() const { return std::get<0>(GetParam()); }
  bool unet() const { return std::get<1>(GetParam()); }
  JointScene scene_{unet()};
};

TEST_P(JointMethodTest, CostNeverRisesAndIsTheOneOfCeresCosts) {
  for (const double away : {0.0, 0.3, 2.0}) {
    JointObjective objective(scene_.Terms());
    const JointState start = scene_.State(away);
    JointState state = start;
    JointMethodOptions options = ShortOptions();
    // Steps that Ceres refuses count.
    if (method() == JointMethod::kTrustRegion) options.max_iterations = 10;
    std::vector<JointIteration> trace;
    options.callback = [&](const JointIteration& i) { trace.push_back(i); };
    const JointSummary summary =
        MinimiseJoint(method(), &objective, &state, options);
    EXPECT_FALSE(summary.stopped);
    EXPECT_EQ(objective.Evaluate(start).total(), summary.start.total());
    EXPECT_LT(summary.end.total(), summary.start.total());
    // The same code at the same state: L_o by one operator or by one render,
    // whose products are the same but may round differently.
    EXPECT_NEAR(objective.Evaluate(state).total(), summary.end.total(),
                1e-5 * summary.end.total());
    const double ceres = CeresCost(scene_, objective.terms(), unet(), state);
    EXPECT_NEAR(ceres, summary.end.total(),
                kRelativeRounding * ceres + kAbsoluteRounding);
    ASSERT_EQ(summary.iterations, static_cast<int>(trace.size()));
    ASSERT_FALSE(trace.empty());
    double before = summary.start.total();
    for (size_t i = 0; i < trace.size(); ++i) {
      EXPECT_EQ(static_cast<int>(i) + 1, trace[i].iteration);
      EXPECT_LE(trace[i].cost.total(), before);
      before = trace[i].cost.total();
    }
  }
}

TEST_P(JointMethodTest, StopsWhenAskedAndOutOfTime) {
  const JointState start = scene_.State(0.3);
  for (const bool by_clock : {false, true}) {
    JointObjective objective(scene_.Terms());
    JointState state = start;
    JointMethodOptions options = ShortOptions();
    if (by_clock) {
      options.seconds = 0.0;
    } else {
      options.should_stop = [] { return true; };
    }
    const JointSummary summary =
        MinimiseJoint(method(), &objective, &state, options);
    EXPECT_TRUE(summary.stopped);
    EXPECT_EQ(0, summary.iterations);
    EXPECT_EQ(start.lobes, state.lobes);
    EXPECT_EQ(start.light, state.light);
  }
  // In the midst: what was reached is kept.
  JointObjective objective(scene_.Terms());
  JointState state = start;
  JointMethodOptions options = ShortOptions();
  int reports = 0;
  options.callback = [&](const JointIteration&) { ++reports; };
  options.should_stop = [&] { return reports >= 1; };
  const JointSummary summary =
      MinimiseJoint(method(), &objective, &state, options);
  EXPECT_TRUE(summary.stopped);
  EXPECT_EQ(1, summary.iterations);
  EXPECT_LE(summary.end.total(), summary.start.total());
}

TEST_P(JointMethodTest, HeldBlocksStayAndTheOthersMove) {
  const JointState start = scene_.State(0.3);
  for (const JointBlocks free : {JointBlocks::kLobes, JointBlocks::kLight}) {
    JointObjective objective(scene_.Terms());
    objective.Free(free);
    JointState state = start;
    const JointSummary summary =
        MinimiseJoint(method(), &objective, &state, ShortOptions());
    EXPECT_EQ(free, objective.free_blocks());
    EXPECT_LT(summary.end.total(), summary.start.total());
    EXPECT_EQ(free == JointBlocks::kLight, start.lobes == state.lobes);
    EXPECT_EQ(free == JointBlocks::kLobes, start.light == state.light);
  }
}

TEST_P(JointMethodTest, EitherBlockMayBeKnown) {
  const JointState start = scene_.State(0.3);
  JointObjective known_brdf(scene_.KnownBrdf());
  JointState light{{}, start.light};
  JointSummary summary =
      MinimiseJoint(method(), &known_brdf, &light, ShortOptions());
  EXPECT_LT(summary.end.total(), summary.start.total());
  EXPECT_TRUE(light.lobes.empty());

  JointObjective known_light(scene_.KnownLight());
  JointState lobes{start.lobes, {}};
  summary = MinimiseJoint(method(), &known_light, &lobes, ShortOptions());
  EXPECT_LT(summary.end.total(), summary.start.total());
  EXPECT_TRUE(lobes.light.empty());
}

INSTANTIATE_TEST_SUITE_P(
    Methods, JointMethodTest,
    ::testing::Combine(::testing::ValuesIn(kMethods), ::testing::Bool()),
    [](const ::testing::TestParamInfo<std::tuple<JointMethod, bool>>& p) {
      return std::string(JointMethodName(std::get<0>(p.param))) +
             (std::get<1>(p.param) ? "_unet" : "_free");
    });

class JointMethods : public ::testing::TestWithParam<bool> {};

TEST_P(JointMethods, AllReachComparableCosts) {
  JointScene scene(GetParam());
  double start = 0.0, least = std::numeric_limits<double>::infinity();
  std::vector<double> ends;
  for (const JointMethod method : kMethods) {
    JointObjective objective(scene.Terms());
    JointState state = scene.State(0.2);
    JointMethodOptions options;
    options.max_iterations = 200;
    options.tolerance = 1e-6;
    options.adam_light_rate = 0.03;
    if (method == JointMethod::kGaussNewton) {
      options.max_cg_iterations = 100;
      options.cg_forcing = 1e-4;
    }
    const JointSummary summary =
        MinimiseJoint(method, &objective, &state, options);
    start = summary.start.total();
    ends.push_back(summary.end.total());
    least = std::min(least, ends.back());
  }
  for (size_t m = 0; m < ends.size(); ++m) {
    SCOPED_TRACE(JointMethodName(kMethods[m]));
    EXPECT_LT(ends[m], start / 6);
    // Free texels have one basin, whose bottom all come within a few percent
    // of. A network's valleys are curved: some are still on their way when
    // their iterations end.
    EXPECT_LT(ends[m], (GetParam() ? 1.3 : 1.1) * least);
  }
}

INSTANTIATE_TEST_SUITE_P(Models, JointMethods, ::testing::Bool(),
                         [](const ::testing::TestParamInfo<bool>& p) {
                           return p.param ? "Unet" : "Free";
                         });

TEST(JointMethodSize, TrustRegionRefusesWhatDoesNotFit) {
  JointScene scene(true);
  JointObjective objective(scene.Terms());
  EXPECT_TRUE(CheckJointMethod(JointMethod::kTrustRegion, objective).ok());
  IlluminationUnetOptions large = TinyUnetOptions();
  large.channels = 16;
  const std::unique_ptr<IlluminationModel> light = MakeUnetIllumination(large);
  ASSERT_GT(light->num_parameters(), kMaxTrustRegionParameters);
  JointTerms terms = scene.Terms();
  terms.illumination = light.get();
  const double zero[3] = {0, 0, 0};
  terms.light_mean = light->ConstantMap(zero);
  JointObjective too_large(std::move(terms));
  const Status refused = CheckJointMethod(JointMethod::kTrustRegion, too_large);
  EXPECT_EQ(StatusCode::kInvalidInput, refused.code());
  EXPECT_NE(std::string::npos, refused.message().find("solver.method"));
  EXPECT_NE(std::string::npos, refused.message().find("2048"));
  for (const JointMethod method : kMethods) {
    if (method == JointMethod::kTrustRegion) continue;
    EXPECT_TRUE(CheckJointMethod(method, too_large).ok());
  }
  // Held, the light takes no room.
  too_large.Free(JointBlocks::kLobes);
  EXPECT_TRUE(CheckJointMethod(JointMethod::kTrustRegion, too_large).ok());
}

}  // namespace
}  // namespace ibrdf
