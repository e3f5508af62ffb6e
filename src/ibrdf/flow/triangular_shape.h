// Sizes of the triangular flow and where its weights lie.
#pragma once
#include <array>
#include <cstddef>
#include <string>
#include <vector>

#include "ibrdf/flow/dense_layer.h"

namespace ibrdf {

// Heights of a spline's knots are h = g p / (1 + |g p| / R) with g =
// kHeightGain and R = kHeightRange (a density may span e^+-R about its mean),
// and bin widths (1 - bins * kMinBinWidth) softmax(p) + kMinBinWidth, so that
// no bin and no density vanishes whatever the weights. The gain lets weights of
// ordinary size reach the six orders of magnitude of polished metal.
inline constexpr double kHeightGain = 4.0;
inline constexpr double kHeightRange = 40.0;
inline constexpr double kMinBinWidth = 1e-3;

// A conditioner: a multilayer perceptron from features and code to the
// parameters of one spline.
struct ConditionerShape {
  int features = 0;  // rows before the hidden ones
  int bins = 0;
  bool periodic = false;  // the density is the same at 0 and 1
  int rows = 0;           // features, hidden layers, spline parameters
  int output_row = 0;
  // The first layer's code part is [dense[0].out_count][code_size].
  std::vector<DenseLayer> dense;
  size_t code_offset = 0;
  size_t num_weights = 0;
  size_t padded_weights = 0;  // of the gradient in the kernels' layout

  int NumHeights() const { return periodic ? bins : bins + 1; }
  int NumParameters() const { return NumHeights() + bins; }
};

// A stack of three coupling layers in the order of a triangular (Knothe-
// Rosenblatt) map on the unit cube: x_p alone, x_d given x_p, x_h given both.
// Each maps its coordinate by the integral of a density whose logarithm is
// piecewise linear. For a fixed code the conditioners are functions of the
// column (x_d, x_p) of a table alone: a column of any number of theta_h costs
// one evaluation. phi_d enters as cos and sin of 2 phi_d, so that the density
// is smooth where phi_d = pi joins 0.
struct TriangularShape {
  int code_size = 16;
  std::array<int, 3> bins = {24, 12, 12};       // of x_h, x_d, x_p
  std::vector<int> widths = {64, 64, 64};       // hidden layers, for x_h
  std::vector<int> marginal_widths = {32, 32};  // for x_d and x_p

  // Of x_h (features 2 x_d - 1, cos 2 phi_d, sin 2 phi_d), x_d (cos, sin) and
  // x_p (none). Weights lie in this order.
  std::array<ConditionerShape, 3> Conditioners() const;
  size_t NumWeights() const;

  // Empty if the sizes make sense, else what is wrong.
  std::string Validate() const;
};

}  // namespace ibrdf
