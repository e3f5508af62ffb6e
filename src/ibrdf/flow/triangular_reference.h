// The triangular flow written plainly, one point at a time, in any scalar type:
// the slow reference of the kernels.
#pragma once
#include <cmath>
#include <vector>

#include "ibrdf/base/dual.h"
#include "ibrdf/flow/log_linear_spline.h"
#include "ibrdf/flow/triangular_shape.h"

namespace ibrdf {

// sum += w x; without temporaries where x has derivatives and w has none.
template <typename W, typename T>
void AddProduct(const W& w, const T& x, T* sum) {
  *sum += w * x;
}
template <typename T>
void AddProduct(const T& w, const BasicDual<T>& x, BasicDual<T>* sum) {
  sum->value += w * x.value;
  if (sum->derivatives.empty()) sum->derivatives.resize(x.derivatives.size());
  for (size_t i = 0; i < x.derivatives.size(); ++i) {
    sum->derivatives[i] += w * x.derivatives[i];
  }
}

// W: type of the weights; the scalar type of codes and points is a template
// argument of the methods.
template <typename W>
class TriangularReference {
 public:
  // weights: [shape.NumWeights()], converted to W.
  template <typename V>
  TriangularReference(const TriangularShape& shape, const V* weights)
      : shape_(shape),
        conditioners_(shape.Conditioners()),
        weights_(weights, weights + shape.NumWeights()) {}

  // Log density in nats at x in [0,1]^3 for a code [code_size].
  template <typename T>
  T LogDensity(const W* x, const T* code) const {
    T sum = T(0);
    for (int dim = 0; dim < 3; ++dim) {
      sum += Spline(dim, x[1], x[2], code).LogDensity(T(x[dim]));
    }
    return sum;
  }

  // The same for x_h [points], points `stride` apart, of one column (x_d, x_p),
  // which share their networks: visit(i, log density).
  template <typename T, typename X, typename Visit>
  void LogDensityOnColumn(W x_d, W x_p, const X* x_h, int points, size_t stride,
                          const T* code, const Visit& visit) const {
    T base = Spline(1, x_d, x_p, code).LogDensity(T(x_d));
    base += Spline(2, x_d, x_p, code).LogDensity(T(x_p));
    const LogLinearSpline<T> spline = Spline(0, x_d, x_p, code);
    for (int i = 0; i < points; ++i) {
      T value = spline.LogDensity(T(W(x_h[i * stride])));
      value += base;
      visit(i, value);
    }
  }

  // The latent point u in [0,1]^3 of x, and back.
  void Latent(const W* x, const W* code, W* u) const {
    for (int dim = 0; dim < 3; ++dim) {
      u[dim] = Spline(dim, x[1], x[2], code).Integral(x[dim]);
    }
  }
  void Inverse(const W* u, const W* code, W* x) const {
    x[1] = x[2] = W(0);
    for (int dim = 2; dim >= 0; --dim) {
      x[dim] = Spline(dim, x[1], x[2], code).InverseIntegral(u[dim]);
    }
  }

 private:
  template <typename T>
  LogLinearSpline<T> Spline(int dim, W x_d, W x_p, const T* code) const {
    const ConditionerShape& c = conditioners_[dim];
    const W* w = weights_.data();
    for (int i = 0; i < dim; ++i) w += conditioners_[i].num_weights;
    std::vector<T> rows(c.rows);
    W features[kColumnFeatures];
    ColumnFeatures<W>(x_d, x_p, features, nullptr, nullptr);
    for (int i = 0; i < kNumFeatures[dim]; ++i) {
      rows[i] = T(features[kFirstFeature[dim] + i]);
    }
    for (size_t i = 0; i < c.dense.size(); ++i) {
      const DenseLayer& d = c.dense[i];
      for (int o = 0; o < d.out_count; ++o) {
        T sum = T(w[d.bias_offset + o]);
        for (int k = 0; k < d.in_count; ++k) {
          AddProduct(w[d.weight_offset + o * d.in_count + k], rows[d.in + k],
                     &sum);
        }
        if (i == 0) {
          const W* wz = w + c.code_offset + o * shape_.code_size;
          for (int k = 0; k < shape_.code_size; ++k) {
            AddProduct(wz[k], code[k], &sum);
          }
        }
        rows[d.out + o] = d.activation ? Activate(sum) : sum;
      }
    }
    return LogLinearSpline<T>(rows.data() + c.output_row, c.bins, c.periodic);
  }

  template <typename T>
  static T Activate(const T& x) {
    using std::abs;
    using std::sqrt;
    const T t = sqrt(T(x * x + kSharpness)) + abs(x);
    // At 0 the slope of |x| is that of the branch x >= 0.
    if (x >= 0.0) return t / 2.0;
    return T(kSharpness / 2) / t;
  }

  TriangularShape shape_;
  std::array<ConditionerShape, 3> conditioners_;
  std::vector<W> weights_;
};

}  // namespace ibrdf
