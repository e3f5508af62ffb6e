// The flow written plainly, one point at a time, in any scalar type: the slow
// reference of the kernels, and the double-precision path of gradient checks.
#pragma once
#include <algorithm>
#include <cmath>
#include <vector>

#include "ibrdf/flow/coupling_shape.h"

namespace ibrdf {

template <typename T>
class CouplingFlowReference {
 public:
  // weights: [shape.NumWeights()], converted to T.
  template <typename W>
  CouplingFlowReference(const CouplingShape& shape, const W* weights)
      : shape_(shape),
        dense_(shape.DenseLayers()),
        weights_(weights, weights + shape.NumWeights()) {}

  // log density at x in [0,1]^3 for a code [code_size]; u: the latent point.
  T LogDensity(const T* x, const T* code, T* u) const {
    Tape tape;
    return Run(x, code, u, &tape);
  }

  // Also its gradients; each may be null. dx: [3], dcode: [code_size],
  // dweights: [NumWeights()], overwritten.
  T LogDensityWithGradient(const T* x, const T* code, T* dx, T* dcode,
                           std::vector<T>* dweights) const {
    Tape tape;
    T u[3];
    const T log_density = Run(x, code, u, &tape);
    std::vector<T> gw(shape_.NumWeights(), T(0));
    std::vector<T> gz(shape_.code_size, T(0));
    T gx[3] = {T(0), T(0), T(0)};
    for (int l = shape_.layers - 1; l >= 0; --l) {
      BackwardLayer(l, tape, code, gx, gz.data(), gw.data());
    }
    if (dx != nullptr) std::copy(gx, gx + 3, dx);
    if (dcode != nullptr) std::copy(gz.begin(), gz.end(), dcode);
    if (dweights != nullptr) *dweights = std::move(gw);
    return log_density;
  }

  // The point x with latent point u in [0,1]^3, and its log density.
  T Inverse(const T* u, const T* code, T* x) const {
    T p[3] = {u[0], u[1], u[2]};
    T log_density = T(0);
    std::vector<T> rows(shape_.ActivationRows());
    for (int l = shape_.layers - 1; l >= 0; --l) {
      const CouplingDims d = DimsOfLayer(l);
      Conditioner(l, p[d.first], p[d.second], code, rows.data());
      const Spline s = MakeSpline(rows.data() + shape_.OutputRow());
      const T target = p[d.transformed] * s.total;
      int b = 0;
      while (b + 1 < shape_.bins && target >= s.area_before[b + 1]) ++b;
      const T c = (target - s.area_before[b]) / s.width[b];
      const T v0 = s.slope[b], dv = s.slope[b + 1] - s.slope[b];
      using std::log;
      using std::sqrt;
      // Stable root of v0 a + dv a^2 / 2 = c.
      const T root = sqrt(std::max(v0 * v0 + 2 * dv * c, T(0)));
      T a = v0 + root > T(0) ? 2 * c / (v0 + root) : T(0);
      a = std::clamp(a, T(0), T(1));
      p[d.transformed] = std::clamp(s.knot[b] + a * s.width[b], T(0), T(1));
      log_density += log((v0 + a * dv) / s.total);
    }
    std::copy(p, p + 3, x);
    return log_density;
  }

 private:
  struct Spline {
    std::vector<T> width, slope;       // [bins], [bins + 1] before scaling
    std::vector<T> knot, area_before;  // left knots, areas left of them
    std::vector<T> softmax, squash;    // squash: ds/dp of the slopes
    T total = T(0);
  };
  struct LayerTape {
    std::vector<T> rows;
    T x = T(0), y = T(0);
  };
  using Tape = std::vector<LayerTape>;

  static T Activate(T x) {
    using std::abs;
    using std::sqrt;
    const T t = sqrt(x * x + T(kSharpness)) + abs(x);
    return x > T(0) ? t / 2 : T(kSharpness) / (2 * t);
  }

  void Conditioner(int layer, T a, T b, const T* code, T* rows) const {
    const T* w = weights_.data() + layer * shape_.WeightsPerLayer();
    rows[0] = 2 * a - 1;
    rows[1] = 2 * b - 1;
    for (size_t i = 0; i < dense_.size(); ++i) {
      const DenseLayer& d = dense_[i];
      for (int o = 0; o < d.out_count; ++o) {
        T sum = w[d.bias_offset + o];
        for (int k = 0; k < d.in_count; ++k) {
          sum += w[d.weight_offset + o * d.in_count + k] * rows[d.in + k];
        }
        if (i == 0) {
          const T* wz = w + shape_.CodeWeightOffset() + o * shape_.code_size;
          for (int k = 0; k < shape_.code_size; ++k) sum += wz[k] * code[k];
        }
        rows[d.out + o] = d.activation ? Activate(sum) : sum;
      }
    }
  }

  Spline MakeSpline(const T* p) const {
    using std::abs;
    using std::exp;
    const int n = shape_.bins;
    Spline s;
    for (int k = 0; k <= n; ++k) {
      const T scale = 1 / (1 + abs(p[k]) / T(kSlopeRange));
      s.slope.push_back(exp(p[k] * scale));
      s.squash.push_back(scale * scale);
    }
    const T* q = p + n + 1;
    const T top = *std::max_element(q, q + n);
    T sum = T(0);
    for (int k = 0; k < n; ++k) {
      s.softmax.push_back(exp(q[k] - top));
      sum += s.softmax.back();
    }
    T knot = T(0);
    for (int k = 0; k < n; ++k) {
      s.softmax[k] /= sum;
      s.width.push_back((1 - n * T(kMinWidth)) * s.softmax[k] + T(kMinWidth));
      s.knot.push_back(knot);
      s.area_before.push_back(s.total);
      knot += s.width[k];
      s.total += (s.slope[k] + s.slope[k + 1]) / 2 * s.width[k];
    }
    return s;
  }

  int FindBin(const Spline& s, T x) const {
    int b = 0;
    while (b + 1 < shape_.bins && x >= s.knot[b + 1]) ++b;
    return b;
  }

  T Run(const T* x, const T* code, T* u, Tape* tape) const {
    using std::log;
    T p[3] = {x[0], x[1], x[2]};
    T log_density = T(0);
    tape->resize(shape_.layers);
    for (int l = 0; l < shape_.layers; ++l) {
      const CouplingDims d = DimsOfLayer(l);
      LayerTape& t = (*tape)[l];
      t.rows.resize(shape_.ActivationRows());
      Conditioner(l, p[d.first], p[d.second], code, t.rows.data());
      const Spline s = MakeSpline(t.rows.data() + shape_.OutputRow());
      t.x = p[d.transformed];
      const int b = FindBin(s, t.x);
      const T a = std::min((t.x - s.knot[b]) / s.width[b], T(1));
      const T dv = s.slope[b + 1] - s.slope[b];
      t.y = (s.area_before[b] + a * s.width[b] * (s.slope[b] + a * dv / 2)) /
            s.total;
      log_density += log((s.slope[b] + a * dv) / s.total);
      p[d.transformed] = std::clamp(t.y, T(0), T(1));
    }
    std::copy(p, p + 3, u);
    return log_density;
  }

  // Adjoint of layer l: gx comes in as the adjoint of its output point (the
  // log density's adjoint is 1) and leaves as that of its input point.
  void BackwardLayer(int l, const Tape& tape, const T* code, T* gx, T* gz,
                     T* gw) const {
    const CouplingDims dims = DimsOfLayer(l);
    const LayerTape& t = tape[l];
    std::vector<T> grows(t.rows.size(), T(0));
    gx[dims.transformed] = BackwardSpline(t, gx[dims.transformed],
                                          grows.data() + shape_.OutputRow());
    BackwardConditioner(t, code, weights_.data() + l * shape_.WeightsPerLayer(),
                        grows.data(), gz, gw + l * shape_.WeightsPerLayer());
    gx[dims.first] += 2 * grows[0];
    gx[dims.second] += 2 * grows[1];
  }

  // Adjoint of a layer's spline, from that of its output: gp [2 bins + 1] of
  // its parameters and, returned, that of its input.
  T BackwardSpline(const LayerTape& t, T gy, T* gp) const {
    const int n = shape_.bins;
    const Spline s = MakeSpline(t.rows.data() + shape_.OutputRow());
    const int b = FindBin(s, t.x);
    const T a = std::min((t.x - s.knot[b]) / s.width[b], T(1));
    const T dv = s.slope[b + 1] - s.slope[b];
    const T slope = s.slope[b] + a * dv;
    std::vector<T> ge(n + 1, T(0)), gwidth(n, T(0));
    for (int k = 0; k < n; ++k) {
      const T mean = (s.slope[k] + s.slope[k + 1]) / 2;
      const T share = (gy * t.y + 1) / s.total;  // through the normalisation
      ge[k] -= share * s.width[k] / 2;
      ge[k + 1] -= share * s.width[k] / 2;
      gwidth[k] -= share * mean;
      if (k < b) {
        ge[k] += gy / s.total * s.width[k] / 2;
        ge[k + 1] += gy / s.total * s.width[k] / 2;
        gwidth[k] += gy / s.total * (mean - slope) - dv / (slope * s.width[b]);
      }
    }
    ge[b] += gy / s.total * s.width[b] * (a - a * a / 2) + (1 - a) / slope;
    ge[b + 1] += gy / s.total * s.width[b] * a * a / 2 + a / slope;
    gwidth[b] += -gy / s.total * a * a * dv / 2 - a * dv / (slope * s.width[b]);
    for (int k = 0; k <= n; ++k) gp[k] = ge[k] * s.slope[k] * s.squash[k];
    T mean_g = T(0);
    for (int k = 0; k < n; ++k) mean_g += s.softmax[k] * gwidth[k];
    for (int k = 0; k < n; ++k) {
      gp[n + 1 + k] =
          (1 - n * T(kMinWidth)) * s.softmax[k] * (gwidth[k] - mean_g);
    }
    return gy * slope / s.total + dv / (slope * s.width[b]);
  }

  // Adjoint of a layer's conditioner of weights w: from that of its output
  // rows, in `grows`, to its input rows, the code and the weights.
  void BackwardConditioner(const LayerTape& t, const T* code, const T* w,
                           T* grows, T* gz, T* gw) const {
    for (int i = static_cast<int>(dense_.size()) - 1; i >= 0; --i) {
      const DenseLayer& d = dense_[i];
      for (int o = 0; o < d.out_count; ++o) {
        T g = grows[d.out + o];
        if (d.activation) {
          const T y2 = 4 * t.rows[d.out + o] * t.rows[d.out + o];
          g *= y2 / (y2 + T(kSharpness));
        }
        gw[d.bias_offset + o] += g;
        for (int k = 0; k < d.in_count; ++k) {
          const size_t at = d.weight_offset + o * d.in_count + k;
          gw[at] += g * t.rows[d.in + k];
          grows[d.in + k] += g * w[at];
        }
        if (i == 0) {
          const size_t at = shape_.CodeWeightOffset() + o * shape_.code_size;
          for (int k = 0; k < shape_.code_size; ++k) {
            gw[at + k] += g * code[k];
            gz[k] += g * w[at + k];
          }
        }
      }
    }
  }

  CouplingShape shape_;
  std::vector<DenseLayer> dense_;
  std::vector<T> weights_;
};

}  // namespace ibrdf
