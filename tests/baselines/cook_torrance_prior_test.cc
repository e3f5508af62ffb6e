#include "ibrdf/solvers/baselines/cook_torrance_prior.h"

#include <gtest/gtest.h>

#include <Eigen/Dense>
#include <vector>

#include "ibrdf/base/eigen_vectors.h"
#include "ibrdf/brdf/cook_torrance_lobes.h"
#include "ibrdf/brdf/flow_lobes.h"
#include "ibrdf/metrics/brdf_metrics.h"
#include "ibrdf/solvers/training/material_lobes.h"
#include "tests/support/tiny_model.h"

namespace ibrdf {
namespace {

constexpr BrdfGridShape kNoGrid{2, 2, 1};

NeuralBrdfModel Fitted(int materials) {
  NeuralBrdfModel model = TinyModel(materials);
  model.fit_lobes = 2;
  for (int i = 0; i < materials * 14; ++i) {
    model.lobe_fits.push_back(
        static_cast<float>(i % 7 < 4 ? 0.3 * std::sin(i) : 1 + std::cos(i)));
  }
  return model;
}

TEST(CookTorrancePrior, MaterialsAreFitsOfTheModels) {
  const NeuralBrdfModel model = Fitted(4);
  const StatusOr<MaterialPrior> prior = CookTorrancePrior(model, 2);
  ASSERT_TRUE(prior.ok()) << prior.status().message();
  ASSERT_EQ(4u, prior->materials.size());
  EXPECT_EQ(10, prior->num_parameters());
  EXPECT_EQ(2, prior->num_lobes());
  const FlowLobes flow(model, 2, kNoGrid, 1);
  const CookTorranceLobes lobes(kNoGrid, 1);
  Eigen::VectorXd mean = Eigen::VectorXd::Zero(10);
  for (int m = 0; m < 4; ++m) {
    const Eigen::VectorXd& x = prior->materials[m].parameters;
    mean += x / 4;
    const std::vector<double> of_flow(model.lobe_fits.begin() + 14 * m,
                                      model.lobe_fits.begin() + 14 * (m + 1));
    const auto error = [&](const Eigen::VectorXd& at) {
      return CompareBrdfs(lobes.ToMerl(at.data()), flow.ToMerl(of_flow.data()))
          .value()
          .log_rmse;
    };
    // The least that Cook-Torrance reaches, of bins drawn: no step away is
    // better by more than what the drawing leaves.
    const double least = error(x);
    for (const int k : {2, 5, 6, 9}) {
      for (const double step : {0.3, -0.3}) {
        Eigen::VectorXd moved = x;
        moved[k] += step;
        EXPECT_GT(error(moved), 0.995 * least) << m << " " << k;
      }
    }
  }
  EXPECT_LT((prior->mean - mean).norm(), 1e-12);
  // The Lambertian's code is of its own.
  EXPECT_TRUE(prior->factor.block(2, 0, 8, 2).isZero(1e-12));
  EXPECT_TRUE(prior->factor.topLeftCorner(2, 2).isIdentity(1e-12));
  EXPECT_GT(prior->factor.diagonal().minCoeff(), 0.0);
  Eigen::VectorXd far = prior->mean;
  far.segment<2>(5).array() += 5.0;
  EXPECT_EQ(0.0, prior->WallCost(far, nullptr));
}

TEST(CookTorrancePrior, ModelsWithoutFitsAreRefused) {
  for (const NeuralBrdfModel& model : {TinyModel(4), Fitted(2)}) {
    const Status status = CookTorrancePrior(model, 1).status();
    EXPECT_EQ(StatusCode::kInvalidInput, status.code());
    EXPECT_NE(std::string::npos, status.message().find("model"));
  }
}

}  // namespace
}  // namespace ibrdf
