#include "ibrdf/solvers/costs/log_radiance_cost.h"

#include <ceres/cost_function.h>
#include <gtest/gtest.h>

#include <cmath>
#include <limits>
#include <memory>
#include <random>
#include <string>
#include <vector>

#include "ibrdf/solvers/costs/robust_log_residual.h"
#include "ibrdf/solvers/priors/prior_costs.h"
#include "tests/support/shadow_testing.h"
#include "tests/support/solver_testing.h"

namespace ibrdf {
namespace {
using namespace testing;  // NOLINT

// The share of a column's largest entry. The float kernels leave about 4e-6 in
// log L_o; over the steps of 0.01 to 0.1 that Ridders' method settles on, this
// is a few 1e-4 of a derivative of log L_o of order 1.
constexpr double kJacobianTolerance = 1e-3;
// And of residuals, absolute: that noise over b = 0.2, times dr/dt <= 1.5. A
// difference over a step carries it however small the column.
constexpr double kResidualNoise = 3e-5;
// Plain double arithmetic against differences.
constexpr double kSmoothTolerance = 1e-7;

struct Evaluation {
  bool ok = false;
  std::vector<double> residuals;
  std::vector<std::vector<double>> jacobians;  // [block][row * size + column]
};

Evaluation Evaluate(const ceres::CostFunction& cost,
                    const std::vector<std::vector<double>>& blocks,
                    bool derivatives = true) {
  Evaluation e;
  e.residuals.assign(cost.num_residuals(), 0.0);
  std::vector<const double*> parameters;
  std::vector<double*> jacobians;
  for (const std::vector<double>& b : blocks) {
    parameters.push_back(b.data());
    e.jacobians.emplace_back(b.size() * e.residuals.size(),
                             std::numeric_limits<double>::quiet_NaN());
  }
  for (std::vector<double>& j : e.jacobians) jacobians.push_back(j.data());
  e.ok = cost.Evaluate(parameters.data(), e.residuals.data(),
                       derivatives ? jacobians.data() : nullptr);
  return e;
}

// The Jacobian of `block` along `direction` against differences of residuals.
void ExpectDirection(const ceres::CostFunction& cost,
                     const std::vector<std::vector<double>>& blocks,
                     const Evaluation& at, size_t block,
                     const std::vector<double>& direction, double step,
                     double tolerance, const std::string& what) {
  const std::vector<double> numeric = Differentiate(
      [&](double t) {
        std::vector<std::vector<double>> moved = blocks;
        for (size_t p = 0; p < direction.size(); ++p) {
          moved[block][p] += t * direction[p];
        }
        const Evaluation e = Evaluate(cost, moved, false);
        EXPECT_TRUE(e.ok) << what;
        return e.residuals;
      },
      step);
  double scale = 0.0, error = 0.0;
  const size_t columns = direction.size();
  for (size_t row = 0; row < numeric.size(); ++row) {
    double analytic = 0.0;
    for (size_t p = 0; p < columns; ++p) {
      analytic += at.jacobians[block][row * columns + p] * direction[p];
    }
    ASSERT_TRUE(std::isfinite(analytic)) << what << " row " << row;
    scale = std::max(scale, std::abs(analytic));
    error = std::max(error, std::abs(analytic - numeric[row]));
  }
  const double noise = tolerance == kJacobianTolerance ? kResidualNoise : 0.0;
  EXPECT_LE(error, tolerance * scale + noise / step + 1e-12)
      << what << " scale " << scale;
}

void ExpectBlock(const ceres::CostFunction& cost,
                 const std::vector<std::vector<double>>& blocks, size_t block,
                 double tolerance, const std::string& what) {
  const Evaluation at = Evaluate(cost, blocks);
  ASSERT_TRUE(at.ok) << what;
  for (size_t p = 0; p < blocks[block].size(); ++p) {
    std::vector<double> axis(blocks[block].size(), 0.0);
    axis[p] = 1.0;
    ExpectDirection(cost, blocks, at, block, axis, 0.1, tolerance,
                    what + " column " + std::to_string(p));
  }
}

TEST(RobustResidual, IsMonotoneAndHalfItsSquareIsTheSmoothedMagnitude) {
  for (const double delta : {0.05, 0.5, 3.0}) {
    double before = 0.0;
    EXPECT_EQ(0.0, RobustResidual(0.0, delta, nullptr));
    for (double t = 1e-12; t < 1e9; t *= 3.0) {
      double slope = 0.0;
      const double r = RobustResidual(t, delta, &slope);
      EXPECT_GT(r, before);
      before = r;
      EXPECT_EQ(-r, RobustResidual(-t, delta, nullptr));
      // rho in long double, where its cancellation at small t is harmless.
      const long double T = t, D = delta;
      const double rho = static_cast<double>(std::sqrt(T * T + D * D) - D);
      if (t > 1e-6) {
        EXPECT_NEAR(rho, r * r / 2, 1e-6 * rho);
      }
      const double h = 1e-4 * t;
      const double numeric = (RobustResidual(t + h, delta, nullptr) -
                              RobustResidual(t - h, delta, nullptr)) /
                             (2 * h);
      EXPECT_NEAR(numeric, slope, kSmoothTolerance * slope) << t;
    }
  }
}

TEST(RobustResidual, IsFiniteForAnyFiniteValue) {
  for (const double t : {0.0, 1e-300, 1e8, 1e200, 1e308}) {
    double slope = 0.0;
    EXPECT_TRUE(std::isfinite(RobustResidual(t, 0.5, &slope))) << t;
    EXPECT_TRUE(std::isfinite(slope) && slope > 0.0) << t;
    if (t > 1.0) {
      EXPECT_NEAR(std::sqrt(2.0) * std::sqrt(t),
                  RobustResidual(t, 0.5, nullptr), 1e-8 * std::sqrt(t) + 0.5);
    }
  }
}

TEST(LobePriorCost, ResidualsAndJacobianInsideAndOutsideTheBall) {
  LobePrior prior;
  prior.sigma = 0.7;
  prior.colour_mean[1] = 2.0;
  const LobePriorCost cost({2, 3}, prior);
  const std::vector<double> inside = {0.1, -0.2, 0.3, 1, 2, 3,
                                      0.5, 0.5,  0.5, 4, 5, 6};
  const Evaluation e = Evaluate(cost, {inside});
  ASSERT_EQ(size_t{14}, e.residuals.size());
  EXPECT_DOUBLE_EQ(-0.2 / 0.7, e.residuals[1]);
  EXPECT_EQ(0.0, e.residuals[3]);
  EXPECT_DOUBLE_EQ((2.0 - 2.0) / prior.colour_sigma, e.residuals[5]);
  EXPECT_DOUBLE_EQ(6.0 / prior.colour_sigma, e.residuals[13]);
  std::vector<double> outside = inside;
  for (int d = 0; d < 3; ++d) outside[d] = 1.5 / std::sqrt(3.0);
  EXPECT_NEAR(prior.wall * 0.5, Evaluate(cost, {outside}).residuals[3], 1e-12);
  // Steps of 0.1 and less stay on their side of the wall.
  ExpectBlock(cost, {inside}, 0, kSmoothTolerance, "inside");
  ExpectBlock(cost, {outside}, 0, 1e-6, "outside");
}

TEST(LobePriorCost, LambertianLobeHasItsColoursAlone) {
  LobePrior prior;
  prior.colour_mean[1] = 2.0;
  const LobePriorCost cost({2, 3, true}, prior);
  const std::vector<double> p = {0.1, -0.2, 0.3, 1, 2, 3, 4, 5, 6};
  ASSERT_EQ(10, cost.num_residuals());
  const Evaluation e = Evaluate(cost, {p});
  EXPECT_DOUBLE_EQ(4.0 / prior.colour_sigma, e.residuals[7]);
  EXPECT_DOUBLE_EQ((5.0 - 2.0) / prior.colour_sigma, e.residuals[8]);
  ExpectBlock(cost, {p}, 0, kSmoothTolerance, "Lambertian");
  std::vector<double> dark = p;
  for (int c = 0; c < 3; ++c) dark[6 + c] = -1e3;
  ExpectBlock(cost, {dark}, 0, kSmoothTolerance, "dark");
}

TEST(LobePriorCost, IsFiniteAtZeroAndOnTheSphere) {
  const LobePriorCost cost({1, 2}, {});
  for (const std::vector<double>& p : {std::vector<double>{0, 0, 0, 0, 0},
                                       {1, 0, 0, 0, 0},
                                       {0, -1, 0, 0, 0}}) {
    const Evaluation e = Evaluate(cost, {p});
    ASSERT_TRUE(e.ok);
    EXPECT_EQ(0.0, e.residuals[2]);
    for (const double v : e.jacobians[0]) EXPECT_TRUE(std::isfinite(v));
  }
}

TEST(WeightPriorCost, IsTheWhitenedDistance) {
  const WeightPriorCost cost({1.0f, -2.0f, 0.0f}, {0.5f, 2.0f, 1.0f}, 3.0);
  const std::vector<double> x = {2.5, -5.0, 0.3};
  const Evaluation e = Evaluate(cost, {x});
  EXPECT_DOUBLE_EQ(1.0, e.residuals[0]);
  EXPECT_DOUBLE_EQ(-0.5, e.residuals[1]);
  EXPECT_DOUBLE_EQ(0.1, e.residuals[2]);
  ExpectBlock(cost, {x}, 0, kSmoothTolerance, "weights");
}

TEST(Observations, ZeroNegativeAndNonFinitePointsTakeNoPart) {
  const double inf = std::numeric_limits<double>::infinity();
  const Observations o = MakeObservations(
      {1, 2, 3, 0, 1, 1, 1, -1, 1, 1, 1, inf, NAN, 1, 1, 1e-30, 1, 1e30});
  EXPECT_EQ((std::vector<char>{1, 0, 0, 0, 0, 1}), o.valid);
  EXPECT_EQ(2, o.num_valid);
}

TEST(LogLikelihood, NoLightAndNoEpsilonIsFiniteWithoutSlope) {
  const Observations observed = MakeObservations({1, 1, 1});
  RobustLogLikelihood likelihood;
  LikelihoodDerivatives d;
  const auto cost = [&](double L_o) {
    return EvaluateLikelihood({L_o, 1, 1}, observed, likelihood, &d).cost;
  };
  likelihood.epsilon = 0.0;
  for (const double L_o : {0.0, 1e-310, 1e-101}) {
    EXPECT_TRUE(std::isfinite(cost(L_o))) << L_o;
    EXPECT_EQ(cost(0.0), cost(L_o));
    EXPECT_LT(d.residual[0], -1.0);
    EXPECT_EQ(0.0, d.d_residual[0]) << L_o;
    EXPECT_EQ(0.0, d.weight[0]) << L_o;
  }
  for (const double L_o : {1e-99, 1e-45, 1e30, 1e300}) {
    EXPECT_TRUE(std::isfinite(cost(L_o))) << L_o;
    EXPECT_GT(d.d_residual[0], 0.0) << L_o;
    EXPECT_TRUE(std::isfinite(d.d_residual[0])) << L_o;
    EXPECT_TRUE(std::isfinite(d.weight[0])) << L_o;
  }
  // Negative radiance counts as none; from 0 on it has a slope again.
  likelihood.epsilon = 1e-6;
  const double none = cost(0.0);
  EXPECT_GT(d.d_residual[0], 0.0);
  EXPECT_EQ(none, cost(-1.0));
  EXPECT_EQ(0.0, d.d_residual[0]);
}

// By central differences of the residual in the ambient term.
TEST(LogLikelihood, SlopeByTheAmbientTermMatchesDifferences) {
  const double inf = std::numeric_limits<double>::infinity();
  RobustLogLikelihood likelihood;
  likelihood.scale = 0.1;
  for (const double epsilon : {0.0, 1e-5}) {
    likelihood.epsilon = epsilon;
    for (const double L_o : {0.0, 1e-9, 0.3, 1e6}) {
      for (const double ambient : {1e-12, 1e-3, 0.5, 1e7}) {
        // Values, and an upper end that is exceeded.
        for (const Observations& observed :
             {MakeObservations({0.7, 0.7, 0.7}),
              MakeObservations({1e-14, 1e-14, 1e-14}, {0, 0, 0},
                               {1e-14, 1e-14, 1e-14}),
              MakeObservations({1e9, 1e9, 1e9}, {1e9, 1e9, 1e9},
                               {inf, inf, inf})}) {
          likelihood.epsilon = epsilon;
          LikelihoodDerivatives d;
          const auto residual = [&](double a) {
            likelihood.ambient = {a, 0.1, 0.2};
            EvaluateLikelihood({L_o, 1, 1}, observed, likelihood, &d);
            return d.residual[0];
          };
          // The term stays positive.
          const double h =
              std::min(1e-5 * (L_o + ambient + epsilon), 0.5 * ambient);
          const double numeric =
              (residual(ambient + h) - residual(ambient - h)) / (2 * h);
          residual(ambient);
          // Rounding of the logarithms over the step.
          EXPECT_NEAR(numeric, d.d_residual[0], 1e-5 * numeric + 1e-13 / h)
              << "L_o " << L_o << " ambient " << ambient;
          EXPECT_GE(d.d_residual[0], 0.0);
        }
      }
    }
  }
}

class RadianceCosts : public ::testing::Test {
 protected:
  RadianceCosts() : map_(SmoothMap(8, 16).rgb) { ObserveUnder(map_); }

  // The scene's image, off by factors of e^(+-0.3) from the parameters'.
  void ObserveUnder(const std::vector<float>& map) {
    std::vector<double> L_o = scene_.Render(scene_.Parameters(), map);
    for (size_t i = 0; i < L_o.size(); ++i)
      L_o[i] *= std::exp(0.3 * std::sin(7.0 * i));
    observed_ = MakeObservations(L_o);
    // About 1e-5 of the mean radiance, as the solver takes it.
    likelihood_.epsilon = 1e-5 * L_o[0];
    likelihood_.scale = 0.2;
  }

  std::unique_ptr<LobeRadianceCost> Cost(const std::vector<float>& map) const {
    return std::make_unique<LobeRadianceCost>(&scene_.transport, &scene_.lobes,
                                              map, &observed_, likelihood_);
  }

  const TinyScene scene_;
  const std::vector<float> map_;
  Observations observed_;
  RobustLogLikelihood likelihood_;
};

TEST_F(RadianceCosts, RenderLobeModelIsTransportOfTheCombinedGrid) {
  const std::vector<double> p = scene_.Parameters();
  std::vector<double> L_o;
  ASSERT_TRUE(RenderLobeModel(scene_.transport, scene_.lobes, p.data(),
                              map_.data(), &L_o, nullptr));
  const std::vector<double> expected = scene_.Render(p, map_);
  ASSERT_EQ(expected.size(), L_o.size());
  // Float sums of some hundred terms.
  for (size_t i = 0; i < L_o.size(); ++i) {
    EXPECT_NEAR(expected[i], L_o[i], 2e-5 * expected[i]);
  }
}

TEST_F(RadianceCosts, AmbientTermIsABlockOfItsOwn) {
  const LobeRadianceCost cost(&scene_.transport, &scene_.lobes, map_,
                              &observed_, likelihood_, nullptr,
                              /*ambient_unknown=*/true);
  ASSERT_EQ(size_t{2}, cost.parameter_block_sizes().size());
  const double level = observed_.radiance[0];
  const std::vector<double> lobes = scene_.Parameters();
  const std::vector<double> none(3, 0.0);
  EXPECT_EQ(Evaluate(*Cost(map_), {lobes}).residuals,
            Evaluate(cost, {lobes, none}).residuals);
  for (const double share : {0.01, 1.0, 100.0}) {
    const std::vector<double> ambient = {share * level, 2 * share * level,
                                         3 * share * level};
    const Evaluation at = Evaluate(cost, {lobes, ambient});
    ASSERT_TRUE(at.ok);
    for (size_t c = 0; c < 3; ++c) {
      std::vector<double> axis(3, 0.0);
      axis[c] = share * level;
      // Steps of some hundredths of the term.
      ExpectDirection(cost, {lobes, ambient}, at, 1, axis, 0.05,
                      kJacobianTolerance, "ambient " + std::to_string(share));
    }
    ExpectBlock(cost, {lobes, ambient}, 0, kJacobianTolerance, "lobes");
  }
}

// The inside of half a sphere, its opening towards the viewer.
class BouncedRadiance : public ::testing::TestWithParam<int> {
 protected:
  void SetUp() override {
    const TriangleMesh bowl = GridMesh(
        24, 48, false,
        [](double u, double v, Eigen::Vector3d* p, Eigen::Vector3d* n) {
          const double theta = kPi / 2 * u, phi = 2 * kPi * v;
          *p = {std::sin(theta) * std::cos(phi),
                std::sin(theta) * std::sin(phi), -std::cos(theta)};
          *n = -*p;
        });
    const Scene scene = Scene::FromMesh(bowl).value();
    points_ = FindShadingPoints(scene, Camera(), 4, 4, Mask(), 1).value();
    TransportOptions options = TinyTransportOptions();
    options.visibility =
        std::make_shared<Visibility>(scene, points_, VisibilityOptions());
    RadiosityOptions patches;
    patches.bounces = GetParam();
    patches.max_patches = 200;
    options.patches = std::make_shared<RadiosityPatches>(
        scene, points_, options.visibility, patches);
    transport_ = std::make_unique<Transport>(points_, 8, 16, options);
  }
  std::vector<ShadingPoint> points_;
  std::unique_ptr<Transport> transport_;
  const TinyScene scene_;
};

TEST_P(BouncedRadiance, TangentsOfLobesMatchDifferences) {
  const std::vector<float> map = SmoothMap(8, 16).rgb;
  for (const double brighter : {0.0, 1.0}) {
    std::vector<double> p = scene_.Parameters();
    for (const int k : {4, 5, 6, 11, 12, 13}) p[k] += brighter;
    std::vector<double> L_o, dL_o, direct(3 * points_.size());
    ASSERT_TRUE(RenderLobeModel(*transport_, scene_.lobes, p.data(), map.data(),
                                &L_o, &dL_o));
    const BrdfGrid grid = scene_.lobes.Grid(p.data());
    std::vector<double> rendered(L_o.size());
    transport_->Render(grid, map.data(), rendered.data());
    transport_->RenderBounces(grid, map.data(), 0, direct.data());
    for (size_t i = 0; i < L_o.size(); ++i) {
      EXPECT_NEAR(rendered[i], L_o[i], 2e-5 * L_o[i]);
      EXPECT_GT(L_o[i], 1.02 * direct[i]);
    }
    const auto columns = static_cast<size_t>(scene_.lobes.num_parameters());
    for (size_t k = 0; k < columns; ++k) {
      const double h = 0.02;
      std::vector<double> at[4];
      int place = 0;
      for (const double step : {-2 * h, -h, h, 2 * h}) {
        std::vector<double> moved = p;
        moved[k] += step;
        ASSERT_TRUE(RenderLobeModel(*transport_, scene_.lobes, moved.data(),
                                    map.data(), &at[place++], nullptr));
      }
      double size = 0.0;
      for (size_t i = 0; i < L_o.size(); ++i) {
        size = std::max(size, std::abs(dL_o[i * columns + k]));
      }
      for (size_t i = 0; i < L_o.size(); ++i) {
        const double numeric =
            (8 * (at[2][i] - at[1][i]) - (at[3][i] - at[0][i])) / (12 * h);
        // Rounding of L_o over the step, and the step's own error.
        EXPECT_NEAR(numeric, dL_o[i * columns + k], 2e-3 * size + 1e-4 * L_o[i])
            << "parameter " << k << ", row " << i;
      }
    }
  }
}

INSTANTIATE_TEST_SUITE_P(Bounces, BouncedRadiance, ::testing::Values(1, 3));

TEST_F(RadianceCosts, LobeJacobianMatchesDifferencesAtOrdinaryPoints) {
  ExpectBlock(*Cost(map_), {scene_.Parameters()}, 0, kJacobianTolerance, "mid");
  std::mt19937 rng(4);
  std::uniform_real_distribution<double> u(-0.4, 0.4);
  for (int trial = 0; trial < 3; ++trial) {
    std::vector<double> p = scene_.Parameters();
    for (double& v : p) v += u(rng);
    ExpectBlock(*Cost(map_), {p}, 0, kJacobianTolerance,
                "random " + std::to_string(trial));
  }
}

TEST_F(RadianceCosts, LobeJacobianMatchesDifferencesAtExtremePoints) {
  const std::vector<double> middle = scene_.Parameters();
  std::vector<double> zero = middle, on = middle, beyond = middle,
                      coinciding = middle, faint = middle, bright = middle;
  for (int d = 0; d < 4; ++d) {
    zero[d] = zero[7 + d] = 0.0;
    on[d] = d == 1 ? -1.0 : 0.0;
    on[7 + d] = 0.5;
    beyond[d] = 1.0;
    beyond[7 + d] = -0.8;
  }
  std::copy(middle.begin(), middle.begin() + 7, coinciding.begin() + 7);
  for (int c = 0; c < 3; ++c) {
    faint[4 + c] = -30.0;
    bright[11 + c] = 20.0;
  }
  ExpectBlock(*Cost(map_), {zero}, 0, kJacobianTolerance, "zero");
  ExpectBlock(*Cost(map_), {on}, 0, kJacobianTolerance, "on the sphere");
  ExpectBlock(*Cost(map_), {beyond}, 0, kJacobianTolerance, "beyond it");
  ExpectBlock(*Cost(map_), {coinciding}, 0, kJacobianTolerance, "coinciding");
  ExpectBlock(*Cost(map_), {bright}, 0, kJacobianTolerance, "bright");
  // Beside the other lobe, one of e^-30 is below the float noise of L_o:
  // its columns are exact multiples of its own image instead.
  const Evaluation at = Evaluate(*Cost(map_), {middle});
  const Evaluation e = Evaluate(*Cost(map_), {faint});
  ASSERT_TRUE(e.ok);
  for (const double v : e.jacobians[0]) EXPECT_TRUE(std::isfinite(v));
  for (size_t row = 0; row < e.residuals.size(); ++row) {
    for (int p = 0; p < 4; ++p) {
      EXPECT_LE(std::abs(e.jacobians[0][row * 14 + p]), 1e-10);
    }
    EXPECT_NE(0.0, at.jacobians[0][row * 14 + 4 + row % 3]);
  }
  // With both faint the image is dark, yet above the smallest epsilon.
  for (int c = 0; c < 3; ++c) faint[11 + c] = -30.0;
  likelihood_.epsilon = 1e-30;
  ExpectBlock(*Cost(map_), {faint}, 0, kJacobianTolerance, "both faint");
}

// From as bright as the other lobes to black. Where it is far below the noise
// of the float kernels its columns are its own image, and nothing else moves.
TEST_F(RadianceCosts, LambertianLobeMatchesDifferencesFromBrightToBlack) {
  const FlowLobes lobes(scene_.model, scene_.lobes.layout().WithLambertian(),
                        TinyTransportOptions().grid, 1);
  const LobeRadianceCost cost(&scene_.transport, &lobes, map_, &observed_,
                              likelihood_);
  const LobeRadianceCost without(&scene_.transport, &scene_.lobes, map_,
                                 &observed_, likelihood_);
  std::vector<double> p = scene_.Parameters();
  p.insert(p.end(), {4.0, 3.0, 3.5});
  ExpectBlock(cost, {p}, 0, kJacobianTolerance, "matte");
  for (int c = 0; c < 3; ++c) p[14 + c] = 20.0;
  ExpectBlock(cost, {p}, 0, kJacobianTolerance, "white");
  for (int c = 0; c < 3; ++c) p[14 + c] = kMaxLogColour + 1.0;
  ExpectBlock(cost, {p}, 0, kJacobianTolerance, "beyond the largest colour");
  const Evaluation alone = Evaluate(without, {scene_.Parameters()});
  for (const double dark : {-40.0, -1e3, -1e300}) {
    for (int c = 0; c < 3; ++c) p[14 + c] = dark;
    const Evaluation e = Evaluate(cost, {p});
    ASSERT_TRUE(e.ok);
    for (size_t row = 0; row < e.residuals.size(); ++row) {
      EXPECT_NEAR(alone.residuals[row], e.residuals[row], 1e-12);
      for (int k = 0; k < 14; ++k) {
        const double expected = alone.jacobians[0][row * 14 + k];
        EXPECT_NEAR(expected, e.jacobians[0][row * 17 + k],
                    1e-12 * (1.0 + std::abs(expected)));
      }
      for (int k = 14; k < 17; ++k) {
        EXPECT_NEAR(0.0, e.jacobians[0][row * 17 + k], 1e-12);
      }
    }
  }
  // Alone, it is a white sphere whose level is all that matters.
  for (const int k : {4, 5, 6, 11, 12, 13}) p[k] = -1e3;
  for (int c = 0; c < 3; ++c) p[14 + c] = -25.0;
  RobustLogLikelihood exact = likelihood_;
  exact.epsilon = 1e-30;
  const LobeRadianceCost faint(&scene_.transport, &lobes, map_, &observed_,
                               exact);
  ExpectBlock(faint, {p}, 0, kJacobianTolerance, "alone and faint");
}

TEST_F(RadianceCosts, LobeJacobianUnderAOneTexelSun) {
  std::vector<float> sun = map_;
  for (int c = 0; c < 3; ++c) sun[3 * (2 * 16 + 5) + c] = 1e6f;
  ObserveUnder(sun);
  ExpectBlock(*Cost(sun), {scene_.Parameters()}, 0, kJacobianTolerance, "sun");
}

TEST_F(RadianceCosts, PointsWithoutAValueLeaveResidualAndRowsZero) {
  std::vector<double> L_o = observed_.radiance;
  L_o[4] = 0.0;
  L_o[3 * 5] = std::numeric_limits<double>::quiet_NaN();
  observed_ = MakeObservations(L_o);
  ASSERT_EQ(static_cast<int>(scene_.points.size()) - 2, observed_.num_valid);
  const Evaluation e = Evaluate(*Cost(map_), {scene_.Parameters()});
  ASSERT_TRUE(e.ok);
  for (size_t row = 0; row < e.residuals.size(); ++row) {
    const bool out = row / 3 == 1 || row / 3 == 5;
    EXPECT_EQ(out, e.residuals[row] == 0.0) << row;
    for (int p = 0; p < 14; ++p) {
      const double v = e.jacobians[0][row * 14 + p];
      EXPECT_TRUE(out ? v == 0.0 : std::isfinite(v)) << row;
    }
  }
}

TEST_F(RadianceCosts, InfeasibleRadianceIsRefused) {
  std::vector<float> blinding(map_.size(), 3e38f);
  EXPECT_FALSE(Evaluate(*Cost(blinding), {scene_.Parameters()}).ok);
}

class UnetCost : public RadianceCosts {
 protected:
  std::vector<double> Weights() const {
    // The whole prior, last layer too, so that the map varies.
    const std::vector<float> std = unet_.PriorStd();
    std::mt19937 rng(6);
    std::normal_distribution<double> gauss;
    std::vector<double> w;
    for (const float s : std) w.push_back(0.7 * s * gauss(rng));
    return w;
  }

  const IlluminationUnet unet_{TinyUnetOptions()};
};

TEST_F(UnetCost, BothBlocksMatchDifferences) {
  const LogRadianceCost cost(&scene_.transport, &scene_.lobes, &unet_,
                             &observed_, likelihood_);
  const std::vector<std::vector<double>> blocks = {scene_.Parameters(),
                                                   Weights()};
  ExpectBlock(cost, blocks, 0, kJacobianTolerance, "lobes");
  const Evaluation at = Evaluate(cost, blocks);
  ASSERT_TRUE(at.ok);
  // Along random directions of unit length in units of the prior, where no
  // error in any weight's column can hide, and along some weights.
  const std::vector<float> std = unet_.PriorStd();
  std::mt19937 rng(7);
  std::normal_distribution<double> gauss;
  for (int trial = 0; trial < 8; ++trial) {
    std::vector<double> direction(std.size());
    for (double& v : direction) v = gauss(rng);
    const double norm = Norm(direction);
    for (size_t i = 0; i < std.size(); ++i) direction[i] *= std[i] / norm;
    ExpectDirection(cost, blocks, at, 1, direction, 0.5, kJacobianTolerance,
                    "direction " + std::to_string(trial));
  }
  for (size_t p = 0; p < std.size(); p += 61) {
    std::vector<double> axis(std.size(), 0.0);
    axis[p] = 1.0;
    ExpectDirection(cost, blocks, at, 1, axis, 0.2 * std[p], kJacobianTolerance,
                    "weight " + std::to_string(p));
  }
}

TEST_F(UnetCost, AgreesWithTheCostOfTheFixedMap) {
  const LogRadianceCost cost(&scene_.transport, &scene_.lobes, &unet_,
                             &observed_, likelihood_);
  const std::vector<double> w = Weights();
  const std::vector<float> weights(w.begin(), w.end());
  IlluminationUnet::Workspace workspace;
  std::vector<float> planar(unet_.num_outputs()), map(planar.size());
  unet_.Forward(weights.data(), &workspace, planar.data());
  for (size_t i = 0; i < map.size(); ++i) {
    map[i] = std::exp(planar[i % 3 * 128 + i / 3]);
  }
  const Evaluation a = Evaluate(cost, {scene_.Parameters(), w});
  const Evaluation b = Evaluate(*Cost(map), {scene_.Parameters()});
  EXPECT_EQ(b.residuals, a.residuals);
  EXPECT_EQ(b.jacobians[0], a.jacobians[0]);
}

}  // namespace
}  // namespace ibrdf
