#include "ibrdf/solvers/estimation/map_evidence.h"

#include <gtest/gtest.h>

#include <Eigen/Eigenvalues>
#include <algorithm>
#include <cmath>
#include <limits>
#include <memory>
#include <vector>

#include "ibrdf/solvers/estimation/light_given_reflectance.h"
#include "tests/solve/ball_problem.h"

namespace ibrdf {
namespace {
using namespace testing;  // NOLINT

// A ball under a smooth light, its reflectance held while the light is found.
class MapEvidenceTest : public ::testing::Test {
 protected:
  static constexpr int kWidth = 16;  // of the map

  // lobes: of the image; held: those that the light is found with.
  void Hold(const std::vector<double>& lobes, const std::vector<double>& held) {
    problem_ = BallProblem(20);
    problem_.kind = ProblemKind::kIllumination;
    SetNoisyImage(
        BallRadiance(problem_, *problem_.model, lobes, SmoothMap(8, 16)), 0.02,
        &problem_);
    problem_.known_brdf =
        FlowLobes(*problem_.model, 2, problem_.transport.grid, 1)
            .Grid(held.data());
    setup_ = std::make_unique<const SolveSetup>(*ibrdf::SetUp(problem_));
    const SolveProgress quiet;
    SolveContext context(problem_, quiet, nullptr);
    estimate_ = std::make_unique<Estimate>(
        EstimateProcessLight(*setup_, {}, kWidth, &context).value());
  }
  double Cost() const { return EvidenceOfMap(*setup_, *estimate_).cost; }

  // The docstring's formula, the determinant by all eigenvalues of a matrix
  // whose rows are derivatives by central differences.
  double SlowCost(double* squares) const {
    const Iterate& it = estimate_->iterate;
    const PosteriorObjective on = ObjectiveOn(
        estimate_->pixels.get(), *setup_, it.light, it.light.priors, it.scale);
    JointObjective* objective = on.objective.get();
    const JointCost cost = objective->Evaluate(it.state);
    const std::vector<char>& valid = estimate_->pixels->observed().valid;
    std::vector<double> base = objective->radiance();
    const Eigen::Index n = objective->size();
    Eigen::MatrixXd j =
        Eigen::MatrixXd::Zero(static_cast<Eigen::Index>(base.size()), n);
    constexpr double kDifference = 1e-2;  // maps are of floats
    for (Eigen::Index k = 0; k < n; ++k) {
      std::vector<double> ends[2];
      for (const int side : {0, 1}) {
        Eigen::VectorXd x = objective->ToVector(it.state);
        x[k] += side == 0 ? -kDifference : kDifference;
        objective->Evaluate(objective->FromVector(x, it.state));
        ends[side] = objective->radiance();
      }
      for (size_t i = 0; i < base.size(); ++i) {
        if (!valid[i / 3]) continue;
        j(static_cast<Eigen::Index>(i), k) =
            (std::log(ends[1][i] + setup_->epsilon) -
             std::log(ends[0][i] + setup_->epsilon)) /
            (2.0 * kDifference);
      }
    }
    const Eigen::VectorXd eigenvalues =
        Eigen::SelfAdjointEigenSolver<Eigen::MatrixXd>(j * j.transpose())
            .eigenvalues();
    const double values =
        3.0 * static_cast<double>(std::count(valid.begin(), valid.end(), 1));
    double best = std::numeric_limits<double>::infinity();
    for (double s = 0.2; s < 2.0; s += 0.02) {
      for (double b = 0.5 * cost.misfit; b < 6.0 * cost.misfit; b *= 1.02) {
        const Eigen::ArrayXd f =
            0.5 * (eigenvalues.array().max(0.0) * (s * s / (b * b))).log1p();
        const double at = values * (cost.misfit / b + std::log(2.0 * b)) +
                          cost.illumination_prior / (s * s) + f.sum();
        if (!(at < best)) continue;
        best = at;
        *squares = f.square().sum();
      }
    }
    return best;
  }

  // The first material of the model is far from these.
  const std::vector<double> truth_ = {0.3,  -0.4, 0.2, 0.1,  5.0, 4.6, 4.2,
                                      -0.5, 0.1,  0.3, -0.2, 3.0, 3.5, 3.3};
  std::vector<double> Other() const {
    const SolveSetup lobes = ibrdf::SetUp(BallProblemOfImage()).value();
    const auto& parameters = lobes.materials.materials.front().parameters;
    return {parameters.data(), parameters.data() + parameters.size()};
  }
  InverseProblem problem_;
  std::unique_ptr<const SolveSetup> setup_;
  std::unique_ptr<Estimate> estimate_;

 private:
  const InverseProblem& BallProblemOfImage() const {
    static const InverseProblem* const problem = [this] {
      auto* made = new InverseProblem(BallProblem(20));
      SetNoisyImage(BallRadiance(*made, *made->model, truth_, SmoothMap(8, 16)),
                    0.02, made);
      return made;
    }();
    return *problem;
  }
};

// A probe of signs has a variance of 2 sum f^2 at most, f half the logarithm of
// each eigenvalue.
TEST_F(MapEvidenceTest, IsNearASlowReference) {
  Hold(truth_, truth_);
  double squares = 0.0;
  const double slow = SlowCost(&squares);
  EXPECT_NEAR(slow, Cost(), 2.0 * std::sqrt(2.0 * squares / kProbesOfEvidence));
}

TEST_F(MapEvidenceTest, PrefersTheReflectanceOfTheImage) {
  Hold(truth_, truth_);
  const double of_truth = Cost();
  const double b = EvidenceOfMap(*setup_, *estimate_).scale;
  EXPECT_GT(b, 0.005);
  EXPECT_LT(b, 0.05);
  Hold(truth_, Other());
  EXPECT_LT(of_truth + 100.0, Cost());
}

TEST_F(MapEvidenceTest, ABrighterImageIsAsProbable) {
  Hold(truth_, truth_);
  const double cost = Cost();
  std::vector<double> brighter = truth_;
  for (const size_t k : {4, 5, 6, 11, 12, 13}) brighter[k] += 1.0;
  Hold(brighter, truth_);
  EXPECT_NEAR(cost, Cost(), 0.005 * std::abs(cost));
}

}  // namespace
}  // namespace ibrdf
