#include "ibrdf/solvers/paint/stepped_field.h"

#include <Eigen/IterativeLinearSolvers>
#include <Eigen/SparseCore>

#include "ibrdf/base/eigen_vectors.h"

namespace ibrdf {
namespace {

constexpr double kLeastAnchor = 1e-9;
constexpr double kTolerance = 1e-5;
constexpr int kMostIterations = 1000;

}  // namespace

SteppedField::SteppedField(const std::vector<double>& anchor_weights)
    : weights_(anchor_weights.size()) {
  for (size_t i = 0; i < anchor_weights.size(); ++i) {
    weights_[i] = anchor_weights[i] + kLeastAnchor;
  }
}

std::vector<double> SteppedField::Solve(
    const std::vector<NeighbourPair>& pairs,
    const std::vector<double>& pair_weights, const std::vector<double>& steps,
    const std::vector<double>& anchors,
    const std::vector<double>& guess) const {
  const auto count = static_cast<Eigen::Index>(weights_.size());
  std::vector<Eigen::Triplet<double>> entries;
  Eigen::VectorXd right = weights_.cwiseProduct(ToEigen(anchors));
  for (Eigen::Index i = 0; i < count; ++i) {
    entries.emplace_back(i, i, weights_[i]);
  }
  for (size_t k = 0; k < pairs.size(); ++k) {
    const int a = pairs[k].first, b = pairs[k].second;
    const double w = pair_weights[k];
    entries.emplace_back(a, a, w);
    entries.emplace_back(b, b, w);
    entries.emplace_back(a, b, -w);
    entries.emplace_back(b, a, -w);
    right[a] -= w * steps[k];
    right[b] += w * steps[k];
  }
  Eigen::SparseMatrix<double> A(count, count);
  A.setFromTriplets(entries.begin(), entries.end());
  Eigen::ConjugateGradient<Eigen::SparseMatrix<double>,
                           Eigen::Lower | Eigen::Upper>
      solver(A);
  solver.setTolerance(kTolerance);
  solver.setMaxIterations(kMostIterations);
  return ToVector(solver.solveWithGuess(right, ToEigen(guess)));
}

SteppedField FieldOfReach(double reach, std::vector<double> seen) {
  for (double& w : seen) {
    w /= reach * reach * static_cast<double>(seen.size());
  }
  return SteppedField(seen);
}

}  // namespace ibrdf
