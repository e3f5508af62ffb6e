// Several materials in one light.
#include <gtest/gtest.h>

#include <Eigen/Dense>
#include <cmath>

#include "ibrdf/base/eigen_vectors.h"
#include "ibrdf/brdf/flow_lobes.h"
#include "ibrdf/solvers/marginal/reflectance_search.h"
#include "ibrdf/solvers/priors/repeated_prior.h"
#include "tests/marginal/marginal_testing.h"

namespace ibrdf {
namespace {
using namespace testing;  // NOLINT

// Costs are of the same bins in another order.
constexpr double kSumTolerance = 1e-6;

class MarginalMaterialsTest : public MarginalTest {
 protected:
  // The left half of the sphere is material `left`, the rest `right`: an edge
  // of bins is between them, so that no bin is split.
  std::vector<ShadingPoint> Halves(int left, int right) const {
    std::vector<ShadingPoint> points = points_;
    for (ShadingPoint& p : points) {
      p.material = p.normal.x() < 0.0f ? left : right;
    }
    return points;
  }
  MarginalReflectance Materials(const std::vector<ShadingPoint>& points,
                                int count) const {
    return MarginalReflectance(FlowLobes::Factory(model_, 2, 1), points,
                               MakeObservations(radiance_), LightProcess(),
                               resolution_, 1, kDirectionalLights, std::nullopt,
                               count);
  }
  MarginalReflectance One() const {
    return MarginalReflectance(FlowLobes::Factory(model_, 2, 1), points_,
                               MakeObservations(radiance_), LightProcess(),
                               resolution_, 1, kDirectionalLights);
  }
  // Lobes of each material, and where the directional lights are.
  std::vector<double> Parameters(
      const std::vector<std::vector<double>>& materials) const {
    std::vector<double> all;
    for (const std::vector<double>& m : materials) {
      all.insert(all.end(), m.begin(), m.end());
    }
    all.insert(all.end(), {0.02, -0.03, 0.0, 0.04});
    return all;
  }
  std::vector<double> Other() const {
    std::vector<double> other = truth_;
    for (size_t i = 0; i < other.size(); ++i) other[i] += 0.3 * std::cos(2 * i);
    return other;
  }
  DataErrors Errors(const MarginalReflectance& reflectance) const {
    return {Eigen::VectorXd::Constant(3 * reflectance.bins().num_bins(), 0.01),
            {}};
  }
  double Cost(const MarginalReflectance& reflectance,
              const std::vector<double>& x, std::vector<double>* gradient,
              LightMode* mode) const {
    const MarginalValue value = reflectance.Evaluate(
        x.data(), Errors(reflectance), {0.2}, 1e-12, mode, gradient);
    EXPECT_TRUE(value.ok);
    return value.cost;
  }
};

TEST_F(MarginalMaterialsTest, GradientMatchesDifferences) {
  const MarginalReflectance reflectance = Materials(Halves(0, 1), 2);
  ASSERT_EQ(32, reflectance.num_parameters());
  ExpectGradient(reflectance, Parameters({truth_, Other()}),
                 {0, 4, 8, 12, 14, 17, 18, 22, 25, 27, 28, 29, 30, 31});
}

// Each has a Lambertian lobe of its own.
TEST_F(MarginalMaterialsTest, GradientWithLambertianLobesMatchesDifferences) {
  const LobeLayout layout = LobeLayout{1, 4}.WithLambertian();
  const MarginalReflectance reflectance(
      FlowLobes::Factory(model_, layout, 1), Halves(0, 1),
      MakeObservations(radiance_), LightProcess(), resolution_, 1,
      kDirectionalLights, std::nullopt, 2);
  ASSERT_EQ(24, reflectance.num_parameters());
  std::vector<double> a(truth_.begin(), truth_.begin() + 7);
  a.insert(a.end(), {3.0, 2.5, 2.8});
  std::vector<double> b = a;
  for (size_t i = 0; i < b.size(); ++i) b[i] += 0.3 * std::cos(2 * i);
  ExpectGradient(reflectance, Parameters({a, b}),
                 {1, 5, 7, 9, 10, 13, 16, 17, 19, 20, 23});
  // The wall of every code, and of no colour.
  MaterialPrior one;
  one.code_size = 4;
  one.mean = Eigen::VectorXd::Zero(10);
  one.factor = Eigen::MatrixXd::Identity(10, 10);
  Eigen::VectorXd x = Eigen::VectorXd::Zero(20);
  x.segment(10, 4).setConstant(1.0);  // length 2
  Eigen::VectorXd gradient = Eigen::VectorXd::Zero(20);
  const MaterialPrior two = RepeatPrior(one, 2);
  EXPECT_NEAR(0.5 * one.wall * one.wall, two.WallCost(x, &gradient), 1e-9);
  EXPECT_NEAR(0.5 * one.wall * one.wall, gradient[10], 1e-9);
  EXPECT_EQ(0.0, gradient.head(10).norm() + gradient.tail(6).norm());
}

// The derivatives are then sums over the materials.
TEST_F(MarginalMaterialsTest, MaterialsThatAreAlikeAreOne) {
  const MarginalReflectance one = One(), two = Materials(Halves(0, 1), 2);
  ASSERT_EQ(one.bins().num_bins(), two.bins().num_bins());
  const std::vector<double> x = Parameters({Other()}),
                            xx = Parameters({Other(), Other()});
  LightMode mode, mode2;
  std::vector<double> gradient, gradient2;
  const double cost = Cost(one, x, &gradient, &mode);
  EXPECT_NEAR(cost, Cost(two, xx, &gradient2, &mode2),
              kSumTolerance * std::abs(cost));
  Eigen::MatrixXd join = Eigen::MatrixXd::Zero(37, 23);
  join.topLeftCorner(14, 14).setIdentity();
  join.block(14, 0, 14, 14).setIdentity();
  join.bottomRightCorner(9, 9).setIdentity();
  EXPECT_LT((join.transpose() * ToEigen(gradient2) - ToEigen(gradient)).norm(),
            1e-4 * Norm(gradient));
  const Eigen::MatrixXd information =
      one.Information(x.data(), Errors(one), {0.2}, mode);
  const Eigen::MatrixXd of_two =
      two.Information(xx.data(), Errors(two), {0.2}, mode2);
  ASSERT_EQ(37, of_two.rows());
  EXPECT_LT((join.transpose() * of_two * join - information).norm(),
            1e-4 * information.norm());
  EXPECT_GT(of_two.block(0, 14, 14, 14).norm(), 0.0);  // through the light
}

TEST_F(MarginalMaterialsTest, OrderOfTheLabelsDoesNotMatter) {
  const MarginalReflectance ab = Materials(Halves(0, 1), 2),
                            ba = Materials(Halves(1, 0), 2);
  LightMode mode, mode2;
  std::vector<double> gradient, gradient2;
  const double cost = Cost(ab, Parameters({truth_, Other()}), &gradient, &mode);
  EXPECT_NEAR(cost, Cost(ba, Parameters({Other(), truth_}), &gradient2, &mode2),
              kSumTolerance * std::abs(cost));
  const double norm = Norm(gradient);
  for (int i = 0; i < 28; ++i) {
    EXPECT_NEAR(gradient[i], gradient2[(i + 14) % 28], 1e-4 * norm) << i;
  }
  // And it is not the cost of the materials the other way round.
  EXPECT_GT(
      std::abs(cost - Cost(ab, Parameters({Other(), truth_}), nullptr, &mode2)),
      1.0);
}

TEST_F(MarginalMaterialsTest, AMaterialWithoutBinsTellsNothing) {
  const MarginalReflectance two = Materials(Halves(0, 1), 2),
                            three = Materials(Halves(0, 2), 3);
  LightMode mode, mode2;
  std::vector<double> gradient;
  const double cost = Cost(two, Parameters({truth_, Other()}), nullptr, &mode);
  const std::vector<double> x = Parameters({truth_, truth_, Other()});
  EXPECT_NEAR(cost, Cost(three, x, &gradient, &mode2),
              kSumTolerance * std::abs(cost));
  for (int i = 14; i < 28; ++i) EXPECT_EQ(0.0, gradient[i]) << i;
  const Eigen::MatrixXd information =
      three.Information(x.data(), Errors(three), {0.2}, mode2);
  EXPECT_EQ(0.0, information.middleRows(14, 14).norm());
}

TEST_F(MarginalMaterialsTest, PriorIsOfEachMaterialByItself) {
  const MaterialPrior one = JointMaterialPrior(model_, 2, 0.5);
  const MaterialPrior two = RepeatPrior(one, 2);
  const Eigen::VectorXd a = ToEigen(truth_);
  Eigen::VectorXd b = ToEigen(Other());
  b.head(4).setConstant(0.9);  // beyond the ball
  Eigen::VectorXd both(28);
  both << a, b;
  const double expected = one.Cost(a, nullptr) + one.Cost(b, nullptr);
  EXPECT_NEAR(expected, two.Cost(both, nullptr), 1e-9 * expected);
}

// A search from materials of which one pair is the truth.
TEST_F(MarginalMaterialsTest, SearchFindsBoth) {
  const std::vector<ShadingPoint> points = Halves(0, 1);
  std::vector<double> radiance = radiance_;
  std::vector<double> bright = Other();
  const std::vector<double> of_other = [&] {
    TransportOptions options;
    options.grid = TinyTransportOptions().grid;
    options.num_threads = 1;
    std::vector<double> L_o(3 * points.size());
    Transport(points, 8, 16, options)
        .Render(FlowLobes(model_, 2, options.grid, 1).Grid(bright.data()),
                SmoothMap(8, 16).rgb.data(), L_o.data());
    return L_o;
  }();
  for (size_t i = 0; i < radiance.size(); ++i) {
    if (points[i / 3].material == 1) radiance[i] = of_other[i];
  }
  MaterialPrior prior = RepeatPrior(JointMaterialPrior(model_, 2, 0.5), 2);
  const auto pair = [&](const std::string& name, const std::vector<double>& a,
                        const std::vector<double>& b) {
    Eigen::VectorXd both(28);
    both << ToEigen(a), ToEigen(b);
    prior.materials.push_back({name, both});
  };
  pair("swapped", bright, truth_);
  pair("right", truth_, bright);
  ReflectanceSearchOptions options;
  options.screen = options.coarse = options.fine = resolution_;
  options.num_threads = 1;
  options.num_materials = 2;
  options.most_directional_lights = 0;
  const StatusOr<ReflectanceSearchResult> found =
      SearchReflectance({FlowLobes::Factory(model_, 2, 1), &prior}, points,
                        MakeObservations(radiance), options);
  ASSERT_TRUE(found.ok()) << found.status().message();
  EXPECT_EQ("right", found->initial_guess);
  EXPECT_LT(found->misfit, 0.03);
  EXPECT_EQ(28, found->covariance.rows());
  ASSERT_FALSE(found->candidates.empty());
  // The level that the candidate's light has.
  const Eigen::Array3d level = found->candidates.front().light_level;
  EXPECT_TRUE(level.isFinite().all());
  EXPECT_GT(level.abs().maxCoeff(), 0.0);
}

}  // namespace
}  // namespace ibrdf
