#include "ibrdf/solvers/paint/unseen_points.h"

#include <glog/logging.h>

#include "ibrdf/base/normal_source.h"

namespace ibrdf {
namespace {

constexpr int kDraws = 64;
constexpr uint64_t kSeed = 1;
constexpr double kLeastPrecision = 1e-9;  // of a hole that nothing surrounds

// The precision of the unseen points for steps of variance 1.
Eigen::SparseMatrix<double> PrecisionOf(
    const std::vector<NeighbourPair>& neighbours, const std::vector<int>& index,
    int count) {
  std::vector<Eigen::Triplet<double>> entries;
  for (int k = 0; k < count; ++k) entries.emplace_back(k, k, kLeastPrecision);
  for (const NeighbourPair& pair : neighbours) {
    const int a = index[pair.first], b = index[pair.second];
    if (a >= 0) entries.emplace_back(a, a, 1.0);
    if (b >= 0) entries.emplace_back(b, b, 1.0);
    if (a < 0 || b < 0) continue;
    entries.emplace_back(a, b, -1.0);
    entries.emplace_back(b, a, -1.0);
  }
  Eigen::SparseMatrix<double> precision(count, count);
  precision.setFromTriplets(entries.begin(), entries.end());
  return precision;
}

}  // namespace

UnseenPoints::UnseenPoints(const std::vector<NeighbourPair>& neighbours,
                           const std::vector<double>& seen)
    : neighbours_(neighbours), index_(seen.size(), -1) {
  for (size_t i = 0; i < seen.size(); ++i) {
    if (seen[i] == 0.0) index_[i] = count_++;
  }
  if (count_ == 0) return;
  cholesky_.compute(PrecisionOf(neighbours_, index_, count_));
  CHECK_EQ(cholesky_.info(), Eigen::Success);
}

Eigen::VectorXd UnseenPoints::MeanGiven(const std::vector<double>& values,
                                        double alone) const {
  Eigen::VectorXd right =
      Eigen::VectorXd::Constant(count_, kLeastPrecision * alone);
  if (count_ == 0) return right;
  for (const NeighbourPair& pair : neighbours_) {
    const int a = index_[pair.first], b = index_[pair.second];
    if (a >= 0 && b < 0) right[a] += values[pair.second];
    if (b >= 0 && a < 0) right[b] += values[pair.first];
  }
  return cholesky_.solve(right);
}

// L^-T z is a draw of precision P = L L^T where z is standard normal.
Eigen::VectorXd UnseenPoints::Variances() const {
  Eigen::VectorXd sum = Eigen::VectorXd::Zero(count_);
  if (count_ == 0) return sum;
  NormalSource normal(kSeed);
  for (int k = 0; k < kDraws; ++k) {
    Eigen::VectorXd z(count_);
    for (double& x : z) x = normal.Next();
    const Eigen::VectorXd draw = cholesky_.matrixU().solve(z);
    sum += draw.cwiseAbs2();
  }
  return cholesky_.permutationPinv() * sum / kDraws;
}

void UnseenPoints::Scatter(const Eigen::VectorXd& unseen,
                           std::vector<double>* values) const {
  for (size_t i = 0; i < index_.size(); ++i) {
    if (index_[i] >= 0) (*values)[i] = unseen[index_[i]];
  }
}

}  // namespace ibrdf
