// A small random BRDF model, quick to evaluate, for tests of what uses one.
#pragma once
#include <algorithm>
#include <cmath>
#include <cstdint>
#include <random>
#include <string>

#include "ibrdf/flow/coupling_flow.h"
#include "ibrdf/flow/neural_brdf_model.h"

namespace ibrdf {

// `materials` random codes a channel, of norm 0.2 to 0.8. The weights are far
// enough from the identity that codes matter: the last dense layer is scaled up
// by `curvature` from the trainer's start.
inline NeuralBrdfModel TinyModel(int materials, uint64_t seed = 1,
                                 float curvature = 4.0f) {
  NeuralBrdfModel model;
  model.shape.layers = 3;
  model.shape.bins = 4;
  model.shape.code_size = 4;
  model.shape.widths = {8, 4};
  model.weights = InitialFlowWeights(model.shape, seed);
  const DenseLayer last = model.shape.DenseLayers().back();
  for (int l = 0; l < model.shape.layers; ++l) {
    float* layer = model.weights.data() + l * model.shape.WeightsPerLayer();
    for (int k = 0; k < last.in_count * last.out_count; ++k) {
      layer[last.weight_offset + k] *= curvature;
    }
  }
  std::mt19937_64 rng(seed + 1);
  std::normal_distribution<float> normal;
  std::uniform_real_distribution<float> norm(0.2f, 0.8f);
  for (int m = 0; m < 3 * materials; ++m) {
    const char* channels[] = {".red", ".green", ".blue"};
    model.names.push_back("m" + std::to_string(m / 3) + channels[m % 3]);
    float code[4], square = 0.0f;
    for (float& z : code) {
      z = normal(rng);
      square += z * z;
    }
    const float scale = norm(rng) / std::sqrt(square);
    for (const float z : code) model.codes.push_back(scale * z);
    model.log_colours.push_back(4.0f + 0.5f * normal(rng));
  }
  model.note = "random";
  return model;
}

// The same with the knots of every spline at fixed places: a density is then
// smooth in the code, which differences over wide steps need. (Where a code
// moves knots, the derivative jumps as one passes a node of the grid.)
inline NeuralBrdfModel SmoothTinyModel(int materials, uint64_t seed = 1) {
  NeuralBrdfModel model = TinyModel(materials, seed);
  const DenseLayer last = model.shape.DenseLayers().back();
  // Rows of the last layer: bins + 1 slopes, then the bins' widths.
  const int slopes = (model.shape.bins + 1) * last.in_count;
  for (int l = 0; l < model.shape.layers; ++l) {
    float* layer = model.weights.data() + l * model.shape.WeightsPerLayer();
    std::fill(layer + last.weight_offset + slopes,
              layer + last.weight_offset + last.out_count * last.in_count,
              0.0f);
  }
  return model;
}

}  // namespace ibrdf
