// Sizes of the invertible network and where its weights lie.
#pragma once
#include <cstddef>
#include <string>
#include <vector>

#include "ibrdf/flow/coupling_constants.h"
#include "ibrdf/flow/dense_layer.h"

namespace ibrdf {

// A stack of coupling layers on the unit cube (Chen et al. 2020, Sec. 4.2).
// Layer l transforms dimension l mod 3 by a monotone piecewise-quadratic map
// (Mueller et al. 2019) whose 2 * bins + 1 parameters a UNet-shaped network
// makes from the other two dimensions and the code: dense layers of
// widths[0] > widths[1] > ... and back, the way up seeing the same level of the
// way down beside its own activations.
struct CouplingShape {
  int layers = 6;
  int bins = 8;
  int code_size = 16;
  std::vector<int> widths = {64, 32, 16};

  int SplineParameters() const { return 2 * bins + 1; }

  // Rows of activations: 2 inputs, then per level down and up side by side,
  // the innermost level, the spline parameters.
  int ActivationRows() const;
  int OutputRow() const { return ActivationRows() - SplineParameters(); }

  // Dense layers in order of evaluation. The first one's in_count is 2; its
  // code part is [widths[0]][code_size] at CodeWeightOffset().
  std::vector<DenseLayer> DenseLayers() const;
  size_t CodeWeightOffset() const;
  size_t WeightsPerLayer() const;
  size_t NumWeights() const { return layers * WeightsPerLayer(); }

  // Empty if the sizes make sense, else what is wrong.
  std::string Validate() const;
};

// Dimension that layer l transforms, and the two that condition it.
struct CouplingDims {
  int transformed, first, second;
};
inline CouplingDims DimsOfLayer(int layer) {
  const int t = layer % 3;
  return {t, t == 0 ? 1 : 0, t == 2 ? 1 : 2};
}

}  // namespace ibrdf
