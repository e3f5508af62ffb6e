#include "ibrdf/solvers/estimation/known_light_covariance.h"

#include <gtest/gtest.h>

#include <Eigen/Dense>
#include <cmath>
#include <limits>

#include "ibrdf/base/eigen_vectors.h"
#include "ibrdf/solvers/costs/log_radiance_cost.h"
#include "ibrdf/solvers/marginal/reflectance_search.h"
#include "tests/marginal/marginal_testing.h"

namespace ibrdf {
namespace {
using namespace testing;  // NOLINT

class KnownLightCovarianceTest : public MarginalTest {
 protected:
  TransportOptions Options() const {
    TransportOptions options;
    options.grid = resolution_.grid;
    options.num_threads = 1;
    return options;
  }
  std::vector<double> Render(const std::vector<double>& x) const {
    std::vector<double> L_o;
    EXPECT_TRUE(RenderLobeModel(transport_, lobes_, x.data(), map_.data(), &L_o,
                                nullptr));
    return L_o;
  }
  Eigen::MatrixXd Covariance(const Observations& observed) const {
    return KnownLightCovariance(transport_, lobes_, prior_, map_, observed,
                                likelihood_, x_);
  }

  const MaterialPrior prior_ = JointMaterialPrior(model_, 2, 0.5);
  const FlowLobes lobes_{model_, 2, resolution_.grid, 1};
  const Transport transport_{points_, 8, 16, Options()};
  const std::vector<float> map_ = SmoothMap(8, 16).rgb;
  const std::vector<double> x_ = ToVector(prior_.materials[0].parameters);
  RobustLogLikelihood likelihood_;
};

// Against the dense formula with a Jacobian of differences.
TEST_F(KnownLightCovarianceTest, IsTheInverseOfTheHessian) {
  likelihood_.scale = 0.05;
  likelihood_.epsilon = 1e-4;
  std::vector<double> radiance = Render(x_);
  radiance[3 * 5 + 1] = std::numeric_limits<double>::quiet_NaN();
  const Observations observed = MakeObservations(radiance);
  const auto n = static_cast<Eigen::Index>(x_.size());
  Eigen::MatrixXd G(3 * points_.size(), n);
  for (Eigen::Index k = 0; k < n; ++k) {
    constexpr double kStep = 1e-4;
    std::vector<double> up = x_, down = x_;
    up[k] += kStep;
    down[k] -= kStep;
    const std::vector<double> high = Render(up), low = Render(down);
    for (Eigen::Index i = 0; i < G.rows(); ++i) {
      const bool used = observed.valid[i / 3];
      G(i, k) = used ? std::log((high[i] + likelihood_.epsilon) /
                                (low[i] + likelihood_.epsilon)) /
                           (2 * kStep)
                     : 0.0;
    }
  }
  const double model = ReflectanceSearchOptions().sigma;
  const double weight = std::min(1.0, 200.0 / observed.num_valid) /
                        (2 * 0.05 * 0.05 + model * model);
  const Eigen::MatrixXd factor =
      prior_.factor.triangularView<Eigen::Lower>().toDenseMatrix();
  const Eigen::MatrixXd expected =
      (weight * G.transpose() * G + (factor * factor.transpose()).inverse())
          .inverse();
  const Eigen::MatrixXd found = Covariance(observed);
  ASSERT_EQ(n, found.rows());
  // The flow is float: differences of 1e-4 are good to some 1e-3.
  EXPECT_LT((found - expected).norm(), 0.02 * expected.norm());
}

// Less noise tells more, along every direction; pixels that are clipped say
// nothing here.
TEST_F(KnownLightCovarianceTest, FallsWithTheNoise) {
  const std::vector<double> radiance = Render(x_);
  const Observations exact = MakeObservations(radiance);
  likelihood_.scale = 0.5;
  const Eigen::MatrixXd noisy = Covariance(exact);
  likelihood_.scale = 0.01;
  const Eigen::MatrixXd clear = Covariance(exact);
  const Eigen::VectorXd gained =
      Eigen::SelfAdjointEigenSolver<Eigen::MatrixXd>(noisy - clear)
          .eigenvalues();
  EXPECT_GT(gained.minCoeff(), -1e-9);
  EXPECT_GT(gained.maxCoeff(), 0.01);
  const Observations clipped = MakeObservations(
      radiance, radiance,
      std::vector<double>(radiance.size(),
                          std::numeric_limits<double>::infinity()));
  const Eigen::MatrixXd factor =
      prior_.factor.triangularView<Eigen::Lower>().toDenseMatrix();
  EXPECT_LT((Covariance(clipped) - factor * factor.transpose()).norm(), 1e-9);
}

}  // namespace
}  // namespace ibrdf
