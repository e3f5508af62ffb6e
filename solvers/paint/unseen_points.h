// Values at points that no image shows, from those around.
#pragma once
#include <Eigen/Core>
#include <Eigen/SparseCholesky>
#include <Eigen/SparseCore>
#include <vector>

#include "ibrdf/solvers/paint/neighbours.h"

namespace ibrdf {

// A Gaussian random field over an object's points whose steps between
// neighbours are independent and of one variance, given the points that are
// seen.
class UnseenPoints {
 public:
  // seen [points]: 0 or 1.
  UnseenPoints(const std::vector<NeighbourPair>& neighbours,
               const std::vector<double>& seen);

  // The number of points with seen = 0. Vectors hold them in their order.
  int count() const { return count_; }
  // The field's mean where the seen points have `values` [points]; `alone` in a
  // hole that no seen point is beside.
  Eigen::VectorXd MeanGiven(const std::vector<double>& values,
                            double alone) const;
  // Its variance for steps of variance 1, from 64 draws of a fixed seed: each
  // is off by a fifth (standard deviation).
  Eigen::VectorXd Variances() const;
  // Puts one value of each into all points' [points].
  void Scatter(const Eigen::VectorXd& unseen,
               std::vector<double>* values) const;

 private:
  const std::vector<NeighbourPair> neighbours_;
  std::vector<int> index_;  // of each point among the unseen, or -1
  int count_ = 0;
  Eigen::SimplicialLLT<Eigen::SparseMatrix<double>> cholesky_;
};

}  // namespace ibrdf
