// What a directional light adds to the radiance of an image's bins.
#pragma once
#include <Eigen/Core>
#include <vector>

#include "ibrdf/brdf/brdf_grid.h"
#include "ibrdf/solvers/observation/normal_bins.h"
#include "ibrdf/solvers/optim/dense_algebra.h"
#include "ibrdf/visibility/visibility.h"

namespace ibrdf {

// The bins' mean radiance under directional lights of unit radiance and
// kDirectionalLightSolidAngle, as linear functions of a BRDF's values at a
// grid's nodes.
class DirectionalLightResponses {
 public:
  using Matrix =
      Eigen::Matrix<float, Eigen::Dynamic, Eigen::Dynamic, Eigen::RowMajor>;

  // directions: unit. visibility: of the bins' points; null: all in sight.
  DirectionalLightResponses(const NormalBins& bins, const BrdfGridShape& grid,
                            const Visibility* visibility,
                            const std::vector<Eigen::Vector3d>& directions);

  int num_directional_lights() const { return num_directional_lights_; }
  // [bins][directional lights] of a field [nodes].
  RowMatrix Of(const float* field) const;
  // Adds to gradient [nodes]: of adjoint [bins][directional lights] .
  // Of(field).
  void AddGradient(const Matrix& adjoint, float* gradient) const;

 private:
  struct Taps {
    int node[8] = {};
    float weight[8] = {};
  };
  int num_directional_lights_;
  std::vector<int> first_;  // points of each bin
  std::vector<Taps> taps_;  // [points][directional lights]
};

}  // namespace ibrdf
