// Samples of the model that ships, against its densities.
#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <numeric>
#include <string>
#include <vector>

#include "ibrdf/flow/brdf_flow.h"
#include "ibrdf/io/model_file.h"
#include "tests/support/flow_cells.h"
#include "tests/support/flow_sampling.h"
#include "tests/support/statistics.h"

namespace ibrdf {
namespace {

constexpr double kLevel = 1e-3;  // seeds are fixed
constexpr int64_t kSamples = 30000;
constexpr double kMassTolerance = 1e-9;  // differences telescope
// Double precision of integrals in [0, 1].
constexpr double kLatentTolerance = 1e-12;
// A latent number of double precision times the inverse density; and float
// inputs of conditioners.
constexpr double kPointTolerance = 1e-5;

class TrainedSampling : public ::testing::Test {
 protected:
  void SetUp() override {
    const StatusOr<std::string> path = FindModel("default");
    if (!path.ok()) GTEST_SKIP() << "NOT TESTED: " << path.status().message();
    StatusOr<NeuralBrdfModel> model = ReadModel(*path);
    if (!model.ok()) GTEST_SKIP() << "NOT TESTED: " << model.status().message();
    model_ = *std::move(model);
    flow_ = BrdfFlow::Create(model_.shape, model_.weights);
  }
  const float* Code(int i) const {
    return model_.codes.data() +
           static_cast<size_t>(i) * model_.shape.code_size();
  }

  NeuralBrdfModel model_;
  std::unique_ptr<BrdfFlow> flow_;
};

TEST_F(TrainedSampling, SamplesPassChiSquareAndThoseOfAnotherCodeDoNot) {
  const CubeCells cells;
  const int step = std::max(1, model_.num_codes() / 4);
  int tested = 0;
  for (int i = 0; i < model_.num_codes(); i += step, ++tested) {
    SCOPED_TRACE(model_.names[i]);
    const std::vector<double> probability =
        CellProbabilitiesByLatent(*flow_, Code(i), cells, 20);
    EXPECT_NEAR(std::accumulate(probability.begin(), probability.end(), 0.0),
                1.0, kMassTolerance);
    std::vector<double> x(3 * kSamples);
    SampleFlow(*flow_, Code(i), 100 + i, kSamples, 1, x.data());
    const ChiSquareResult own =
        ChiSquareTest(CellCounts(x, cells), probability);
    // Bonferroni: some four codes share the level.
    EXPECT_GT(own.p_value, kLevel / 4) << own.statistic << " " << own.degrees;
    const int other = (i + step) % model_.num_codes();
    SampleFlow(*flow_, Code(other), 100 + i, kSamples, 1, x.data());
    EXPECT_LT(ChiSquareTest(CellCounts(x, cells), probability).p_value, 1e-9);
  }
  EXPECT_GE(tested, std::min(4, model_.num_codes()));
}

TEST_F(TrainedSampling, InverseUndoesLatentOnTheClosedCube) {
  const std::vector<double> lattice = LatticeOfCube(7);
  const int64_t n = static_cast<int64_t>(lattice.size() / 3);
  const std::vector<float> points(lattice.begin(), lattice.end());
  for (int i = 0; i < model_.num_codes(); i += 7) {
    SCOPED_TRACE(model_.names[i]);
    std::vector<double> u(lattice.size()), x(lattice.size());
    std::vector<float> log_density(n);
    flow_->LogDensity(points.data(), n, Code(i), 1, log_density.data(), nullptr,
                      nullptr);
    flow_->Latent(lattice.data(), n, Code(i), 1, u.data());
    flow_->Inverse(u.data(), n, Code(i), 1, x.data());
    for (size_t k = 0; k < lattice.size(); ++k) {
      // Where a density is next to nothing the latent point cannot tell.
      const double lost =
          kLatentTolerance * std::exp(-static_cast<double>(log_density[k % n]));
      ASSERT_NEAR(x[k], lattice[k], kPointTolerance + lost) << k % n;
    }
    flow_->Inverse(lattice.data(), n, Code(i), 1, x.data());
    flow_->Latent(x.data(), n, Code(i), 1, u.data());
    for (size_t k = 0; k < lattice.size(); ++k) {
      ASSERT_GE(x[k], 0.0);
      ASSERT_LE(x[k], 1.0);
      ASSERT_NEAR(u[k], lattice[k], kLatentTolerance * 100) << k % n;
    }
  }
}

}  // namespace
}  // namespace ibrdf
