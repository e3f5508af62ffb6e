// Lobes and prior on top of the marginal likelihood.
#include <gtest/gtest.h>

#include <Eigen/Dense>
#include <cmath>

#include "ibrdf/brdf/cook_torrance_lobes.h"
#include "ibrdf/brdf/flow_lobes.h"
#include "ibrdf/solvers/marginal/marginal_descent.h"
#include "ibrdf/solvers/marginal/marginal_objective.h"
#include "tests/marginal/marginal_testing.h"
#include "tests/support/shadow_testing.h"

namespace ibrdf {
namespace {
using namespace testing;  // NOLINT

class MarginalReflectanceTest : public MarginalTest {};

TEST_F(MarginalReflectanceTest, GradientMatchesDifferences) {
  const MarginalReflectance reflectance(
      FlowLobes::Factory(model_, 2, 1), points_, MakeObservations(radiance_),
      LightProcess(), resolution_, 1, kDirectionalLights);
  ASSERT_EQ(18, reflectance.num_parameters());
  // Away from the truth, and at it.
  for (const double away : {0.2, 0.0}) {
    std::vector<double> x = truth_;
    for (size_t i = 0; i < x.size(); ++i) x[i] += away * std::cos(3.0 * i);
    x.insert(x.end(), {0.02, -0.03, 0.0, 0.04});
    ExpectGradient(reflectance, x, {0, 3, 4, 6, 8, 11, 14, 15, 16, 17});
  }
}

// Any lobes will do.
TEST_F(MarginalReflectanceTest, GradientOfCookTorranceMatchesDifferences) {
  const MarginalReflectance reflectance(
      CookTorranceLobes::Factory(1), points_, MakeObservations(radiance_),
      LightProcess(), resolution_, 1, kDirectionalLights);
  ASSERT_EQ(14, reflectance.num_parameters());
  // A glossy paint, and a rough metal.
  for (const double roughness : {0.15, 0.6}) {
    CookTorrance brdf;
    brdf.diffuse = {0.3, 0.2, 0.02};
    brdf.roughness.setConstant(roughness);
    brdf.f0.setConstant(roughness);
    std::vector<double> x = CookTorranceLobes::ToParameters(brdf);
    x.insert(x.end(), {0.02, -0.03, 0.0, 0.04});
    ExpectGradient(reflectance, x, {0, 2, 4, 5, 6, 7, 9, 10, 11, 12, 13});
  }
}

// As bright as the others, faint, and black: then it is as if it were not
// there.
TEST_F(MarginalReflectanceTest, GradientOfALambertianLobeMatchesDifferences) {
  const LobeLayout layout = {3, model_.shape.code_size(), true};
  const MarginalReflectance reflectance(FlowLobes::Factory(model_, layout, 1),
                                        points_, MakeObservations(radiance_),
                                        LightProcess(), resolution_, 1,
                                        kDirectionalLights);
  ASSERT_EQ(21, reflectance.num_parameters());
  for (const double level : {4.0, -3.0, -1000.0}) {
    std::vector<double> x = truth_;
    x.insert(x.end(), {level, level + 0.4, level - 0.3});
    x.insert(x.end(), {0.02, -0.03, 0.0, 0.04});
    ExpectGradient(reflectance, x, {0, 4, 8, 13, 14, 15, 16, 17, 20});
  }
}

TEST_F(MarginalReflectanceTest, BlackLambertianLobeChangesNothing) {
  const LobeLayout layout = {3, model_.shape.code_size(), true};
  const MarginalReflectance with(FlowLobes::Factory(model_, layout, 1), points_,
                                 MakeObservations(radiance_), LightProcess(),
                                 resolution_, 1);
  const MarginalReflectance without(FlowLobes::Factory(model_, 2, 1), points_,
                                    MakeObservations(radiance_), LightProcess(),
                                    resolution_, 1);
  const DataErrors errors = {
      Eigen::VectorXd::Constant(3 * with.bins().num_bins(), 0.0025), {}};
  std::vector<double> x = truth_;
  x.insert(x.end(), 3, -1e3);
  LightMode mode, mode_without;
  std::vector<double> gradient, gradient_without;
  const MarginalValue value =
      with.Evaluate(x.data(), errors, {}, 1e-9, &mode, &gradient);
  const MarginalValue expected = without.Evaluate(
      truth_.data(), errors, {}, 1e-9, &mode_without, &gradient_without);
  EXPECT_EQ(expected.cost, value.cost);
  for (int i = 0; i < 14; ++i) EXPECT_EQ(gradient_without[i], gradient[i]);
  for (int i = 14; i < 17; ++i) EXPECT_EQ(0.0, gradient[i]);
  const Eigen::MatrixXd information =
      with.Information(x.data(), errors, {}, mode);
  ASSERT_TRUE(information.allFinite());
  EXPECT_EQ(0.0, information.middleRows(14, 3).norm());
}

// Outside a cube, and in it, where no light of the map comes.
TEST_F(MarginalReflectanceTest, CellsThatSeeNoLightAreLeftOut) {
  const Scene scene = Scene::FromMesh(CubeMesh()).value();
  Camera camera;
  camera.type = CameraType::kPerspective;
  camera.from = {4.0, 3.0, 5.0};
  std::vector<ShadingPoint> points =
      FindShadingPoints(scene, camera, 12, 12, Mask(), 1).value();
  camera.from = {0.0, 0.0, 0.5};
  camera.to = {0.1, 0.2, -1.0};
  const std::vector<ShadingPoint> inside =
      FindShadingPoints(scene, camera, 12, 12, Mask(), 1).value();
  points.insert(points.end(), inside.begin(), inside.end());
  for (size_t i = 0; i < points.size(); ++i) {
    points[i].index = static_cast<int>(i);
  }
  const std::vector<double> radiance(3 * points.size(), 1.0);
  resolution_.visibility =
      std::make_shared<Visibility>(scene, points, VisibilityOptions());
  const MarginalReflectance reflectance(FlowLobes::Factory(model_, 2, 1),
                                        points, MakeObservations(radiance),
                                        LightProcess(), resolution_, 1);
  const int kept = reflectance.bins().num_bins();
  EXPECT_GT(kept, 1);
  EXPECT_LT(kept,
            BinByNormal(points, MakeObservations(radiance), resolution_.bins)
                .num_bins());
  ASSERT_EQ(3 * kept, static_cast<int>(reflectance.bins().log_radiance.size()));
  LightMode mode;
  EXPECT_TRUE(reflectance
                  .Evaluate(truth_.data(),
                            {Eigen::VectorXd::Constant(3 * kept, 0.01), {}}, {},
                            1e-6, &mode, nullptr)
                  .ok);
}

// A trial leaves what is said of the last point as it is.
TEST_F(MarginalReflectanceTest, LastValueIsOfTheLastGradient) {
  const MarginalReflectance reflectance(FlowLobes::Factory(model_, 2, 1),
                                        points_, MakeObservations(radiance_),
                                        LightProcess(), resolution_, 1);
  const MaterialPrior prior = JointMaterialPrior(model_, 2, 0.5);
  LightMode mode;
  const MarginalObjective objective(
      &reflectance, &prior,
      {Eigen::VectorXd::Constant(3 * reflectance.bins().num_bins(), 0.01), {}},
      &mode);
  std::vector<double> y(objective.NumParameters(), 0.1), gradient(y.size());
  double cost = 0.0;
  ASSERT_TRUE(objective.Evaluate(y.data(), &cost, gradient.data()));
  const double kept = objective.last_value().cost;
  y[0] += 1.0;
  ASSERT_TRUE(objective.Evaluate(y.data(), &cost, nullptr));
  EXPECT_EQ(kept, objective.last_value().cost);
  ASSERT_TRUE(objective.Evaluate(y.data(), &cost, gradient.data()));
  EXPECT_NE(kept, objective.last_value().cost);
}

TEST_F(MarginalReflectanceTest, ObjectiveIsWhitenedAndConsistent) {
  const MarginalReflectance reflectance(
      FlowLobes::Factory(model_, 2, 1), points_, MakeObservations(radiance_),
      LightProcess(), resolution_, 1, kDirectionalLights);
  const MaterialPrior prior = JointMaterialPrior(model_, 2, 0.5);
  LightMode mode;
  const MarginalObjective objective(
      &reflectance, &prior,
      {Eigen::VectorXd::Constant(3 * reflectance.bins().num_bins(), 0.01), {}},
      &mode);
  ASSERT_EQ(23, objective.NumParameters());
  Eigen::VectorXd x(18);
  x << Eigen::Map<const Eigen::VectorXd>(truth_.data(), 14), 0.02, -0.03, 0.0,
      0.04;
  std::vector<double> y = objective.Whitened(x, {0.4});
  EXPECT_LT((objective.ParametersOf(y.data()) - x).norm(), 1e-9);
  EXPECT_LT((objective.LobesOf(y.data()) - x.head(14)).norm(), 1e-9);
  EXPECT_NEAR(0.4, objective.HyperparametersOf(y.data()).log_amplitude, 1e-12);
  std::vector<double> gradient(23);
  double cost = 0.0;
  ASSERT_TRUE(objective.Evaluate(y.data(), &cost, gradient.data()));
  ASSERT_TRUE(objective.Evaluate(y.data(), &cost, gradient.data()));
  for (const int i : {0, 5, 9, 14, 15, 17, 18, 20, 22}) {
    const double h = 0.02;
    double up = 0.0, down = 0.0;
    y[i] += h;
    ASSERT_TRUE(objective.Evaluate(y.data(), &up, nullptr));
    y[i] -= 2 * h;
    ASSERT_TRUE(objective.Evaluate(y.data(), &down, nullptr));
    y[i] += h;
    EXPECT_NEAR((up - down) / (2 * h), gradient[i], 0.02 * Norm(gradient)) << i;
  }
}

// G^T A^-1 G with G by differences of log L_o under the mode's light and A put
// together densely. A clamped colour and a code beyond the ball among them.
TEST_F(MarginalReflectanceTest, InformationMatchesDenseReference) {
  const MarginalReflectance reflectance(
      FlowLobes::Factory(model_, 2, 1), points_, MakeObservations(radiance_),
      LightProcess(), resolution_, 1, kDirectionalLights);
  const int P = reflectance.bins().num_bins(), t = 128, s = t + 2;
  const int n = 18, all = n + LightHyperparameters::kCount;
  Eigen::VectorXd noise(3 * P);
  for (int i = 0; i < 3 * P; ++i) noise[i] = 0.002 + 1e-4 * (i % 7);
  const LightHyperparameters hyperparameters = {0.3, {-1.0, 0.3, 0.2, -0.5}};
  const LightProcess process;
  const MaterialPrior prior = JointMaterialPrior(model_, 2, 0.5);
  for (const bool extreme : {false, true}) {
    std::vector<double> x = truth_;
    x.insert(x.end(), {0.02, -0.03, 0.0, 0.04});
    if (extreme) {
      x[4] = kMaxLogColour + 5.0;
      x[7] = -1.4;
      x[12] = -40.0;
    }
    LightMode mode;
    ASSERT_TRUE(reflectance
                    .Evaluate(x.data(), {noise, {}}, hyperparameters, 1e-6,
                              &mode, nullptr)
                    .ok);
    const Eigen::VectorXd L = (mode.l.array() + mode.level).exp();
    const auto radiance = [&](const std::vector<double>& at) {
      const std::array<RowMatrix, 3> T = reflectance.Matrices(at.data());
      Eigen::VectorXd L_o(3 * P);
      for (int c = 0; c < 3; ++c) {
        L_o.segment(c * P, P) = T[c] * L.segment(c * s, s);
      }
      return L_o;
    };
    RowMatrix G(3 * P, n);
    for (int i = 0; i < n; ++i) {
      // Along a directional light's way tables have kinks.
      const double h = i < 14 ? 0.01 : 0.001;
      std::vector<double> up = x, down = x;
      up[i] += h;
      down[i] -= h;
      G.col(i) =
          (radiance(up).array().log() - radiance(down).array().log()) / (2 * h);
    }
    const std::array<RowMatrix, 3> T = reflectance.Matrices(x.data());
    const Eigen::VectorXd L_o = radiance(x);
    Eigen::MatrixXd J = Eigen::MatrixXd::Zero(3 * P, 3 * s);
    Eigen::MatrixXd K1 = Eigen::MatrixXd::Zero(3 * s, 3 * s), K2(3 * s, 3 * s);
    LightProcess scaled = process;
    scaled.horizon_share = 0.0;
    const RowMatrix C = LightCorrelation(8, 16, scaled, hyperparameters);
    const RowMatrix horizon =
        LightCorrelation(8, 16, process, hyperparameters) - C;
    for (int c = 0; c < 3; ++c) {
      J.block(c * P, c * s, P, s) =
          L_o.segment(c * P, P).cwiseInverse().asDiagonal() * T[c] *
          L.segment(c * s, s).asDiagonal();
      for (int d = 0; d < 3; ++d) {
        K1.block(c * s, d * s, t, t) =
            std::exp(hyperparameters.log_amplitude) * process.Local()(c, d) * C;
        auto level = K2.block(c * s, d * s, s, s);
        level.setConstant(process.Level()(c, d));
        level.topLeftCorner(t, t) += std::exp(hyperparameters.log_amplitude) *
                                     process.Local()(c, d) * horizon;
        level.diagonal().tail(s - t).array() +=
            process.DirectionalLight()(c, d);
      }
    }
    const Eigen::MatrixXd A1 = J * K1 * J.transpose();
    Eigen::MatrixXd A = A1 + J * K2 * J.transpose();
    A.diagonal() += noise;
    const Eigen::LLT<Eigen::MatrixXd> llt(A);
    const Eigen::MatrixXd expected = G.transpose() * llt.solve(G);
    const Eigen::MatrixXd X = llt.solve(A1);
    const Eigen::MatrixXd found =
        reflectance.Information(x.data(), {noise, {}}, hyperparameters, mode);
    ASSERT_EQ(all, found.rows());
    // Tables and sums of the renderer are float.
    EXPECT_LT((found.topLeftCorner(n, n) - expected).norm(),
              5e-3 * expected.norm());
    // A^-1 dA / d scale, the amplitude's and, by differences of K, the others'.
    std::vector<Eigen::MatrixXd> by = {X};
    for (int b = 0; b < LightHyperparameters::kBands; ++b) {
      const auto correlation = [&](double step) {
        LightHyperparameters moved = hyperparameters;
        moved.log_roughness[b] += step;
        return LightCorrelation(8, 16, process, moved);
      };
      const RowMatrix moved = (correlation(1e-4) - correlation(-1e-4)) / 2e-4;
      Eigen::MatrixXd K = Eigen::MatrixXd::Zero(3 * s, 3 * s);
      for (int c = 0; c < 3; ++c) {
        for (int d = 0; d < 3; ++d) {
          K.block(c * s, d * s, t, t) =
              std::exp(hyperparameters.log_amplitude) * process.Local()(c, d) *
              moved;
        }
      }
      by.push_back(llt.solve(J * K * J.transpose()));
    }
    for (int a = 0; a < LightHyperparameters::kCount; ++a) {
      for (int b = 0; b < LightHyperparameters::kCount; ++b) {
        EXPECT_NEAR(0.5 * (by[a] * by[b]).trace(), found(n + a, n + b),
                    1e-3 * std::sqrt(found(n + a, n + a) * found(n + b, n + b)))
            << a << " " << b;
      }
      EXPECT_EQ(0.0, found.row(n + a).head(n).norm());
    }
    if (extreme) {
      EXPECT_EQ(0.0, found.row(4).norm());
    }

    // The objective's terms: the prior whitened, and the wall of that code.
    const MarginalObjective objective(&reflectance, &prior, {noise, {}}, &mode);
    const std::vector<double> y = objective.Whitened(
        Eigen::Map<const Eigen::VectorXd>(x.data(), n), hyperparameters);
    Eigen::MatrixXd rest = objective.Information(y.data());
    ASSERT_EQ(all, rest.rows());
    Eigen::MatrixXd whitening = Eigen::MatrixXd::Zero(all, all);
    whitening.topLeftCorner(14, 14) = prior.factor;
    const auto stds = LightHyperparameters::Stds();
    for (int k = 0; k < LightHyperparameters::kCount; ++k) {
      whitening(n + k, n + k) = stds[k];
    }
    for (int i = 14; i < n; ++i) {
      whitening(i, i) = MarginalObjective::kDirectionalLightOffsetStd;
    }
    rest -= whitening.transpose() * found * whitening;
    rest -= Eigen::MatrixXd::Identity(all, all);
    Eigen::VectorXd wall = Eigen::VectorXd::Zero(14);
    if (extreme) {
      wall.segment(7, 4) =
          prior.wall *
          Eigen::Map<const Eigen::VectorXd>(x.data() + 7, 4).normalized();
    }
    const Eigen::VectorXd whitened = prior.factor.transpose() * wall;
    EXPECT_LT(
        (rest.topLeftCorner(14, 14) - whitened * whitened.transpose()).norm(),
        1e-6 * (1.0 + found.norm()));
  }
}

// Where it ends, a step of Newton's along the information gains next to
// nothing, and no start, however far out, raises the cost.
TEST_F(MarginalReflectanceTest, DescentEndsWhereNewtonGainsNothing) {
  const MarginalReflectance reflectance(FlowLobes::Factory(model_, 2, 1),
                                        points_, MakeObservations(radiance_),
                                        LightProcess(), resolution_, 1);
  const MaterialPrior prior = JointMaterialPrior(model_, 2, 0.5);
  const Eigen::VectorXd noise =
      Eigen::VectorXd::Constant(3 * reflectance.bins().num_bins(), 0.0025);
  for (const double away : {0.3, 4.0}) {
    LightMode mode;
    const MarginalObjective objective(&reflectance, &prior, {noise, {}}, &mode);
    std::vector<double> y(19);
    for (int i = 0; i < 19; ++i) y[i] = away * std::cos(3.0 * i);
    std::vector<double> gradient(19);
    double first = 0.0;
    ASSERT_TRUE(objective.Evaluate(y.data(), &first, gradient.data()));
    MarginalDescentOptions options;
    options.max_iterations = 60;
    const std::vector<double> start = y;
    const MarginalDescent descent = Descend(objective, options, &y);
    ASSERT_TRUE(descent.ok);
    EXPECT_LT(descent.iterations, 60);
    EXPECT_LT(descent.cost, first - 1.0);
    double cost = 0.0;
    ASSERT_TRUE(objective.Evaluate(y.data(), &cost, gradient.data()));
    EXPECT_NEAR(cost, descent.cost, 1e-4);
    const Eigen::Map<const Eigen::VectorXd> g(gradient.data(), 19);
    EXPECT_LT(0.5 * g.dot(objective.Information(y.data()).llt().solve(g)), 0.2);
    // One step alone lowers it, and the others lower it further.
    options.max_iterations = 1;
    std::vector<double> one = start;
    LightMode cold;
    const MarginalObjective again(&reflectance, &prior, {noise, {}}, &cold);
    const MarginalDescent step = Descend(again, options, &one);
    EXPECT_EQ(1, step.iterations);
    EXPECT_LE(descent.cost, step.cost);
    EXPECT_LT(step.cost, first);
  }
  // Stopped at once it is where it was.
  LightMode mode;
  const MarginalObjective objective(&reflectance, &prior, {noise, {}}, &mode);
  std::vector<double> y(19, 0.1);
  MarginalDescentOptions options;
  options.should_stop = [] { return true; };
  const MarginalDescent stopped = Descend(objective, options, &y);
  EXPECT_TRUE(stopped.ok);
  EXPECT_EQ(0, stopped.iterations);
  EXPECT_EQ(std::vector<double>(19, 0.1), y);
}

}  // namespace
}  // namespace ibrdf
