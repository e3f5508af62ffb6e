// The trained flow in float by the formulas as they stand: softmax and
// densities by exp, the logarithm last, derivatives by Ceres' jets.
#pragma once
#include <ceres/jet.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <vector>

#include "ibrdf/flow/triangular_shape.h"

namespace ibrdf {
namespace stability {

inline constexpr int kCodeSize = 16;
using CodeJet = ceres::Jet<float, kCodeSize>;  // with derivatives by the code

// A density on [0, 1] whose logarithm is piecewise linear.
template <typename T>
struct NaiveSpline {
  std::vector<T> height, width, knot;
  T total = T(0.0f);

  NaiveSpline(const T* p, int bins, bool periodic)
      : height(bins + 1), width(bins), knot(bins + 1) {
    using std::abs;
    using std::exp;
    const float gain = static_cast<float>(kHeightGain);
    const float range = static_cast<float>(kHeightRange);
    const float least = static_cast<float>(kMinBinWidth);
    const int heights = periodic ? bins : bins + 1;
    for (int k = 0; k < heights; ++k) {
      const T h = p[k] * gain;
      height[k] = h / (T(1.0f) + abs(h) / range);
    }
    if (periodic) height[bins] = height[0];
    T sum = T(0.0f);
    for (int k = 0; k < bins; ++k) {
      width[k] = exp(p[heights + k]);
      sum += width[k];
    }
    knot[0] = T(0.0f);
    for (int k = 0; k < bins; ++k) {
      width[k] =
          width[k] / sum * (1.0f - static_cast<float>(bins) * least) + T(least);
      knot[k + 1] = knot[k] + width[k];
      const T left = exp(height[k]), right = exp(height[k + 1]);
      const T rise = height[k + 1] - height[k];
      total += rise < T(0.0f) || rise > T(0.0f)
                   ? width[k] * (right - left) / rise
                   : width[k] * left;
    }
  }

  T Density(float x) const {
    using std::exp;
    int k = 0;
    while (k + 2 < static_cast<int>(knot.size()) && T(x) >= knot[k + 1]) ++k;
    const T a = (T(x) - knot[k]) / width[k];
    return exp(height[k] + (height[k + 1] - height[k]) * a) / total;
  }
};

class NaiveFlow {
 public:
  // weights: [shape.NumWeights()]; both outlive *this.
  NaiveFlow(const TriangularShape& shape, const float* weights)
      : shape_(shape), conditioners_(shape.Conditioners()), weights_(weights) {}

  template <typename T>
  T Density(const float* x, const T* code) const {
    return Spline(2, x[1], x[2], code).Density(x[2]) *
           Spline(1, x[1], x[2], code).Density(x[1]) *
           Spline(0, x[1], x[2], code).Density(x[0]);
  }

  // The same at x_h [count] of one column: visit(i, density).
  template <typename T, typename Visit>
  void DensityOnColumn(float x_d, float x_p, const std::vector<float>& x_h,
                       const T* code, const Visit& visit) const {
    const T base = Spline(2, x_d, x_p, code).Density(x_p) *
                   Spline(1, x_d, x_p, code).Density(x_d);
    const NaiveSpline<T> spline = Spline(0, x_d, x_p, code);
    for (size_t i = 0; i < x_h.size(); ++i) {
      visit(i, T(base * spline.Density(x_h[i])));
    }
  }

 private:
  template <typename T>
  NaiveSpline<T> Spline(int dim, float x_d, float x_p, const T* code) const {
    using std::sqrt;
    const ConditionerShape& c = conditioners_[dim];
    const float* w = weights_;
    for (int i = 0; i < dim; ++i) w += conditioners_[i].num_weights;
    std::vector<T> rows(c.rows);
    float features[kColumnFeatures];
    ColumnFeatures<float>(x_d, x_p, features, nullptr, nullptr);
    for (int i = 0; i < c.features; ++i) {
      // Never cut: it shows the compiler that no feature lies beyond.
      rows[i] =
          T(features[std::min(kFirstFeature[dim] + i, kColumnFeatures - 1)]);
    }
    for (size_t i = 0; i < c.dense.size(); ++i) {
      const DenseLayer& d = c.dense[i];
      for (int o = 0; o < d.out_count; ++o) {
        T sum = T(w[d.bias_offset + o]);
        for (int k = 0; k < d.in_count; ++k) {
          sum += rows[d.in + k] * w[d.weight_offset + o * d.in_count + k];
        }
        for (int k = 0; i == 0 && k < shape_.code_size; ++k) {
          sum += code[k] * w[c.code_offset + o * shape_.code_size + k];
        }
        rows[d.out + o] =
            d.activation
                ? (sum + sqrt(sum * sum + static_cast<float>(kSharpness))) *
                      0.5f
                : sum;
      }
    }
    return NaiveSpline<T>(rows.data() + c.output_row, c.bins, c.periodic);
  }

  const TriangularShape shape_;
  const std::array<ConditionerShape, 3> conditioners_;
  const float* const weights_;
};

}  // namespace stability
}  // namespace ibrdf
