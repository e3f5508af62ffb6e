// A small random BRDF model, quick to evaluate, for tests of what uses one.
#pragma once
#include <algorithm>
#include <cmath>
#include <cstdint>
#include <random>
#include <string>
#include <vector>

#include "ibrdf/flow/brdf_flow.h"
#include "ibrdf/flow/neural_brdf_model.h"

namespace ibrdf {

// Calls edit(conditioner, its weights) for x_h, x_d and x_p.
template <typename Edit>
void EditConditioners(const TriangularShape& shape, std::vector<float>* weights,
                      const Edit& edit) {
  float* w = weights->data();
  for (const ConditionerShape& c : shape.Conditioners()) {
    edit(c, w);
    w += c.num_weights;
  }
}

// The trainer's start with the last layer of every conditioner scaled up by
// `curvature`: 1 is nearly the identity.
inline std::vector<float> CurvedWeights(const TriangularShape& shape,
                                        float curvature, uint64_t seed) {
  FlowShape flow;
  flow.triangular = shape;
  std::vector<float> weights = InitialFlowWeights(flow, seed);
  EditConditioners(shape, &weights, [&](const ConditionerShape& c, float* w) {
    const DenseLayer& last = c.dense.back();
    for (int k = 0; k < last.in_count * last.out_count; ++k) {
      w[last.weight_offset + k] *= curvature;
    }
  });
  return weights;
}

// `materials` random codes a channel, of norm 0.2 to 0.8. The weights are far
// enough from the identity that codes matter.
inline NeuralBrdfModel TinyModel(int materials, uint64_t seed = 1,
                                 float curvature = 4.0f) {
  NeuralBrdfModel model;
  model.shape.triangular.bins = {6, 4, 4};
  model.shape.triangular.code_size = 4;
  model.shape.triangular.widths = {8, 8};
  model.shape.triangular.marginal_widths = {6};
  model.weights = CurvedWeights(model.shape.triangular, curvature, seed);
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
  EditConditioners(
      model.shape.triangular, &model.weights,
      [](const ConditionerShape& c, float* w) {
        // Rows of the last layer: heights, then the bins' widths.
        const DenseLayer& last = c.dense.back();
        std::fill(w + last.weight_offset + c.NumHeights() * last.in_count,
                  w + last.weight_offset + c.NumParameters() * last.in_count,
                  0.0f);
      });
  return model;
}

}  // namespace ibrdf
