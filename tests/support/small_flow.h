// A small random triangular flow with peaks.
#pragma once
#include <cstdint>

#include "ibrdf/flow/neural_brdf_model.h"
#include "ibrdf/flow/triangular_flow.h"

namespace ibrdf {

// Codes of three numbers; no embedding. The heights of the trainer's start are
// scaled up by `curvature`, so that densities are far from uniform; not the
// widths, lest bins be too narrow for the midpoint rules of tests.
inline NeuralBrdfModel SmallFlowModel(float curvature, uint64_t seed = 5) {
  NeuralBrdfModel model;
  TriangularShape& shape = model.shape.triangular;
  shape.code_size = 3;
  shape.bins = {6, 4, 4};
  shape.widths = {8, 8};
  shape.marginal_widths = {6};
  model.weights = InitialTriangularWeights(shape, seed);
  float* w = model.weights.data();
  for (const ConditionerShape& c : shape.Conditioners()) {
    const DenseLayer& last = c.dense.back();
    for (int k = 0; k < last.in_count * c.NumHeights(); ++k) {
      w[last.weight_offset + k] *= curvature;
    }
    w += c.num_weights;
  }
  return model;
}

}  // namespace ibrdf
