#include "ibrdf/flow/triangular_kernels.h"

#include "ibrdf/flow/dense_kernels.h"
#include "ibrdf/flow/triangular_shape.h"

namespace ibrdf {
namespace IBRDF_SIMD_NAMESPACE {
namespace {

constexpr int kB = kColumnBlock;
constexpr float kGain = static_cast<float>(kHeightGain);
constexpr float kRange = static_cast<float>(kHeightRange);
constexpr float kMinWidth = static_cast<float>(kMinBinWidth);

void Condition(const ConditionerView& v, float* rows) {
  for (int i = 0; i < v.num_dense; ++i) {
    const DenseLayer& d = v.dense[i];
    float* out = rows + d.out * kB;
    const float* bias = i == 0 && v.first_bias != nullptr
                            ? v.first_bias
                            : v.weights + d.bias_offset;
    Product<false>(d.out_count, kB, d.in_count, v.weights + d.weight_offset,
                   d.in_count, 1, rows + d.in * kB, kB, out, kB, bias);
    if (i == 0 && v.first_bias == nullptr) {
      Product<true>(d.out_count, kB, v.code_size, v.weights + v.code_offset,
                    v.code_size, 1, v.codes, kB, out, kB, nullptr);
    }
    if (d.activation) Activate(out, d.out_count * kB);
  }
}

// (e^d - 1) / d, given e^d.
inline Vf MeanExp(Vf d, Vf e) {
  Vf series = Splat(1.0f / 5040.0f);
  series = series * d + 1.0f / 720.0f;
  series = series * d + 1.0f / 120.0f;
  series = series * d + 1.0f / 24.0f;
  series = series * d + 1.0f / 6.0f;
  series = series * d + 0.5f;
  series = series * d + 1.0f;
  const Vi small = Abs(d) < 0.5f;
  const Vf safe = Select(small, Splat(1.0f), d);
  return Select(small, series, (e - 1.0f) / safe);
}

// The derivative of MeanExp, given its value and e^d.
inline Vf MeanExpSlope(Vf d, Vf e, Vf mean) {
  Vf series = Splat(1.0f / 5760.0f);
  series = series * d + 1.0f / 840.0f;
  series = series * d + 1.0f / 144.0f;
  series = series * d + 1.0f / 30.0f;
  series = series * d + 1.0f / 8.0f;
  series = series * d + 1.0f / 3.0f;
  series = series * d + 0.5f;
  const Vi small = Abs(d) < 0.5f;
  const Vf safe = Select(small, Splat(1.0f), d);
  return Select(small, series, (e - mean) / safe);
}

// The spline of kLanes columns. `raw` are heights before the total is taken
// off.
struct Spline {
  Vf knot[kMaxSplineBins], width[kMaxSplineBins], softmax[kMaxSplineBins];
  Vf height[kMaxSplineBins + 1], slope[kMaxSplineBins];
  // Mass of a bin over the total, and the part of the total's logarithmic
  // derivative by the right and left height that comes from the bin.
  Vf mass[kMaxSplineBins], right[kMaxSplineBins], left[kMaxSplineBins];
  Vf log_total;
};

inline Vf HeightScale(Vf p) { return kRange / (kRange + Abs(kGain * p)); }

template <bool kDerivatives>
inline void MakeSpline(const ConditionerView& v, const float* rows, int lane,
                       Spline* s) {
  const float* p = rows + v.output_row * kB + lane;
  const int n = v.bins;
  Vf top = Splat(-kRange);
  for (int k = 0; k < v.heights; ++k) {
    const Vf q = Load(p + k * kB);
    s->height[k] = kGain * q * HeightScale(q);
    top = Max(top, s->height[k]);
  }
  if (v.heights == n) s->height[n] = s->height[0];
  const float* q = p + v.heights * kB;
  Vf largest = Load(q);
  for (int k = 1; k < n; ++k) largest = Max(largest, Load(q + k * kB));
  Vf sum = Vf{};
  for (int k = 0; k < n; ++k) {
    s->softmax[k] = Exp(Load(q + k * kB) - largest);
    sum += s->softmax[k];
  }
  const Vf inverse = 1.0f / sum;
  const float scale = 1.0f - static_cast<float>(n) * kMinWidth;
  Vf knot = Vf{}, total = Vf{};
  for (int k = 0; k < n; ++k) {
    s->softmax[k] *= inverse;
    s->width[k] = s->softmax[k] * scale + kMinWidth;
    s->knot[k] = knot;
    knot += s->width[k];
    const Vf d = s->height[k + 1] - s->height[k];
    s->slope[k] = d / s->width[k];
    const Vf e = Exp(d);
    const Vf mean = MeanExp(d, e);
    const Vf level = s->width[k] * Exp(s->height[k] - top);
    s->mass[k] = level * mean;
    if (kDerivatives) {
      s->right[k] = level * MeanExpSlope(d, e, mean);
      s->left[k] = s->mass[k] - s->right[k];
    }
    total += s->mass[k];
  }
  s->log_total = Log(total) + top;
  if (kDerivatives) {
    const Vf share = 1.0f / total;
    for (int k = 0; k < n; ++k) {
      s->mass[k] *= share;
      s->right[k] *= share;
      s->left[k] *= share;
    }
  }
}

void Evaluate(const ConditionerView& v, const float* rows, const float* x,
              int points, const float* base, float* log_density) {
  for (int lane = 0; lane < kB; lane += kLanes) {
    Spline s;
    MakeSpline<false>(v, rows, lane, &s);
    for (int k = 0; k < v.bins; ++k) s.height[k] -= s.log_total;
    const Vf start = base != nullptr ? Load(base + lane) : Vf{};
    for (int i = 0; i < points; ++i) {
      const Vf xi = Load(x + i * kB + lane);
      Vf knot = Vf{}, height = s.height[0], slope = s.slope[0];
      for (int k = 1; k < v.bins; ++k) {
        const Vi past = xi >= s.knot[k];
        knot = Select(past, s.knot[k], knot);
        height = Select(past, s.height[k], height);
        slope = Select(past, s.slope[k], slope);
      }
      Store(log_density + i * kB + lane, start + height + slope * (xi - knot));
    }
  }
}

// Adjoints of heights [bins + 1] and widths [bins] to those of the parameters.
inline void StoreParameterAdjoint(const ConditionerView& v, const Spline& s,
                                  const float* rows, int lane, Vf* gheight,
                                  const Vf* gwidth, float* grows) {
  const float* p = rows + v.output_row * kB + lane;
  float* g = grows + v.output_row * kB + lane;
  const int n = v.bins;
  if (v.heights == n) gheight[0] += gheight[n];
  for (int k = 0; k < v.heights; ++k) {
    const Vf scale = HeightScale(Load(p + k * kB));
    Store(g + k * kB, gheight[k] * kGain * scale * scale);
  }
  Vf mean = Vf{};
  for (int k = 0; k < n; ++k) mean += s.softmax[k] * gwidth[k];
  const float scale = 1.0f - static_cast<float>(n) * kMinWidth;
  for (int k = 0; k < n; ++k) {
    Store(g + (v.heights + k) * kB, scale * s.softmax[k] * (gwidth[k] - mean));
  }
}

void Adjoint(const ConditionerView& v, const float* rows, const float* x,
             int points, const float* adjoint, float* grows, float* dx) {
  const int n = v.bins;
  for (int lane = 0; lane < kB; lane += kLanes) {
    Spline s;
    MakeSpline<true>(v, rows, lane, &s);
    // Per bin, the sums of the adjoint and of adjoint times (x - knot).
    Vf flat[kMaxSplineBins], tilt[kMaxSplineBins];
    flat[0] = tilt[0] = Vf{};
    for (int k = 1; k < n; ++k) flat[k] = tilt[k] = Vf{};
    for (int i = 0; i < points; ++i) {
      const Vf xi = Load(x + i * kB + lane);
      const Vf g = Load(adjoint + i * kB + lane);
      Vf slope = Vf{};
      // Sums over x >= knot, made sums per bin below.
      for (int k = 0; k < n; ++k) {
        const Vi past = k == 0 ? (xi == xi) : (xi >= s.knot[k]);
        const Vf here = Select(past, g, Vf{});
        flat[k] += here;
        tilt[k] += here * xi;
        slope = Select(past, s.slope[k], slope);
      }
      if (dx != nullptr) Store(dx + i * kB + lane, g * slope);
    }
    const Vf all = flat[0];
    for (int k = 0; k < n; ++k) {
      if (k + 1 < n) {
        flat[k] -= flat[k + 1];
        tilt[k] -= tilt[k + 1];
      }
      tilt[k] -= flat[k] * s.knot[k];
    }
    Vf gheight[kMaxSplineBins + 1], gwidth[kMaxSplineBins];
    for (int k = 0; k <= n; ++k) gheight[k] = Vf{};
    Vf gknot = Vf{};  // of the knots right of the bin
    for (int k = n - 1; k >= 0; --k) {
      const Vf per_width = tilt[k] / s.width[k];
      gheight[k] += flat[k] - per_width - all * s.left[k];
      gheight[k + 1] += per_width - all * s.right[k];
      gwidth[k] = gknot - s.slope[k] * per_width - all * s.mass[k] / s.width[k];
      gknot -= s.slope[k] * flat[k];
    }
    StoreParameterAdjoint(v, s, rows, lane, gheight, gwidth, grows);
  }
}

void Backward(const ConditionerView& v, const float* rows, float* grows,
              float* scratch, float* weight_gradient, float* bias_gradient,
              float* code_weight_gradient, float* dcode, bool dfeatures) {
  for (int i = v.num_dense - 1; i >= 0; --i) {
    const DenseLayer& d = v.dense[i];
    float* g = grows + d.out * kB;
    if (d.activation) ActivationAdjoint(rows + d.out * kB, g, d.out_count * kB);
    if (weight_gradient != nullptr) {
      AddLayerGradient<kB>(d, rows + d.in * kB, g, scratch,
                           bias_gradient + d.out,
                           weight_gradient + d.padded_offset);
      if (i == 0) {
        const int padded =
            (v.code_size + 2 * kLanes - 1) / (2 * kLanes) * (2 * kLanes);
        TransposeRows<kB>(v.codes, v.code_size, padded, scratch);
        Product<true>(d.out_count, padded, kB, g, kB, 1, scratch, padded,
                      code_weight_gradient, PaddedCount(v.code_size), nullptr);
      }
    }
    if (i > 0 || dfeatures) {
      Product<true>(d.in_count, kB, d.out_count, v.weights + d.weight_offset, 1,
                    d.in_count, g, kB, grows + d.in * kB, kB, nullptr);
    }
    if (i == 0 && dcode != nullptr) {
      Product<true>(v.code_size, kB, d.out_count, v.weights + v.code_offset, 1,
                    v.code_size, g, kB, dcode, kB, nullptr);
    }
  }
}

// Tangents of the parameters by the code, [row][code_size][32], in one of the
// two halves of `scratch`.
const float* Tangents(const ConditionerView& v, const float* rows,
                      float* scratch) {
  const int columns = v.code_size * kB;
  int widest = 0;
  for (int i = 0; i < v.num_dense; ++i) {
    widest = widest < v.dense[i].out_count ? v.dense[i].out_count : widest;
  }
  float* half[2] = {scratch, scratch + static_cast<size_t>(widest) * columns};
  for (int i = 0; i < v.num_dense; ++i) {
    const DenseLayer& d = v.dense[i];
    float* out = half[i % 2];
    if (i == 0) {
      const float* w = v.weights + v.code_offset;
      for (int k = 0; k < d.out_count * v.code_size; ++k) {
        for (int lane = 0; lane < kB; lane += kLanes) {
          Store(out + k * kB + lane, Splat(w[k]));
        }
      }
    } else {
      Product<false>(d.out_count, columns, d.in_count,
                     v.weights + d.weight_offset, d.in_count, 1,
                     half[1 - i % 2], columns, out, columns, nullptr);
    }
    if (!d.activation) continue;
    for (int o = 0; o < d.out_count; ++o) {
      for (int lane = 0; lane < kB; lane += kLanes) {
        const Vf slope = ActivationSlope(Load(rows + (d.out + o) * kB + lane));
        float* t = out + o * columns + lane;
        for (int j = 0; j < v.code_size; ++j) {
          Store(t + j * kB, Load(t + j * kB) * slope);
        }
      }
    }
  }
  return half[(v.num_dense - 1) % 2];
}

void CodePieces(const ConditionerView& v, const float* rows, float* scratch,
                float* pieces) {
  const float* tangents = Tangents(v, rows, scratch);
  const int n = v.bins, columns = v.code_size * kB;
  for (int lane = 0; lane < kB; lane += kLanes) {
    Spline s;
    MakeSpline<true>(v, rows, lane, &s);
    Vf height_scale[kMaxSplineBins + 1];
    for (int k = 0; k < v.heights; ++k) {
      const Vf scale = HeightScale(Load(rows + (v.output_row + k) * kB + lane));
      height_scale[k] = kGain * scale * scale;
    }
    const float width_scale = 1.0f - static_cast<float>(n) * kMinWidth;
    for (int j = 0; j < v.code_size; ++j) {
      const float* t = tangents + j * kB + lane;
      const float* tw = t + v.heights * columns;
      Vf mean = Vf{};
      for (int k = 0; k < n; ++k) mean += s.softmax[k] * Load(tw + k * columns);
      Vf dtotal = Vf{}, dknot = Vf{};
      Vf dleft = Load(t) * height_scale[0];
      const Vf first = dleft;
      float* out = pieces + j * 2 * kB + lane;
      for (int k = 0; k < n; ++k) {
        const Vf dright = k + 1 < v.heights ? Load(t + (k + 1) * columns) *
                                                  height_scale[k + 1]
                                            : first;
        const Vf dwidth =
            width_scale * s.softmax[k] * (Load(tw + k * columns) - mean);
        dtotal += s.left[k] * dleft + s.right[k] * dright +
                  s.mass[k] * dwidth / s.width[k];
        float* piece = out + static_cast<size_t>(k) * columns * 2;
        Store(piece, dleft - s.slope[k] * dknot);
        Store(piece + kB, (dright - dleft - s.slope[k] * dwidth) / s.width[k]);
        dknot += dwidth;
        dleft = dright;
      }
      for (int k = 0; k < n; ++k) {
        float* piece = out + static_cast<size_t>(k) * columns * 2;
        Store(piece, Load(piece) - dtotal);
      }
    }
  }
}

void CodeGradient(const ConditionerView& v, const float* rows,
                  const float* pieces, const float* x, int points,
                  const float* base, int lanes, size_t code_stride,
                  size_t point_stride, float* out) {
  const int columns = v.code_size * kB;
  for (int lane = 0; lane < lanes; lane += kLanes) {
    Spline s;
    MakeSpline<false>(v, rows, lane, &s);
    Vi lane_index = Vi{};
    for (int i = 0; i < kLanes; ++i) lane_index[i] = lane + i;
    const bool whole = lane + kLanes <= lanes;
    for (int i = 0; i < points; ++i) {
      const Vf xi = Load(x + i * kB + lane);
      Vi bin = Vi{};
      Vf knot = Vf{};
      for (int k = 1; k < v.bins; ++k) {
        const Vi past = xi >= s.knot[k];
        bin -= past;
        knot = Select(past, s.knot[k], knot);
      }
      const Vf along = xi - knot;
      const Vi index = bin * (2 * columns) + lane_index;
      for (int j = 0; j < v.code_size; ++j) {
        const float* piece = pieces + j * 2 * kB;
        Vf value = GatherFloats(piece, index) +
                   along * GatherFloats(piece + kB, index);
        if (base != nullptr) value += Load(base + j * kB + lane);
        float* to = out + j * code_stride + i * point_stride + lane;
        if (whole) {
          Store(to, value);
        } else {
          for (int l = 0; l < lanes - lane; ++l) to[l] = value[l];
        }
      }
    }
  }
}

}  // namespace

extern const TriangularKernels kTriangularKernels;
const TriangularKernels kTriangularKernels = {
    Condition, Evaluate, Adjoint, Backward, CodePieces, CodeGradient};

}  // namespace IBRDF_SIMD_NAMESPACE
}  // namespace ibrdf
