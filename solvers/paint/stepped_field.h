// A field over an object's points from anchors and steps between neighbours.
#pragma once
#include <Eigen/Core>
#include <vector>

#include "ibrdf/solvers/paint/neighbours.h"

namespace ibrdf {

// x of the least sum over points of anchor_weight (x - anchor)^2 and over pairs
// of weight (x_second - x_first - step)^2. A weight of 1e-9 more keeps it
// unique.
class SteppedField {
 public:
  // anchor_weights [points] >= 0.
  explicit SteppedField(const std::vector<double>& anchor_weights);

  // x [points], by conjugate gradients from `guess` [points]. pair_weights >= 0
  // and steps are [pairs], anchors [points].
  std::vector<double> Solve(const std::vector<NeighbourPair>& pairs,
                            const std::vector<double>& pair_weights,
                            const std::vector<double>& steps,
                            const std::vector<double>& anchors,
                            const std::vector<double>& guess) const;

 private:
  Eigen::VectorXd weights_;
};

// A field whose points may leave their anchors over this share of their
// number's square root; those with seen [points] = 0 have no anchor, others 1.
SteppedField FieldOfReach(double reach, std::vector<double> seen);

}  // namespace ibrdf
