// The light alone, by the methods that take it on.
#include <gtest/gtest.h>

#include <cmath>
#include <memory>

#include "ibrdf/solvers/illumination/process_illumination.h"
#include "ibrdf/solvers/joint/joint_method.h"
#include "tests/joint/joint_testing.h"

namespace ibrdf {
namespace {
using namespace testing;  // NOLINT

constexpr JointMethod kKnownBrdfMethods[] = {JointMethod::kGaussNewton,
                                             JointMethod::kLbfgs};

class KnownBrdfTest : public ::testing::TestWithParam<bool> {
 protected:
  JointScene scene_{GetParam()};
};

TEST_P(KnownBrdfTest, WithoutObservationsThePriorRules) {
  scene_.observed =
      MakeObservations(std::vector<double>(scene_.observed.radiance.size()));
  ASSERT_EQ(0, scene_.observed.num_valid);
  JointTerms terms = scene_.KnownBrdf();
  terms.light_priors.clear();
  JointMethodOptions options;
  options.max_iterations = 8;
  for (const JointMethod method : kKnownBrdfMethods) {
    JointObjective objective(terms);
    JointState state{{}, scene_.mean};
    EXPECT_EQ(0.0,
              MinimiseJoint(method, &objective, &state, options).end.total());
    EXPECT_EQ(scene_.mean, state.light);
    state.light = scene_.State(0.5).light;
    const JointSummary summary =
        MinimiseJoint(method, &objective, &state, options);
    EXPECT_EQ(0.0, summary.end.likelihood);
    EXPECT_LT(summary.end.total(), 0.02 * summary.start.total())
        << JointMethodName(method);
  }
}

TEST_P(KnownBrdfTest, ExtremePointsAreRefusedOrImproved) {
  const JointTerms terms = scene_.KnownBrdf();
  JointMethodOptions options;
  options.max_iterations = 5;
  for (const JointMethod method : kKnownBrdfMethods) {
    for (const double level : {-200.0, 58.0, 200.0}) {
      const double rgb[3] = {level, level, level};
      JointObjective objective(terms);
      JointState state{{}, scene_.light->ConstantMap(rgb)};
      const JointSummary summary =
          MinimiseJoint(method, &objective, &state, options);
      ASSERT_TRUE(std::isfinite(summary.start.total())) << level;
      EXPECT_LE(summary.end.total(), summary.start.total());
      for (const float v : state.light) EXPECT_TRUE(std::isfinite(v));
    }
  }
}

// One iteration of one conjugate gradient: along -D^-1 g, to the minimum of the
// damped quadratic, g s + 1/2 s (H + D) s, at the first damping of 1; or 0.4^k
// of it where the line search shortened the step k times.
TEST_P(KnownBrdfTest, FirstStepHasTheGaussNewtonLength) {
  JointObjective objective(scene_.KnownBrdf());
  const JointState start{{}, scene_.State(0.05).light};
  JointState end = start;
  JointMethodOptions options;
  options.max_iterations = 1;
  options.max_cg_iterations = 1;
  MinimiseJoint(JointMethod::kGaussNewton, &objective, &end, options);
  objective.Linearise(start);
  const Eigen::VectorXd gradient = objective.gradient();
  const Eigen::VectorXd D = objective.InverseVariance();
  const Eigen::VectorXd s = objective.ToVector(end) - objective.ToVector(start);
  ASSERT_GT(s.norm(), 0.0);
  const Eigen::VectorXd white = s.cwiseProduct(D.cwiseSqrt());
  const Eigen::VectorXd slope = gradient.cwiseQuotient(D.cwiseSqrt());
  // Parameters in float: steps of 0.01 to 1e-5 or better.
  EXPECT_LT((white / white.norm() + slope / slope.norm()).norm(), 1e-4);
  const double best =
      -gradient.dot(s) / (s.dot(objective.Product(s)) + white.squaredNorm());
  const double shortened = std::log(best) / std::log(2.5);
  EXPECT_NEAR(std::round(shortened), shortened, 1e-3) << best;
  EXPECT_GE(shortened, -1e-3);
}

// The cost after so many steps under a Gaussian process.
double CostOfProcess(JointScene* scene, bool precondition, int iterations,
                     int conjugate_gradients) {
  const std::unique_ptr<IlluminationModel> light = MakeProcessIllumination(
      16, 8, LightProcess(), LightHyperparameters::Average(), {});
  JointTerms terms = scene->KnownBrdf();
  terms.illumination = light.get();
  const double zero[3] = {0, 0, 0};
  terms.light_mean.assign(light->num_parameters(), 0.0f);
  terms.light_priors.clear();
  JointObjective objective(terms);
  JointState state{{}, light->ConstantMap(zero)};
  JointMethodOptions options;
  options.max_iterations = iterations;
  options.max_cg_iterations = conjugate_gradients;
  options.cg_forcing = 1e-6;
  options.tolerance = 1e-7;
  options.precondition_light = precondition;
  return MinimiseJoint(JointMethod::kGaussNewton, &objective, &state, options)
      .end.total();
}

TEST(PreconditionedLight, GetsSoonerToTheSameOptimum) {
  JointScene scene(false);
  const double optimum = CostOfProcess(&scene, false, 100, 300);
  EXPECT_NEAR(optimum, CostOfProcess(&scene, true, 100, 300), 1e-3 * optimum);
  const double without = CostOfProcess(&scene, false, 6, 6) - optimum;
  EXPECT_GT(without, 1e-3 * optimum);
  EXPECT_LT(CostOfProcess(&scene, true, 6, 6) - optimum, 0.5 * without);
}

INSTANTIATE_TEST_SUITE_P(Models, KnownBrdfTest, ::testing::Bool(),
                         [](const ::testing::TestParamInfo<bool>& p) {
                           return p.param ? "Unet" : "Free";
                         });

// Mirror-like: a peak of 3 degrees on a map whose texels span 22.
TEST(MirrorLike, FreeTexelsRecoverTheImageAndTheMap) {
  TransportOptions transport_options = TinyTransportOptions();
  transport_options.grid.h = 32;
  const Transport transport(SpherePoints(16), 8, 16, transport_options);
  const LightOperator known = transport.ByLight(
      BrdfGrid::FromFunction(Glossy(0.1, 1.0, 3), transport_options.grid));
  const Image truth = SmoothMap(8, 16);
  std::vector<double> L_o(3 * static_cast<size_t>(transport.num_points()));
  known.Apply(truth.rgb.data(), L_o.data());
  const Observations observed = MakeObservations(L_o);
  const std::unique_ptr<IlluminationModel> light = MakeFreeIllumination(16, 8);
  const double zero[3] = {0, 0, 0};
  JointTerms terms;
  terms.observed = &observed;
  terms.likelihood.scale = 0.02;
  terms.known_brdf = &known;
  terms.illumination = light.get();
  terms.light_mean = light->ConstantMap(zero);
  terms.light_sigma = 10.0;  // weak: the image decides
  JointMethodOptions options;
  options.max_iterations = 30;
  options.tolerance = 1e-6;
  std::vector<double> ends;
  for (const JointMethod method : kKnownBrdfMethods) {
    SCOPED_TRACE(JointMethodName(method));
    JointObjective objective(terms);
    JointState state{{}, terms.light_mean};
    const JointSummary summary =
        MinimiseJoint(method, &objective, &state, options);
    EXPECT_LT(summary.end.misfit, summary.start.misfit / 10);
    ends.push_back(summary.end.total());
    // The map itself: over the hemisphere behind the camera, which the sphere
    // reflects away from its rim.
    const std::vector<float> map = objective.MapOf(state);
    double start_error = 0.0, end_error = 0.0;
    for (int r = 0; r < 8; ++r) {
      for (int c = 0; c < 16; ++c) {
        if (MapDirection(r + 0.5, c + 0.5, 8, 16).z() < 0.2) continue;
        for (int k = 0; k < 3; ++k) {
          const double log_truth = std::log(truth.At(c, r)[k]);
          const double d = std::log(map[3 * (r * 16 + c) + k]) - log_truth;
          start_error += log_truth * log_truth;
          end_error += d * d;
        }
      }
    }
    EXPECT_LT(end_error, start_error / 25);  // log error by 5
  }
  // Both minimise one objective; in as many passes L-BFGS ends higher.
  EXPECT_LT(ends[1], 2.0 * ends[0]);
  EXPECT_LT(ends[0], 2.0 * ends[1]);
}

// Light that is no part of the map (TransportOptions::bright) is in the
// radiance, not in its derivatives.
TEST(BrightLight, TangentsAreThoseOfTheMapAlone) {
  TransportOptions options = TinyTransportOptions();
  options.bright = {{Eigen::Vector3d(0.4, 0.5, 0.8).normalized(),
                     Eigen::Array3d(5.0, 3.0, 1.0)}};
  const Transport transport(SpherePoints(8), 8, 16, options);
  const LightOperator known = transport.ByLight(
      BrdfGrid::FromFunction(Glossy(0.3, 0.5, 20), options.grid));
  const Observations observed =
      MakeObservations(std::vector<double>(3 * transport.num_points(), 1.0));
  const std::unique_ptr<IlluminationModel> light = MakeFreeIllumination(16, 8);
  const double zero[3] = {0, 0, 0};
  JointTerms terms;
  terms.observed = &observed;
  terms.likelihood.scale = 0.1;
  terms.known_brdf = &known;
  terms.illumination = light.get();
  terms.light_mean = light->ConstantMap(zero);
  JointObjective objective(terms);
  const JointState at{{}, terms.light_mean};
  const Eigen::VectorXd v = RandomDirection(objective, 5);
  const double step = 1e-2;
  objective.Evaluate(objective.Moved(at, v, step));
  std::vector<double> slope = objective.radiance();
  objective.Evaluate(objective.Moved(at, v, -step));
  for (size_t i = 0; i < slope.size(); ++i) {
    slope[i] = (slope[i] - objective.radiance()[i]) / (2.0 * step);
  }
  objective.Linearise(at);
  std::vector<double> by_map(slope.size());
  known.ApplyLinear(objective.map().data(), by_map.data());
  const Eigen::VectorXd tangent = objective.RadianceJvp(v);
  double bright = 0.0, all = 0.0;
  for (size_t i = 0; i < slope.size(); ++i) {
    // Differences of float maps.
    EXPECT_NEAR(slope[i], tangent[i], 2e-3 * tangent.cwiseAbs().maxCoeff());
    bright += objective.radiance()[i] - by_map[i];
    all += objective.radiance()[i];
  }
  EXPECT_GT(bright, 0.1 * all);
  // The transpose of the tangent.
  const Eigen::VectorXd adjoint = Eigen::VectorXd::LinSpaced(
      static_cast<Eigen::Index>(slope.size()), -1.0, 1.0);
  const double forward = adjoint.dot(tangent);
  EXPECT_NEAR(forward, objective.RadianceVjp(adjoint).dot(v),
              1e-5 * std::abs(forward));
}

}  // namespace
}  // namespace ibrdf
