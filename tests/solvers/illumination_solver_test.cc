#include "solvers/illumination_solver.h"

#include <gtest/gtest.h>

#include <cmath>
#include <memory>
#include <random>

#include "tests/solvers/solver_testing.h"

namespace ibrdf {
namespace {
using namespace testing;  // NOLINT

double SumOfProducts(const std::vector<double>& a,
                     const std::vector<double>& b) {
  double sum = 0.0;
  for (size_t i = 0; i < a.size(); ++i) sum += a[i] * b[i];
  return sum;
}

// A sphere of a glossy BRDF under a smooth map of 16x8.
class IlluminationSolverTest : public ::testing::TestWithParam<bool> {
 protected:
  IlluminationSolverTest() : IlluminationSolverTest(SpherePoints(10), 0.5, 8) {}
  IlluminationSolverTest(const std::vector<ShadingPoint>& points,
                         double specular, double degrees)
      : transport_(points, 8, 16, Options()),
        light_(transport_.ByLight(BrdfGrid::FromFunction(
            Glossy(0.1, specular, degrees), Options().grid))),
        observed_(ObserveMap(SmoothMap(8, 16).rgb)) {}

  static TransportOptions Options() {
    TransportOptions options = TinyTransportOptions();
    options.grid.h = 32;
    return options;
  }
  Observations ObserveMap(const std::vector<float>& map) const {
    std::vector<double> E(3 * static_cast<size_t>(transport_.num_points()));
    light_.Apply(map.data(), E.data());
    return MakeObservations(E);
  }
  static std::unique_ptr<IlluminationModel> MakeModel(bool unet) {
    return unet ? MakeUnetIllumination(TinyUnetOptions())
                : MakeFreeIllumination(16, 8);
  }
  static std::vector<float> Mean(const IlluminationModel& model) {
    const double zero[3] = {0, 0, 0};
    return model.ConstantMap(zero);
  }
  // Away from the mean by `size` standard deviations each.
  static std::vector<float> Perturbed(const IlluminationModel& model,
                                      double size, unsigned seed) {
    std::vector<float> p = Mean(model);
    const std::vector<float> std = model.PriorStd();
    std::mt19937 rng(seed);
    std::normal_distribution<double> gauss;
    // The biases of a map's level have a wide prior: less of it.
    for (size_t i = 0; i < p.size(); ++i) {
      p[i] += static_cast<float>(size * std::min(std[i], 3.0f) * gauss(rng));
    }
    return p;
  }
  IlluminationCost Cost(const IlluminationStepOptions& options,
                        const std::vector<float>& mean, const float* p,
                        IlluminationModel* model,
                        std::vector<double>* E = nullptr) const {
    return EvaluateIllumination(light_, observed_, options, mean, p, model, E,
                                nullptr);
  }
  double Misfit(const std::vector<double>& E) const {
    double sum = 0.0;
    for (size_t i = 0; i < E.size(); ++i) {
      sum += std::abs(std::log(E[i]) - std::log(observed_.radiance[i]));
    }
    return sum / static_cast<double>(E.size());
  }

  const Transport transport_;
  const LightOperator light_;
  Observations observed_;
};

// One step of one conjugate gradient is -alpha D^-1 g, so the step shows the
// gradient up to its length; and alpha = g D^-1 g / (p (H + D) p), p = D^-1 g,
// with the first damping of 1, shows the Gauss-Newton product.
TEST_P(IlluminationSolverTest, FirstStepIsAlongTheNumericGradient) {
  const std::unique_ptr<IlluminationModel> model = MakeModel(GetParam());
  const std::vector<float> mean = Mean(*model);
  const std::vector<float> std = model->PriorStd();
  const size_t n = mean.size();
  IlluminationStepOptions options;
  options.max_iterations = 1;
  options.max_cg_iterations = 1;
  options.likelihood.scale = 0.1;
  options.prior.weight_sigma = 0.8;
  const std::vector<float> start = Perturbed(*model, 0.2, 3);

  std::vector<double> gradient(n);
  std::vector<float> moved = start;
  // Of every parameter of free texels, of every 5th weight.
  const size_t stride = GetParam() ? 5 : 1;
  for (size_t i = 0; i < n; i += stride) {
    const double s = std::min(std[i], 1.0f);
    gradient[i] = Differentiate(
        [&](double t) {
          moved[i] = static_cast<float>(start[i] + t);
          // The step in float is not quite t.
          const double real = static_cast<double>(moved[i]) - start[i];
          const double cost =
              Cost(options, mean, moved.data(), model.get()).total();
          moved[i] = start[i];
          return std::vector<double>{cost * (real != 0.0 ? t / real : 1.0)};
        },
        0.05 * s, 4)[0];
  }
  std::vector<float> end = start;
  SolveIllumination(light_, observed_, options, mean, model.get(), &end);
  std::vector<double> whitened_step(n), whitened_gradient(n);
  for (size_t i = 0; i < n; i += stride) {
    const double sigma = options.prior.weight_sigma * std[i];
    whitened_step[i] = (static_cast<double>(end[i]) - start[i]) / sigma;
    whitened_gradient[i] = gradient[i] * sigma;
  }
  ASSERT_GT(Norm(whitened_step), 0.0);
  const double cosine = SumOfProducts(whitened_step, whitened_gradient) /
                        (Norm(whitened_step) * Norm(whitened_gradient));
  // 1 - cos is half the squared relative error: a gradient to 1 %, which is
  // what float sums leave of a cost of thousands over a step of 0.01.
  EXPECT_LT(cosine, -1 + 0.5 * 0.01 * 0.01);
}

TEST_F(IlluminationSolverTest, FirstStepHasTheGaussNewtonLength) {
  const std::unique_ptr<IlluminationModel> model = MakeModel(false);
  const std::vector<float> mean = Mean(*model);
  const size_t n = mean.size();
  IlluminationStepOptions options;
  options.max_iterations = 1;
  options.max_cg_iterations = 1;
  options.likelihood.scale = 0.1;
  // The robust edges off: what is left of the prior is quadratic.
  options.prior.edge_scale = 0.0;
  const std::vector<float> start = Perturbed(*model, 0.05, 3);
  std::vector<float> end = start;
  SolveIllumination(light_, observed_, options, mean, model.get(), &end);
  // Along the step: slope of the cost, and curvature as Gauss-Newton has it.
  const auto at = [&](double t, std::vector<double>* E) {
    std::vector<float> p(n);
    for (size_t i = 0; i < n; ++i) {
      p[i] = static_cast<float>(start[i] + t * (double{end[i]} - start[i]));
    }
    return Cost(options, mean, p.data(), model.get(), E);
  };
  const double slope = Differentiate(
      [&](double t) { return std::vector<double>{at(t, nullptr).total()}; },
      0.2)[0];
  const std::vector<double> dE = Differentiate(
      [&](double t) {
        std::vector<double> E;
        at(t, &E);
        return E;
      },
      0.2);
  std::vector<double> E;
  const double prior = at(0, &E).prior;
  double curvature = at(1, nullptr).prior + at(-1, nullptr).prior - 2 * prior;
  const RobustLogLikelihood& l = options.likelihood;
  for (size_t i = 0; i < E.size(); ++i) {
    const double e = E[i] + l.epsilon;
    const double t =
        (std::log(e) - std::log(observed_.radiance[i] + l.epsilon)) / l.scale;
    const double dt = dE[i] / (l.scale * e);
    curvature += dt * dt / std::sqrt(t * t + l.delta * l.delta);
  }
  double damping = 0.0;
  for (size_t i = 0; i < n; ++i) {
    const double sigma = options.prior.weight_sigma * model->PriorStd()[i];
    const double s = (double{end[i]} - start[i]) / sigma;
    damping += s * s;
  }
  // The minimum of slope t + 1/2 (curvature + damping) t^2 is at t = 1, or at
  // 1 / 0.4^k where the line search shortened the step k times.
  const double best = -slope / (curvature + damping);
  const double halvings = std::log(best) / std::log(2.5);
  EXPECT_NEAR(std::round(halvings), halvings, 0.01) << best;
  EXPECT_GE(halvings, -0.01);
}

TEST_P(IlluminationSolverTest, CostNeverRisesAndIsTheOneReturned) {
  const std::unique_ptr<IlluminationModel> model = MakeModel(GetParam());
  const std::vector<float> mean = Mean(*model);
  for (const bool lbfgs : {false, true}) {
    for (const double scale : {0.003, 0.2}) {
      for (const double away : {0.0, 0.3, 3.0}) {
        IlluminationStepOptions options;
        options.lbfgs = lbfgs;
        options.max_iterations = 2;
        options.max_cg_iterations = 6;
        options.likelihood.scale = scale;
        std::vector<float> p = Perturbed(*model, away, 5);
        double before = Cost(options, mean, p.data(), model.get()).total();
        for (int round = 0; round < 3; ++round) {
          const IlluminationCost after = SolveIllumination(
              light_, observed_, options, mean, model.get(), &p);
          EXPECT_LE(after.total(), before);
          EXPECT_EQ(Cost(options, mean, p.data(), model.get()).total(),
                    after.total());
          before = after.total();
        }
      }
    }
  }
}

TEST_P(IlluminationSolverTest, ShiftMovesEachChannelByItsOwnAmount) {
  const std::unique_ptr<IlluminationModel> model = MakeModel(GetParam());
  std::vector<float> p = Perturbed(*model, 0.3, 2);
  std::vector<float> before(model->num_outputs()), after = before;
  model->Forward(p.data(), before.data());
  const double shift[3] = {0.5, -2.0, 7.25};
  model->ShiftChannels(shift, p.data());
  model->Forward(p.data(), after.data());
  for (int i = 0; i < model->num_outputs(); ++i) {
    // Two roundings of numbers of size up to 10.
    EXPECT_NEAR(before[i] + shift[i / 128], after[i], 4e-6);
  }
}

TEST_P(IlluminationSolverTest, ConstantMapIsConstant) {
  const std::unique_ptr<IlluminationModel> model = MakeModel(GetParam());
  const double level[3] = {0.5, -2.0, 1.0};
  const std::vector<float> p = model->ConstantMap(level);
  ASSERT_EQ(model->num_parameters(), static_cast<int>(p.size()));
  std::vector<float> map(model->num_outputs());
  model->Forward(p.data(), map.data());
  for (int i = 0; i < model->num_outputs(); ++i) {
    EXPECT_FLOAT_EQ(static_cast<float>(level[i / 128]), map[i]);
  }
}

TEST_P(IlluminationSolverTest, WithoutObservationsThePriorRules) {
  const std::unique_ptr<IlluminationModel> model = MakeModel(GetParam());
  const std::vector<float> mean = Mean(*model);
  observed_ = MakeObservations(std::vector<double>(observed_.radiance.size()));
  ASSERT_EQ(0, observed_.num_valid);
  IlluminationStepOptions options;
  options.max_iterations = 8;
  for (const bool lbfgs : {false, true}) {
    options.lbfgs = lbfgs;
    std::vector<float> p = mean;
    EXPECT_EQ(0.0, SolveIllumination(light_, observed_, options, mean,
                                     model.get(), &p)
                       .total());
    EXPECT_EQ(mean, p);
    p = Perturbed(*model, 0.5, 4);
    const double before = Cost(options, mean, p.data(), model.get()).total();
    const IlluminationCost after =
        SolveIllumination(light_, observed_, options, mean, model.get(), &p);
    EXPECT_EQ(0.0, after.likelihood);
    EXPECT_LT(after.total(), 0.02 * before) << lbfgs;
  }
}

TEST_P(IlluminationSolverTest, ExtremePointsAreRefusedOrImproved) {
  const std::unique_ptr<IlluminationModel> model = MakeModel(GetParam());
  const std::vector<float> mean = Mean(*model);
  for (const double level : {-200.0, 58.0, 200.0}) {
    const double shift[3] = {level, level, level};
    std::vector<float> p = model->ConstantMap(shift);
    IlluminationStepOptions options;
    const double before = Cost(options, mean, p.data(), model.get()).total();
    ASSERT_TRUE(std::isfinite(before)) << level;
    const double after =
        SolveIllumination(light_, observed_, options, mean, model.get(), &p)
            .total();
    EXPECT_LE(after, before);
    for (const float v : p) EXPECT_TRUE(std::isfinite(v));
  }
}

TEST_P(IlluminationSolverTest, StopEndsBeforeTheFirstIteration) {
  const std::unique_ptr<IlluminationModel> model = MakeModel(GetParam());
  const std::vector<float> mean = Mean(*model);
  IlluminationStepOptions options;
  options.should_stop = [] { return true; };
  std::vector<float> p = mean;
  SolveIllumination(light_, observed_, options, mean, model.get(), &p);
  EXPECT_EQ(mean, p);
}

INSTANTIATE_TEST_SUITE_P(Models, IlluminationSolverTest, ::testing::Bool(),
                         [](const ::testing::TestParamInfo<bool>& p) {
                           return p.param ? "Unet" : "Free";
                         });

// Mirror-like: a peak of 3 degrees on a map whose texels span 22.
class MirrorLike : public IlluminationSolverTest {
 protected:
  MirrorLike() : IlluminationSolverTest(SpherePoints(16), 1.0, 3) {
    options_.likelihood.scale = 0.02;
    options_.prior = {10.0, 20.0};  // weak: the image decides
    options_.max_iterations = 30;
    options_.tolerance = 1e-6;
  }
  IlluminationStepOptions options_;
};

TEST_F(MirrorLike, FreeTexelsRecoverTheImageAndTheMap) {
  const std::unique_ptr<IlluminationModel> model = MakeModel(false);
  const std::vector<float> mean = Mean(*model);
  double ends[2];
  for (const bool lbfgs : {false, true}) {
    options_.lbfgs = lbfgs;
    std::vector<float> p = mean;
    std::vector<double> E;
    Cost(options_, mean, p.data(), model.get(), &E);
    const double before = Misfit(E);
    ends[lbfgs] =
        SolveIllumination(light_, observed_, options_, mean, model.get(), &p)
            .total();
    std::vector<float> map;
    EvaluateIllumination(light_, observed_, options_, mean, p.data(),
                         model.get(), &E, &map);
    EXPECT_LT(Misfit(E), before / 10) << lbfgs;
    // The map itself: over the hemisphere behind the camera, which the sphere
    // reflects away from its rim.
    const Image truth = SmoothMap(8, 16);
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
    EXPECT_LT(end_error, start_error / 25) << lbfgs;  // log error by 5
  }
  // Both minimise one objective; in as many passes L-BFGS ends higher.
  EXPECT_LT(ends[1], 2.0 * ends[0]);
  EXPECT_LT(ends[0], 2.0 * ends[1]);
}

}  // namespace
}  // namespace ibrdf
