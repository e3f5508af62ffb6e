// Sizes of the triangular flow and where its weights lie.
#pragma once
#include <algorithm>
#include <array>
#include <cmath>
#include <cstddef>
#include <string>
#include <vector>

#include "ibrdf/base/pi.h"
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

// What conditioners see of a column.
//   0: 2 x_d - 1
//   1: 2 sqrt(b + kBoundRounding) - 1, 2: 2 b - 1
//   3: cos 2 phi_d, 4: sin 2 phi_d
//   5: 2 sqrt(c) - 1
// with b = theta_h's bound over pi/2 and c = |cos phi_d|, rounded off by
// kCosineRounding where phi_d = pi/2. x_h is theta_h over its bound: where
// theta_d nears pi/2 the bound depends on phi_d so sharply that a reflectance
// which does not depend on phi_d at all has a cusp in these coordinates. The
// features hand that cusp to the network (log-RMSE of nickel alone 0.037 in
// place of 0.054 at equal time: experiments/reflectance_model). All are smooth
// where phi_d = pi joins 0.
inline constexpr int kColumnFeatures = 6;
inline constexpr int kFirstFeature[3] = {0, 3, kColumnFeatures};
inline constexpr int kNumFeatures[3] = {5, 3, 0};
inline constexpr double kCosineRounding = 1e-5;
inline constexpr double kBoundRounding = 1e-6;

// T: scalar type. features: [kColumnFeatures]; their derivatives by x_d and
// x_p likewise where not null.
template <typename T>
void ColumnFeatures(T x_d, T x_p, T* features, T* by_d, T* by_p) {
  using std::abs;
  using std::atan2;
  using std::cos;
  using std::sin;
  using std::sqrt;
  const T quarter = T(kPi / 2);
  const T sine_d = sin(quarter * x_d), cosine_d = cos(quarter * x_d);
  const T sine_p = sin(T(kPi) * x_p), cosine_p = cos(T(kPi) * x_p);
  const T c = sqrt(cosine_p * cosine_p + T(kCosineRounding));
  // Zero only at x_d = 1, and not in floating point.
  const T b = atan2(abs(cosine_d), c * sine_d) / quarter;
  const T root_b = sqrt(b + T(kBoundRounding)), root_c = sqrt(c);
  features[0] = 2 * x_d - 1;
  features[1] = 2 * root_b - 1;
  features[2] = 2 * b - 1;
  features[3] = cos(T(2 * kPi) * x_p);
  features[4] = sin(T(2 * kPi) * x_p);
  features[5] = 2 * root_c - 1;
  if (by_d == nullptr || by_p == nullptr) return;
  const T norm = cosine_d * cosine_d + c * c * sine_d * sine_d;
  const T b_by_d = -c / norm;
  const T c_by_p = -T(kPi) * cosine_p * sine_p / c;
  const T b_by_p = -sine_d * cosine_d / norm / quarter * c_by_p;
  const T d[kColumnFeatures] = {T(2), b_by_d / root_b, 2 * b_by_d, T(0), T(0),
                                T(0)};
  const T p[kColumnFeatures] = {T(0),
                                b_by_p / root_b,
                                2 * b_by_p,
                                -T(2 * kPi) * features[4],
                                T(2 * kPi) * features[3],
                                c_by_p / root_c};
  std::copy(d, d + kColumnFeatures, by_d);
  std::copy(p, p + kColumnFeatures, by_p);
}

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
// one evaluation.
struct TriangularShape {
  int code_size = 16;
  std::array<int, 3> bins = {32, 16, 16};       // of x_h, x_d, x_p
  std::vector<int> widths = {96, 96, 96};       // hidden layers, for x_h
  std::vector<int> marginal_widths = {32, 32};  // for x_d and x_p

  // The conditioners of x_h (column features 0 to 4), x_d (3 to 5) and x_p
  // (none). Weights lie in this order.
  std::array<ConditionerShape, 3> Conditioners() const;
  size_t NumWeights() const;

  // Empty if the sizes make sense, else what is wrong.
  std::string Validate() const;
};

}  // namespace ibrdf
