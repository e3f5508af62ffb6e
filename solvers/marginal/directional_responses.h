// What a lamp adds to the radiance of an image's cells.
#pragma once
#include <Eigen/Core>
#include <vector>

#include "ibrdf/brdf/brdf_grid.h"
#include "ibrdf/solvers/observation/normal_bins.h"
#include "ibrdf/solvers/optim/dense_algebra.h"
#include "ibrdf/visibility/visibility.h"

namespace ibrdf {

// The cells' mean radiance under lamps of unit radiance and kLampSolidAngle, as
// linear functions of a BRDF's values at a grid's nodes.
class LampResponses {
 public:
  using Matrix =
      Eigen::Matrix<float, Eigen::Dynamic, Eigen::Dynamic, Eigen::RowMajor>;

  // directions: unit. visibility: of the cells' points; null: all in sight.
  LampResponses(const ImageCells& cells, const BrdfGridShape& grid,
                const Visibility* visibility,
                const std::vector<Eigen::Vector3d>& directions);

  int num_lamps() const { return num_lamps_; }
  // [cells][lamps] of a field [nodes].
  RowMatrix Of(const float* field) const;
  // Adds to gradient [nodes]: of adjoint [cells][lamps] . Of(field).
  void AddGradient(const Matrix& adjoint, float* gradient) const;

 private:
  struct Taps {
    int node[8] = {};
    float weight[8] = {};
  };
  int num_lamps_;
  std::vector<int> first_;  // points of each cell
  std::vector<Taps> taps_;  // [points][lamps]
};

}  // namespace ibrdf
