// A density on [0, 1] whose logarithm is piecewise linear, in any scalar type:
// the slow reference of the kernels, and the precise path of sampling.
#pragma once
#include <algorithm>
#include <cmath>
#include <vector>

#include "ibrdf/flow/triangular_shape.h"

namespace ibrdf {

template <typename T>
class LogLinearSpline {
 public:
  // parameters: heights [bins + 1, or bins if periodic], then widths [bins].
  template <typename P>
  LogLinearSpline(const P* parameters, int bins, bool periodic)
      : bins_(bins),
        height_(bins + 1),
        width_(bins),
        knot_(bins + 1),
        mass_(bins) {
    using std::abs;
    using std::exp;
    using std::log;
    const int heights = periodic ? bins : bins + 1;
    T top = T(-2 * kHeightRange);
    for (int k = 0; k < heights; ++k) {
      const T h = T(parameters[k]) * kHeightGain;
      height_[k] = h / (T(1) + abs(h) / kHeightRange);
      if (height_[k] > top) top = height_[k];
    }
    if (periodic) height_[bins] = height_[0];
    const P* q = parameters + heights;
    T largest = T(q[0]), sum = T(0);
    for (int k = 1; k < bins; ++k) {
      if (T(q[k]) > largest) largest = T(q[k]);
    }
    for (int k = 0; k < bins; ++k) {
      width_[k] = exp(T(q[k]) - largest);
      sum += width_[k];
    }
    knot_[0] = T(0);
    total_ = T(0);
    for (int k = 0; k < bins; ++k) {
      width_[k] = width_[k] / sum * (1 - bins * kMinBinWidth) + T(kMinBinWidth);
      knot_[k + 1] = knot_[k] + width_[k];
      // Relative to the highest knot, so that no sum overflows.
      mass_[k] = width_[k] * exp(height_[k] - top) *
                 MeanExp(T(height_[k + 1] - height_[k]));
      total_ += mass_[k];
    }
    log_total_ = log(total_) + top;
    top_ = top;
  }

  T LogDensity(const T& x) const {
    const int k = FindBin(x);
    return height_[k] +
           (height_[k + 1] - height_[k]) * ((x - knot_[k]) / width_[k]) -
           log_total_;
  }

  // Integral of the density over [0, x], in [0, 1].
  T Integral(const T& x) const {
    using std::exp;
    const int k = FindBin(x);
    T below = T(0);
    for (int i = 0; i < k; ++i) below += mass_[i];
    const T a = (x - knot_[k]) / width_[k];
    const T d = height_[k + 1] - height_[k];
    below += width_[k] * exp(height_[k] - top_) * a * MeanExp(T(d * a));
    return std::clamp(T(below / total_), T(0), T(1));
  }

  // x of a given integral in [0, 1].
  T InverseIntegral(const T& u) const {
    using std::abs;
    using std::exp;
    using std::log1p;
    T rest = u * total_;
    int k = 0;
    while (k + 1 < bins_ && rest >= mass_[k]) rest -= mass_[k++];
    const T y = rest / (width_[k] * exp(height_[k] - top_));
    const T d = height_[k + 1] - height_[k];
    // a MeanExp(d a) = y.
    const T yd = std::max(T(y * d), T(-1 + 1e-15));
    const T a = abs(yd) < 1e-8 ? y * (1 - yd / 2) : log1p(yd) / d;
    return std::clamp(T(knot_[k] + std::clamp(a, T(0), T(1)) * width_[k]), T(0),
                      T(1));
  }

 private:
  // (e^d - 1) / d.
  static T MeanExp(const T& d) {
    using std::abs;
    using std::exp;
    if (abs(d) < 1e-2) {
      return T(1) +
             d / 2.0 *
                 (T(1) +
                  d / 3.0 *
                      (T(1) + d / 4.0 * (T(1) + d / 5.0 * (T(1) + d / 6.0))));
    }
    return (exp(d) - T(1)) / d;
  }

  int FindBin(const T& x) const {
    int k = 0;
    while (k + 1 < bins_ && x >= knot_[k + 1]) ++k;
    return k;
  }

  int bins_;
  std::vector<T> height_, width_, knot_, mass_;
  T total_, log_total_, top_;
};

}  // namespace ibrdf
