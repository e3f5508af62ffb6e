// Lobes, prior and search on top of the marginal likelihood.
#include <gtest/gtest.h>

#include <Eigen/Dense>
#include <atomic>
#include <cmath>
#include <limits>

#include "ibrdf/brdf/cook_torrance_lobes.h"
#include "ibrdf/brdf/flow_lobes.h"
#include "ibrdf/brdf/table_lobes.h"
#include "ibrdf/light/environment_map.h"
#include "solvers/costs/material_prior_cost.h"
#include "solvers/eigen_vectors.h"
#include "solvers/known_light_search.h"
#include "solvers/marginal/marginal_descent.h"
#include "solvers/marginal/marginal_objective.h"
#include "solvers/marginal/reflectance_search.h"
#include "solvers/trainer/material_lobes.h"
#include "tests/solvers/solver_testing.h"

namespace ibrdf {
namespace {
using namespace testing;  // NOLINT

// One in front, one behind the sphere.
const std::vector<Eigen::Vector3d> kLamps = {
    Eigen::Vector3d(0.6, 0.5, 0.6).normalized(),
    Eigen::Vector3d(-0.8, 0.1, -0.5).normalized()};

class MarginalReflectanceTest : public ::testing::Test {
 protected:
  MarginalReflectanceTest() {
    resolution_.cells = {6, 3, 0.2};
    resolution_.map_width = 16;
    resolution_.map_height = 8;
    resolution_.grid = TinyTransportOptions().grid;
  }

  ReflectanceSearchOptions Options() const {
    ReflectanceSearchOptions options;
    options.screen = options.coarse = options.fine = resolution_;
    options.kept = 3;
    options.coarse_rounds = {{3, 1}, {2, 3}};
    options.fine_iterations = 4;
    options.num_threads = 1;
    return options;
  }

  const NeuralBrdfModel model_ = SmoothTinyModel(4);
  const std::vector<ShadingPoint> points_ = SpherePoints(12);
  MarginalResolution resolution_;
  const std::vector<double> truth_ = TinyLobes();
  const std::vector<double> radiance_ =
      RenderTinyLobes(model_, points_, SmoothMap(8, 16));
};

// Gradient at x against differences, of these parameters and all scales.
void ExpectGradient(const MarginalReflectance& reflectance,
                    const std::vector<double>& x,
                    const std::vector<int>& parameters) {
  const int n = reflectance.num_parameters();
  ASSERT_EQ(n, static_cast<int>(x.size()));
  const Eigen::VectorXd noise =
      Eigen::VectorXd::Constant(3 * reflectance.cells().num_cells(), 0.0025);
  const auto evaluate = [&](const std::vector<double>& at,
                            const LightScales& scales,
                            std::vector<double>* gradient) {
    LightMode mode;
    mode.l = mode.dual =
        Eigen::VectorXd::Zero(3 * reflectance.likelihood().num_sources());
    const MarginalValue value =
        reflectance.Evaluate(at.data(), noise, scales, 1e-12, &mode, gradient);
    EXPECT_TRUE(value.ok);
    return std::vector<double>{value.cost};
  };
  std::vector<double> gradient;
  evaluate(x, {0.2}, &gradient);
  ASSERT_EQ(n + 5, static_cast<int>(gradient.size()));
  const double scale = Norm(gradient);
  std::vector<int> all = parameters;
  for (int k = 0; k < 5; ++k) all.push_back(n + k);
  for (const int i : all) {
    const double numeric = Differentiate(
        [&](double t) {
          std::vector<double> at = x;
          if (i < n) at[i] += t;
          LightScales scales = {0.2};
          if (i == n) scales.log_amplitude += t;
          if (i > n) scales.log_roughness[i - n - 1] += t;
          return evaluate(at, scales, nullptr);
        },
        0.05)[0];
    // The lobes' tables are float.
    EXPECT_NEAR(numeric, gradient[i], 5e-3 * scale) << i;
  }
}

TEST_F(MarginalReflectanceTest, GradientMatchesDifferences) {
  const MarginalReflectance reflectance(FlowLobes::Factory(model_, 2, 1),
                                        points_, radiance_, LightProcess(),
                                        resolution_, 1, kLamps);
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
  const MarginalReflectance reflectance(CookTorranceLobes::Factory(1), points_,
                                        radiance_, LightProcess(), resolution_,
                                        1, kLamps);
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

TEST_F(MarginalReflectanceTest, ObjectiveIsWhitenedAndConsistent) {
  const MarginalReflectance reflectance(FlowLobes::Factory(model_, 2, 1),
                                        points_, radiance_, LightProcess(),
                                        resolution_, 1, kLamps);
  const MaterialPrior prior = JointMaterialPrior(model_, 2, 0.5);
  LightMode mode;
  const MarginalObjective objective(
      &reflectance, &prior,
      Eigen::VectorXd::Constant(3 * reflectance.cells().num_cells(), 0.01),
      &mode);
  ASSERT_EQ(23, objective.NumParameters());
  Eigen::VectorXd x(18);
  x << Eigen::Map<const Eigen::VectorXd>(truth_.data(), 14), 0.02, -0.03, 0.0,
      0.04;
  std::vector<double> y = objective.Whitened(x, {0.4});
  EXPECT_LT((objective.ParametersOf(y.data()) - x).norm(), 1e-9);
  EXPECT_LT((objective.LobesOf(y.data()) - x.head(14)).norm(), 1e-9);
  EXPECT_NEAR(0.4, objective.ScalesOf(y.data()).log_amplitude, 1e-12);
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

// G^T A^-1 G with G by differences of log E under the mode's light and A put
// together densely. A clamped colour and a code beyond the ball among them.
TEST_F(MarginalReflectanceTest, InformationMatchesDenseReference) {
  const MarginalReflectance reflectance(FlowLobes::Factory(model_, 2, 1),
                                        points_, radiance_, LightProcess(),
                                        resolution_, 1, kLamps);
  const int P = reflectance.cells().num_cells(), t = 128, s = t + 2;
  const int n = 18, all = n + LightScales::kCount;
  Eigen::VectorXd noise(3 * P);
  for (int i = 0; i < 3 * P; ++i) noise[i] = 0.002 + 1e-4 * (i % 7);
  const LightScales scales = {0.3, {-1.0, 0.3, 0.2, -0.5}};
  const LightProcess process;
  const MaterialPrior prior = JointMaterialPrior(model_, 2, 0.5);
  for (const bool extreme : {false, true}) {
    std::vector<double> x = truth_;
    x.insert(x.end(), {0.02, -0.03, 0.0, 0.04});
    if (extreme) {
      x[4] = LobeModel::kMaxLogColour + 5.0;
      x[7] = -1.4;
      x[12] = -40.0;
    }
    LightMode mode;
    ASSERT_TRUE(
        reflectance.Evaluate(x.data(), noise, scales, 1e-6, &mode, nullptr).ok);
    const Eigen::VectorXd L = (mode.l.array() + mode.level).exp();
    const auto radiance = [&](const std::vector<double>& at) {
      const std::array<RowMatrix, 3> T = reflectance.Matrices(at.data());
      Eigen::VectorXd E(3 * P);
      for (int c = 0; c < 3; ++c) {
        E.segment(c * P, P) = T[c] * L.segment(c * s, s);
      }
      return E;
    };
    RowMatrix G(3 * P, n);
    for (int i = 0; i < n; ++i) {
      // Along a lamp's way tables have kinks.
      const double h = i < 14 ? 0.01 : 0.001;
      std::vector<double> up = x, down = x;
      up[i] += h;
      down[i] -= h;
      G.col(i) =
          (radiance(up).array().log() - radiance(down).array().log()) / (2 * h);
    }
    const std::array<RowMatrix, 3> T = reflectance.Matrices(x.data());
    const Eigen::VectorXd E = radiance(x);
    Eigen::MatrixXd J = Eigen::MatrixXd::Zero(3 * P, 3 * s);
    Eigen::MatrixXd K1 = Eigen::MatrixXd::Zero(3 * s, 3 * s), K2(3 * s, 3 * s);
    LightProcess scaled = process;
    scaled.horizon_share = 0.0;
    const RowMatrix C = LightCorrelation(8, 16, scaled, scales);
    const RowMatrix horizon = LightCorrelation(8, 16, process, scales) - C;
    for (int c = 0; c < 3; ++c) {
      J.block(c * P, c * s, P, s) =
          E.segment(c * P, P).cwiseInverse().asDiagonal() * T[c] *
          L.segment(c * s, s).asDiagonal();
      for (int d = 0; d < 3; ++d) {
        K1.block(c * s, d * s, t, t) =
            std::exp(scales.log_amplitude) * process.Local()(c, d) * C;
        auto level = K2.block(c * s, d * s, s, s);
        level.setConstant(process.Level()(c, d));
        level.topLeftCorner(t, t) += std::exp(scales.log_amplitude) *
                                     process.Local()(c, d) * horizon;
        level.diagonal().tail(s - t).array() += process.Lamp()(c, d);
      }
    }
    const Eigen::MatrixXd A1 = J * K1 * J.transpose();
    Eigen::MatrixXd A = A1 + J * K2 * J.transpose();
    A.diagonal() += noise;
    const Eigen::LLT<Eigen::MatrixXd> llt(A);
    const Eigen::MatrixXd expected = G.transpose() * llt.solve(G);
    const Eigen::MatrixXd X = llt.solve(A1);
    const Eigen::MatrixXd found =
        reflectance.Information(x.data(), noise, scales, mode);
    ASSERT_EQ(all, found.rows());
    // Tables and sums of the renderer are float.
    EXPECT_LT((found.topLeftCorner(n, n) - expected).norm(),
              5e-3 * expected.norm());
    // A^-1 dA / d scale, the amplitude's and, by differences of K, the others'.
    std::vector<Eigen::MatrixXd> by = {X};
    for (int b = 0; b < LightScales::kBands; ++b) {
      const auto correlation = [&](double step) {
        LightScales moved = scales;
        moved.log_roughness[b] += step;
        return LightCorrelation(8, 16, process, moved);
      };
      const RowMatrix moved = (correlation(1e-4) - correlation(-1e-4)) / 2e-4;
      Eigen::MatrixXd K = Eigen::MatrixXd::Zero(3 * s, 3 * s);
      for (int c = 0; c < 3; ++c) {
        for (int d = 0; d < 3; ++d) {
          K.block(c * s, d * s, t, t) =
              std::exp(scales.log_amplitude) * process.Local()(c, d) * moved;
        }
      }
      by.push_back(llt.solve(J * K * J.transpose()));
    }
    for (int a = 0; a < LightScales::kCount; ++a) {
      for (int b = 0; b < LightScales::kCount; ++b) {
        EXPECT_NEAR(0.5 * (by[a] * by[b]).trace(), found(n + a, n + b),
                    1e-3 * std::sqrt(found(n + a, n + a) * found(n + b, n + b)))
            << a << " " << b;
      }
      EXPECT_EQ(0.0, found.row(n + a).head(n).norm());
    }
    if (extreme) {
      EXPECT_EQ(0.0, found.row(4).norm());
    }

    // Of the objective: the prior whitened, and the wall of that code.
    const MarginalObjective objective(&reflectance, &prior, noise, &mode);
    const std::vector<double> y = objective.Whitened(
        Eigen::Map<const Eigen::VectorXd>(x.data(), n), scales);
    Eigen::MatrixXd rest = objective.Information(y.data());
    ASSERT_EQ(all, rest.rows());
    Eigen::MatrixXd whitening = Eigen::MatrixXd::Zero(all, all);
    whitening.topLeftCorner(14, 14) = prior.factor;
    const auto stds = LightScales::Stds();
    for (int k = 0; k < LightScales::kCount; ++k) {
      whitening(n + k, n + k) = stds[k];
    }
    for (int i = 14; i < n; ++i) {
      whitening(i, i) = MarginalObjective::kLampOffsetStd;
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
                                        points_, radiance_, LightProcess(),
                                        resolution_, 1);
  const MaterialPrior prior = JointMaterialPrior(model_, 2, 0.5);
  const Eigen::VectorXd noise =
      Eigen::VectorXd::Constant(3 * reflectance.cells().num_cells(), 0.0025);
  for (const double away : {0.3, 4.0}) {
    LightMode mode;
    const MarginalObjective objective(&reflectance, &prior, noise, &mode);
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
    const MarginalObjective again(&reflectance, &prior, noise, &cold);
    const MarginalDescent step = Descend(again, options, &one);
    EXPECT_EQ(1, step.iterations);
    EXPECT_LE(descent.cost, step.cost);
    EXPECT_LT(step.cost, first);
  }
  // Stopped at once it is where it was.
  LightMode mode;
  const MarginalObjective objective(&reflectance, &prior, noise, &mode);
  std::vector<double> y(19, 0.1);
  MarginalDescentOptions options;
  options.should_stop = [] { return true; };
  const MarginalDescent stopped = Descend(objective, options, &y);
  EXPECT_TRUE(stopped.ok);
  EXPECT_EQ(0, stopped.iterations);
  EXPECT_EQ(std::vector<double>(19, 0.1), y);
}

// What Cook-Torrance rendered, from other materials.
TEST_F(MarginalReflectanceTest, SearchAmongCookTorranceExplainsItsOwn) {
  const auto paint = [](double roughness, double diffuse) {
    CookTorrance brdf;
    brdf.diffuse = diffuse * Eigen::Array3d(1.0, 0.7, 0.4);
    brdf.specular.setConstant(1.0);
    brdf.roughness.setConstant(roughness);
    brdf.f0.setConstant(0.2);
    return CookTorranceLobes::ToParameters(brdf);
  };
  TransportOptions transport;
  transport.grid = resolution_.grid;
  transport.num_threads = 1;
  const CookTorranceLobes lobes(resolution_.grid, 1);
  const std::vector<double> truth = paint(0.25, 0.1);
  std::vector<double> image(3 * points_.size());
  Transport(points_, 8, 16, transport)
      .Render(lobes.Grid(truth.data()), SmoothMap(8, 16).rgb.data(),
              image.data());
  std::vector<MaterialPrior::Material> materials;
  for (const double roughness : {0.1, 0.4, 0.8}) {
    for (const double diffuse : {0.03, 0.3}) {
      materials.push_back(
          {std::to_string(roughness), ToEigen(paint(roughness, diffuse))});
    }
  }
  MaterialPrior prior = GaussianPrior(materials, CookTorranceLobes::kCode);
  prior.wall = 0.0;
  const StatusOr<ReflectanceSearchResult> found = SearchReflectance(
      CookTorranceLobes::Factory(1), prior, points_, image, Options());
  ASSERT_TRUE(found.ok()) << found.status().message();
  EXPECT_LT(found->misfit, found->tried[0].first_misfit);
  ASSERT_EQ(10u, found->parameters.size());
  // All three resolutions are one: costs compare.
  for (const TriedMaterial& tried : found->tried) {
    EXPECT_LT(found->cost, tried.first_cost - 5.0) << tried.name;
  }
}

// The reflectance does not move, and the light of a lamp in dim surroundings
// is found with it.
TEST_F(MarginalReflectanceTest, SearchUnderAKnownReflectanceFindsTheLight) {
  CookTorrance paint;
  paint.diffuse = {0.1, 0.07, 0.04};
  paint.specular.setConstant(1.0);
  paint.roughness.setConstant(0.2);
  paint.f0.setConstant(0.2);
  const BrdfGrid known =
      BrdfGrid::FromFunction(paint.Function(), resolution_.grid);
  const std::vector<ShadingPoint> points = SpherePoints(24);
  Image map = SmoothMap(16, 32);
  double row = 0.0, column = 0.0;
  MapPosition(kLamps[0], 16, 32, &row, &column);
  row = std::floor(row);
  column = std::floor(column);
  const Eigen::Vector3d lamp = MapDirection(row + 0.5, column + 0.5, 16, 32);
  for (int c = 0; c < 3; ++c) {
    map.rgb[3 * static_cast<size_t>(row * 32 + column) + c] *= 200.0f;
  }
  TransportOptions transport;
  transport.grid = resolution_.grid;
  transport.num_threads = 1;
  std::vector<double> image(3 * points.size());
  Transport(points, 16, 32, transport)
      .Render(known, map.rgb.data(), image.data());
  ReflectanceSearchOptions options = Options();
  options.covariance = false;
  const std::vector<double> parameters = TableLobes::KnownParameters();
  const MaterialPrior prior = KnownMaterial({"known", ToEigen(parameters)}, 0);
  EXPECT_EQ(0.0, prior.Cost(ToEigen(parameters), nullptr));
  const StatusOr<ReflectanceSearchResult> found = SearchReflectance(
      TableLobes::Factory(known), prior, points, image, options);
  ASSERT_TRUE(found.ok()) << found.status().message();
  EXPECT_EQ("known", found->start);
  ASSERT_EQ(parameters.size(), found->parameters.size());
  for (size_t i = 0; i < parameters.size(); ++i) {
    EXPECT_NEAR(parameters[i], found->parameters[i], 1e-6);
  }
  ASSERT_FALSE(found->lamps.empty());
  EXPECT_GT(found->lamps[0].dot(lamp), std::cos(5.0 * M_PI / 180.0));
  // All resolutions are one: costs compare.
  EXPECT_LT(found->cost, found->tried[0].first_cost);
  EXPECT_LT(found->misfit, found->tried[0].first_misfit);
}

// No infinite cost gets into a trace either.
TEST_F(MarginalReflectanceTest, SearchUnderABlackReflectanceSaysSo) {
  const BrdfGrid black = BrdfGrid::FromFunction(
      [](double, double, double) { return Eigen::Array3d::Zero().eval(); },
      resolution_.grid);
  const MaterialPrior prior =
      KnownMaterial({"known", ToEigen(TableLobes::KnownParameters())}, 0);
  ReflectanceSearchOptions options = Options();
  int reports = 0;
  options.report = [&](const std::string&, double, double) { ++reports; };
  const StatusOr<ReflectanceSearchResult> found = SearchReflectance(
      TableLobes::Factory(black), prior, points_, radiance_, options);
  ASSERT_FALSE(found.ok());
  EXPECT_EQ(StatusCode::kNoImprovement, found.status().code());
  EXPECT_EQ(0, reports);
}

TEST_F(MarginalReflectanceTest, SearchLowersTheCostWhateverTheThreads) {
  const MaterialPrior prior = JointMaterialPrior(model_, 2, 0.5);
  ReflectanceSearchOptions options = Options();
  const StatusOr<ReflectanceSearchResult> one = SearchReflectance(
      FlowLobes::Factory(model_, 2, 1), prior, points_, radiance_, options);
  ASSERT_TRUE(one.ok()) << one.status().message();
  ASSERT_EQ(14u, one->parameters.size());
  ASSERT_EQ(4u, one->tried.size());
  EXPECT_EQ(one->tried[0].cost, one->cost);
  EXPECT_EQ(one->tried[0].name, one->start);
  EXPECT_EQ(one->tried[0].parameters, one->parameters);
  for (size_t i = 1; i < one->tried.size(); ++i) {
    EXPECT_LE(one->tried[i - 1].cost, one->tried[i].cost);
  }
  EXPECT_LT(one->misfit, 0.1);
  for (const double s : one->log_radiance_std) {
    EXPECT_TRUE(std::isfinite(s) && s >= 0.0);
  }
  ASSERT_EQ(14, one->covariance.rows());
  EXPECT_LT((one->covariance - one->covariance.transpose()).norm(),
            1e-9 * one->covariance.norm());
  const Eigen::LLT<Eigen::MatrixXd> llt(one->covariance);
  EXPECT_EQ(Eigen::Success, llt.info());
  // The image tells something: no direction is wider than the prior's twice.
  const Eigen::VectorXd prior_variance =
      (prior.factor * prior.factor.transpose()).diagonal();
  EXPECT_LT(one->covariance.trace(), prior_variance.sum());
  options.num_threads = 2;
  const StatusOr<ReflectanceSearchResult> two = SearchReflectance(
      FlowLobes::Factory(model_, 2, 1), prior, points_, radiance_, options);
  ASSERT_TRUE(two.ok());
  EXPECT_EQ(one->parameters, two->parameters);
  EXPECT_EQ(one->log_radiance, two->log_radiance);
}

// What the object throws on itself, told by the caller, is taken out.
TEST_F(MarginalReflectanceTest, BouncesAreTakenOutOfTheImage) {
  const MaterialPrior prior = JointMaterialPrior(model_, 2, 0.5);
  std::vector<double> gain(radiance_.size()), brighter = radiance_;
  for (size_t i = 0; i < gain.size(); ++i) {
    gain[i] = 1.0 + 0.8 * std::pow(std::sin(1.7 * (i / 3)), 2);
    brighter[i] *= gain[i];
  }
  ReflectanceSearchOptions options = Options();
  const ReflectanceSearchResult clean =
      SearchReflectance(FlowLobes::Factory(model_, 2, 1), prior, points_,
                        radiance_, options)
          .value();
  const ReflectanceSearchResult left =
      SearchReflectance(FlowLobes::Factory(model_, 2, 1), prior, points_,
                        brighter, options)
          .value();
  int calls = 0;
  options.bounce_gain = [&](const std::vector<double>& lobes,
                            const std::vector<double>& log_radiance) {
    ++calls;
    EXPECT_EQ(14u, lobes.size());
    EXPECT_EQ(size_t{3} * left.map_width * left.map_height,
              log_radiance.size());
    return gain;
  };
  const ReflectanceSearchResult taken =
      SearchReflectance(FlowLobes::Factory(model_, 2, 1), prior, points_,
                        brighter, options)
          .value();
  EXPECT_EQ(options.bounce_rounds, calls);
  EXPECT_GT(left.cost, clean.cost + 5.0);
  EXPECT_LT(taken.misfit, 1.2 * clean.misfit);
  // Lower where its rounds, of more iterations, came further.
  EXPECT_LT(taken.cost, clean.cost + 0.1 * (left.cost - clean.cost));
  // Where there is nothing to be had all stays.
  options.bounce_gain = [](const auto&, const auto&) {
    return std::vector<double>();
  };
  EXPECT_EQ(left.parameters,
            SearchReflectance(FlowLobes::Factory(model_, 2, 1), prior, points_,
                              brighter, options)
                .value()
                .parameters);
}

TEST_F(MarginalReflectanceTest, WiderMarginsNeverEndAtAHigherCost) {
  const MaterialPrior prior = JointMaterialPrior(model_, 2, 0.5);
  ReflectanceSearchOptions options = Options();
  options.covariance = false;
  options.coarse_margin = 1e9;
  options.margin = 0.0;
  const StatusOr<ReflectanceSearchResult> one = SearchReflectance(
      FlowLobes::Factory(model_, 2, 1), prior, points_, radiance_, options);
  options.margin = 1e9;
  const StatusOr<ReflectanceSearchResult> all = SearchReflectance(
      FlowLobes::Factory(model_, 2, 1), prior, points_, radiance_, options);
  ASSERT_TRUE(one.ok() && all.ok());
  EXPECT_LE(all->cost, one->cost);
  // What the narrow ones left where it was is refined now.
  double change = 0.0;
  for (const TriedMaterial& a : one->tried) {
    for (const TriedMaterial& b : all->tried) {
      if (a.name == b.name && std::isfinite(a.cost)) change += a.cost - b.cost;
    }
  }
  EXPECT_GT(change, 0.0);
}

TEST_F(MarginalReflectanceTest, StoppedSearchIsWhole) {
  const MaterialPrior prior = JointMaterialPrior(model_, 2, 0.5);
  ReflectanceSearchOptions options = Options();
  options.should_stop = [] { return true; };
  const StatusOr<ReflectanceSearchResult> found = SearchReflectance(
      FlowLobes::Factory(model_, 2, 1), prior, points_, radiance_, options);
  ASSERT_TRUE(found.ok()) << found.status().message();
  EXPECT_EQ(14u, found->parameters.size());
  EXPECT_EQ(14, found->covariance.rows());
}

TEST_F(MarginalReflectanceTest, ImageWithoutAUsablePixelIsNamed) {
  const MaterialPrior prior = JointMaterialPrior(model_, 2, 0.5);
  std::vector<double> bad = radiance_;
  for (size_t i = 0; i < bad.size(); i += 3) {
    bad[i] = i % 2 == 0 ? 0.0 : std::numeric_limits<double>::quiet_NaN();
  }
  const Status status = SearchReflectance(FlowLobes::Factory(model_, 2, 1),
                                          prior, points_, bad, Options())
                            .status();
  EXPECT_EQ(StatusCode::kInvalidInput, status.code());
  EXPECT_EQ(0u, status.message().find("image"));
}

TEST(ImageCells, RadianceIsTheMeanOfTheirPoints) {
  const std::vector<ShadingPoint> points = SpherePoints(20);
  std::vector<double> radiance;
  for (size_t i = 0; i < 3 * points.size(); ++i) radiance.push_back(1.0 + i);
  radiance[3 * 100 + 1] = -1.0;
  const ImageCells cells = GroupByNormal(points, radiance, {5, 3, 0.2});
  ASSERT_GT(cells.num_cells(), 10);
  ASSERT_LE(cells.num_cells(), 25);
  for (int i = 0; i < cells.num_cells(); ++i) {
    const int begin = cells.first[i], end = cells.first[i + 1];
    ASSERT_GT(end, begin);
    ASSERT_LE(end - begin, 3);
    double sum = 0.0;
    for (int k = begin; k < end; ++k) {
      EXPECT_NE(points[100].pixel, cells.points[k].pixel);
      EXPECT_GE(cells.points[k].normal.dot(cells.points[k].wo), 0.2f);
      const auto at = std::find_if(points.begin(), points.end(),
                                   [&](const ShadingPoint& p) {
                                     return p.pixel == cells.points[k].pixel;
                                   });
      sum += radiance[3 * (at - points.begin()) + 2];
      // Like normals: within a cell's diagonal.
      EXPECT_LT((cells.points[k].normal - cells.points[begin].normal)
                    .head<2>()
                    .norm(),
                0.4f * std::sqrt(2.0f) + 1e-3f);
    }
    EXPECT_NEAR(std::log(sum / (end - begin)),
                cells.log_radiance[2 * cells.num_cells() + i], 1e-12);
  }
}

TEST(MaterialPrior, CostAndResidualsAgreeInsideAndBeyondTheBall) {
  const NeuralBrdfModel model = TinyModel(8);
  for (const MaterialPrior& prior :
       {JointMaterialPrior(model, 2, 0.5), BallPrior(model, 2, 0.5)}) {
    const MaterialPriorCost cost(&prior);
    for (const double scale : {0.0, 0.3, 2.0, 1e3}) {
      Eigen::VectorXd x = prior.mean;
      for (Eigen::Index i = 0; i < x.size(); ++i) {
        x[i] += scale * std::cos(2.0 * i);
      }
      std::vector<double> r(cost.num_residuals()), J(r.size() * x.size());
      const double* block[] = {x.data()};
      double* jacobian[] = {J.data()};
      ASSERT_TRUE(cost.Evaluate(block, r.data(), jacobian));
      Eigen::VectorXd gradient = Eigen::VectorXd::Zero(x.size());
      const double value = prior.Cost(x, &gradient);
      double half = 0.0;
      Eigen::VectorXd by_residuals = Eigen::VectorXd::Zero(x.size());
      for (size_t i = 0; i < r.size(); ++i) {
        half += 0.5 * r[i] * r[i];
        for (Eigen::Index j = 0; j < x.size(); ++j) {
          by_residuals[j] += r[i] * J[i * x.size() + j];
        }
      }
      EXPECT_NEAR(value, half, 1e-9 * (1 + half));
      EXPECT_LT((gradient - by_residuals).norm(), 1e-9 * (1 + gradient.norm()));
      for (const Eigen::Index i : {0, 6, 9}) {
        const double h = 1e-5 * (1 + scale);
        Eigen::VectorXd up = x, down = x;
        up[i] += h;
        down[i] -= h;
        EXPECT_NEAR(
            (prior.Cost(up, nullptr) - prior.Cost(down, nullptr)) / (2 * h),
            gradient[i], 1e-5 * (1 + gradient.norm()));
      }
    }
  }
}

TEST(MaterialPrior, KnowsHowLobesGoTogether) {
  NeuralBrdfModel model = TinyModel(40);
  model.fit_lobes = 2;
  for (int m = 0; m < 40; ++m) {
    for (int i = 0; i < 14; ++i) {
      model.lobe_fits.push_back(0.3f * std::sin(static_cast<float>(m * i)));
    }
    // The second lobe's red follows the first one's.
    model.lobe_fits[m * 14 + 11] = model.lobe_fits[m * 14 + 4];
  }
  const MaterialPrior prior = JointMaterialPrior(model, 2, 0.5);
  Eigen::VectorXd together = Eigen::VectorXd::Zero(14), apart = together;
  const double std = prior.factor.row(4).norm();
  together[4] = together[11] = apart[4] = std;
  apart[11] = -std;
  EXPECT_LT(prior.Cost(prior.mean + together, nullptr),
            0.5 * prior.Cost(prior.mean + apart, nullptr));
  // A third lobe is its own.
  const MaterialPrior three = JointMaterialPrior(model, 3, 0.5);
  ASSERT_EQ(21, three.num_parameters());
  EXPECT_EQ(0.0, three.factor.block(14, 0, 7, 14).norm());
  for (const MaterialPrior::Material& m : three.materials) {
    EXPECT_EQ(21, m.parameters.size());
  }
}

TEST(MaterialLobes, AreSortedFiniteAndCloseToTheirMaterial) {
  NeuralBrdfModel model = TinyModel(2);
  ASSERT_TRUE(FitMaterialLobes(2, 2, nullptr, &model).ok());
  EXPECT_EQ(2, model.fit_lobes);
  ASSERT_EQ(2u * 2 * 7, model.lobe_fits.size());
  for (const float v : model.lobe_fits) EXPECT_TRUE(std::isfinite(v));
  NeuralBrdfModel again = TinyModel(2);
  ASSERT_TRUE(FitMaterialLobes(2, 1, nullptr, &again).ok());
  EXPECT_EQ(model.lobe_fits, again.lobe_fits);
  const std::atomic<bool> stop{true};
  EXPECT_EQ(StatusCode::kInterrupted,
            FitMaterialLobes(1, 1, &stop, &again).code());
  EXPECT_EQ(model.lobe_fits, again.lobe_fits);
}

TEST_F(MarginalReflectanceTest, KnownLightRanksTheMaterialThatMadeTheImage) {
  const MaterialPrior prior = JointMaterialPrior(model_, 2, 0.5);
  const FlowLobes lobes(model_, 2, resolution_.grid, 1);
  TransportOptions options;
  options.grid = resolution_.grid;
  options.num_threads = 1;
  const Transport transport(points_, 8, 16, options);
  const std::vector<float> map = SmoothMap(8, 16).rgb;
  for (size_t m = 0; m < prior.materials.size(); ++m) {
    std::vector<double> E;
    // Brighter than the material: the level is no part of the comparison.
    Eigen::VectorXd x = prior.materials[m].parameters;
    for (const int i : {4, 5, 6, 11, 12, 13}) x[i] += 1.5;
    ASSERT_TRUE(
        RenderLobeModel(transport, lobes, x.data(), map.data(), &E, nullptr));
    RobustLogLikelihood likelihood;
    likelihood.scale = 0.02;
    const std::vector<RankedMaterial> ranked = RankUnderKnownLight(
        transport, lobes, prior, map, MakeObservations(E), likelihood);
    ASSERT_EQ(prior.materials.size(), ranked.size());
    EXPECT_EQ(prior.materials[m].name, ranked[0].name);
    EXPECT_NEAR(x[4], ranked[0].parameters[4], 1e-3);
    for (size_t k = 1; k < ranked.size(); ++k) {
      EXPECT_LE(ranked[k - 1].cost, ranked[k].cost);
    }
  }
}

}  // namespace
}  // namespace ibrdf
