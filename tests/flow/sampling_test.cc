
#include <gtest/gtest.h>

#include <numeric>
#include <vector>

#include "tests/support/flow_cells.h"
#include "tests/support/flow_sampling.h"
#include "tests/support/small_flow.h"
#include "tests/support/statistics.h"

namespace ibrdf {
namespace {

// Seeds are fixed: a right program passes always; the level says how unlikely a
// draw the fixed one may be.
constexpr double kLevel = 1e-3;
constexpr int64_t kSamples = 200000;
// Midpoint rule on densities with kinks, in all cells together.
constexpr double kMassTolerance = 6e-4;
// Latent numbers are double precision sums of a few terms.
constexpr double kLatentTolerance = 1e-13;
// A coordinate that differs in its last bits may reach the conditioner of the
// next as a neighbouring float.
constexpr double kPointTolerance = 1e-6;

// The range of the splines' heights: densities of several orders of magnitude.
constexpr float kCurvature = 12.0f;

std::unique_ptr<BrdfFlow> SmallFlow(float curvature) {
  const NeuralBrdfModel model = SmallFlowModel(curvature);
  return BrdfFlow::Create(model.shape, model.weights);
}

const float kCode[3] = {0.5f, -0.3f, 0.6f};
const float kOtherCode[3] = {0.45f, -0.3f, 0.6f};

TEST(Statistics, TailsAreThoseOfTables) {
  // Critical values of the 5 % and 0.1 % levels.
  EXPECT_NEAR(ChiSquareTail(3.841459, 1), 0.05, 1e-7);
  EXPECT_NEAR(ChiSquareTail(18.307038, 10), 0.05, 1e-7);
  EXPECT_NEAR(ChiSquareTail(149.449253, 100), 0.001, 1e-7);
  EXPECT_NEAR(ChiSquareTail(70.064890, 100), 0.99, 1e-7);
  // 1.3581 and 1.9495 over sqrt(n), for large n.
  EXPECT_NEAR(KolmogorovTail(1.3581e-3, 1000000), 0.05, 1e-4);
  EXPECT_NEAR(KolmogorovTail(1.9495e-3, 1000000), 0.001, 1e-4);
}

TEST(Sampling, SamplesPassChiSquareAgainstTheDensity) {
  const auto flow = SmallFlow(kCurvature);
  const CubeCells cells;
  const std::vector<double> probability =
      CellProbabilities(*flow, kCode, cells);
  EXPECT_NEAR(std::accumulate(probability.begin(), probability.end(), 0.0), 1.0,
              kMassTolerance);
  // Far from uniform, or the test would say little.
  EXPECT_GT(*std::max_element(probability.begin(), probability.end()),
            10.0 / cells.count());
  std::vector<double> x(3 * kSamples);
  SampleFlow(*flow, kCode, 11, kSamples, 1, x.data());
  const ChiSquareResult result =
      ChiSquareTest(CellCounts(x, cells), probability);
  EXPECT_GT(result.degrees, 150);
  EXPECT_GT(result.p_value, kLevel)
      << result.statistic << " with " << result.degrees;
  EXPECT_LT(result.p_value, 1.0 - kLevel);
}

TEST(Sampling, ChiSquareRejectsTheDensityOfACloseCode) {
  const auto flow = SmallFlow(kCurvature);
  const CubeCells cells;
  std::vector<double> x(3 * kSamples);
  SampleFlow(*flow, kOtherCode, 11, kSamples, 1, x.data());
  const ChiSquareResult result = ChiSquareTest(
      CellCounts(x, cells), CellProbabilities(*flow, kCode, cells));
  EXPECT_LT(result.p_value, 1e-9) << result.statistic;
}

// The test by axes: latent coordinates of the code's own samples are uniform,
// and not all of those of another code's samples.
TEST(Sampling, LatentCoordinatesOfSamplesAreUniform) {
  const auto flow = SmallFlow(kCurvature);
  std::vector<double> x(3 * kSamples), u(3 * kSamples);
  for (const bool right : {true, false}) {
    SampleFlow(*flow, right ? kCode : kOtherCode, 23, kSamples, 1, x.data());
    flow->Latent(x.data(), kSamples, kCode, 1, u.data());
    double least = 1.0;
    for (int dim = 0; dim < 3; ++dim) {
      least =
          std::min(least, UniformityPValue({u.begin() + dim * kSamples,
                                            u.begin() + (dim + 1) * kSamples}));
    }
    if (right) {
      EXPECT_GT(least, kLevel);
    } else {
      EXPECT_LT(least, 1e-9);
    }
  }
}

TEST(Sampling, MarginalsAgreeWithTheDensityPerAxis) {
  const auto flow = SmallFlow(kCurvature);
  const CubeCells cells;
  const std::vector<double> probability =
      CellProbabilities(*flow, kCode, cells);
  std::vector<double> x(3 * kSamples);
  SampleFlow(*flow, kCode, 31, kSamples, 1, x.data());
  const std::vector<int64_t> counts = CellCounts(x, cells);
  for (int axis = 0; axis < 3; ++axis) {
    const int size = axis == 0 ? cells.h : axis == 1 ? cells.d : cells.p;
    std::vector<double> p(size, 0.0);
    std::vector<int64_t> n(size, 0);
    for (int i = 0; i < cells.count(); ++i) {
      const int at = axis == 0   ? i / (cells.d * cells.p)
                     : axis == 1 ? i / cells.p % cells.d
                                 : i % cells.p;
      p[at] += probability[i];
      n[at] += counts[i];
    }
    EXPECT_GT(ChiSquareTest(n, p).p_value, kLevel) << axis;
  }
}

TEST(Sampling, InverseUndoesLatentOnTheClosedCube) {
  const std::vector<double> lattice = LatticeOfCube(9);
  const int64_t n = static_cast<int64_t>(lattice.size() / 3);
  for (const float curvature : {1.0f, 20.0f}) {
    const auto flow = SmallFlow(curvature);
    std::vector<double> u(lattice.size()), x(lattice.size());
    flow->Latent(lattice.data(), n, kCode, 1, u.data());
    flow->Inverse(u.data(), n, kCode, 1, x.data());
    for (size_t i = 0; i < lattice.size(); ++i) {
      ASSERT_NEAR(x[i], lattice[i], kPointTolerance) << i % n << " " << i / n;
      // Faces are kept.
      if (lattice[i] == 0.0) {
        ASSERT_EQ(u[i], 0.0);
      } else if (lattice[i] == 1.0) {
        ASSERT_NEAR(u[i], 1.0, kLatentTolerance);
      }
    }
    // The other way around; x_p has no conditioner input.
    flow->Inverse(lattice.data(), n, kCode, 1, x.data());
    flow->Latent(x.data(), n, kCode, 1, u.data());
    for (size_t i = 0; i < lattice.size(); ++i) {
      ASSERT_GE(x[i], 0.0);
      ASSERT_LE(x[i], 1.0);
      ASSERT_NEAR(u[i], lattice[i], kLatentTolerance) << i % n << " " << i / n;
    }
  }
}

TEST(Sampling, SameBitsForAnyNumberOfThreadsAndOtherPointsForOtherSeeds) {
  const auto flow = SmallFlow(4.0f);
  constexpr int64_t n = 1000;
  std::vector<double> one(3 * n), three(3 * n), other(3 * n);
  SampleFlow(*flow, kCode, 7, n, 1, one.data());
  SampleFlow(*flow, kCode, 7, n, 3, three.data());
  SampleFlow(*flow, kCode, 8, n, 1, other.data());
  EXPECT_EQ(one, three);
  EXPECT_NE(one, other);
}

}  // namespace
}  // namespace ibrdf
