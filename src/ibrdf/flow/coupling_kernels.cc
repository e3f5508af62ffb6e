#include "ibrdf/flow/coupling_kernels.h"

#include "ibrdf/flow/coupling_constants.h"
#include "ibrdf/flow/dense_kernels.h"

namespace ibrdf {
namespace IBRDF_SIMD_NAMESPACE {
namespace {

constexpr int kP = kCouplingBlock;
constexpr int kMaxBins = 32;
constexpr float kSlopeRangeF = static_cast<float>(kSlopeRange);
constexpr float kMinWidthF = static_cast<float>(kMinWidth);

// a, b: the conditioning coordinates [64]. Fills the activations.
void Conditioner(const CouplingView& v, int layer, const float* a,
                 const float* b, float* rows) {
  for (int p = 0; p < kP; p += kLanes) {
    Store(rows + p, 2.0f * Load(a + p) - 1.0f);
    Store(rows + kP + p, 2.0f * Load(b + p) - 1.0f);
  }
  const float* w = v.weights + layer * v.weights_per_layer;
  for (int i = 0; i < v.num_dense; ++i) {
    const DenseLayer& d = v.dense[i];
    const float* bias =
        i == 0 ? v.first_bias + layer * d.out_count : w + d.bias_offset;
    Product<false>(d.out_count, kP, d.in_count, w + d.weight_offset, d.in_count,
                   1, rows + d.in * kP, kP, rows + d.out * kP, kP, bias);
    if (d.activation) Activate(rows + d.out * kP, d.out_count * kP);
  }
}

// The spline of kLanes points at column p of the parameter rows.
struct Spline {
  Vf slope[kMaxBins + 1], width[kMaxBins], softmax[kMaxBins];
  Vf total;
};

inline Vf SlopeScale(Vf p) { return kSlopeRangeF / (kSlopeRangeF + Abs(p)); }

inline void MakeSpline(int n, const float* params, int p, Spline* s) {
  for (int k = 0; k <= n; ++k) {
    const Vf q = Load(params + k * kP + p);
    s->slope[k] = Exp(q * SlopeScale(q));
  }
  const float* q = params + (n + 1) * kP + p;
  Vf top = Load(q);
  for (int k = 1; k < n; ++k) top = Max(top, Load(q + k * kP));
  Vf sum = Vf{};
  for (int k = 0; k < n; ++k) {
    s->softmax[k] = Exp(Load(q + k * kP) - top);
    sum += s->softmax[k];
  }
  const Vf inverse = 1.0f / sum;
  const float scale = 1.0f - static_cast<float>(n) * kMinWidthF;
  s->total = Vf{};
  for (int k = 0; k < n; ++k) {
    s->softmax[k] *= inverse;
    s->width[k] = s->softmax[k] * scale + kMinWidthF;
    s->total += 0.5f * (s->slope[k] + s->slope[k + 1]) * s->width[k];
  }
}

// Quantities of the bin that holds x (or, with kInverse, the latent value).
struct Piece {
  Vf v0, dv, width, knot, area;
  Vi bin;
};

template <bool kInverse>
inline Piece FindPiece(int n, const Spline& s, Vf target) {
  Piece r;
  r.bin = Vi{};
  r.v0 = s.slope[0];
  Vf v1 = s.slope[1];
  r.width = s.width[0];
  r.knot = Vf{};
  r.area = Vf{};
  Vf knot = Vf{}, area = Vf{};
  for (int k = 1; k < n; ++k) {
    knot += s.width[k - 1];
    area += 0.5f * (s.slope[k - 1] + s.slope[k]) * s.width[k - 1];
    const Vi past = target >= (kInverse ? area : knot);
    r.bin -= past;
    r.v0 = Select(past, s.slope[k], r.v0);
    v1 = Select(past, s.slope[k + 1], v1);
    r.width = Select(past, s.width[k], r.width);
    r.knot = Select(past, knot, r.knot);
    r.area = Select(past, area, r.area);
  }
  r.dv = v1 - r.v0;
  return r;
}

inline Vf Clamp01(Vf x) { return Min(Max(x, Vf{}), Splat(1.0f)); }

void Forward(const CouplingView& v, const float* x, float* tape, float* u,
             float* log_density) {
  const size_t layer_floats = static_cast<size_t>(v.rows + 2) * kP;
  for (int i = 0; i < 3 * kP; i += kLanes) Store(u + i, Load(x + i));
  for (int p = 0; p < kP; p += kLanes) Store(log_density + p, Vf{});
  for (int l = 0; l < v.layers; ++l) {
    float* rows = tape + l * layer_floats;
    float* x_in = rows + v.rows * kP;
    float* y_out = x_in + kP;
    const int t = l % 3, first = t == 0 ? 1 : 0, second = t == 2 ? 1 : 2;
    Conditioner(v, l, u + first * kP, u + second * kP, rows);
    const float* params = rows + v.output_row * kP;
    float* ut = u + t * kP;
    for (int p = 0; p < kP; p += kLanes) {
      Spline s;
      MakeSpline(v.bins, params, p, &s);
      const Vf xi = Load(ut + p);
      const Piece r = FindPiece<false>(v.bins, s, xi);
      const Vf a = Min((xi - r.knot) / r.width, Splat(1.0f));
      const Vf slope = r.v0 + a * r.dv;
      const Vf inverse = 1.0f / s.total;
      const Vf y = (r.area + a * r.width * (r.v0 + 0.5f * a * r.dv)) * inverse;
      Store(x_in + p, xi);
      Store(y_out + p, y);
      Store(ut + p, Clamp01(y));
      Store(log_density + p, Load(log_density + p) + Log(slope * inverse));
    }
  }
}

// Adjoint of one layer's spline for kLanes points: gu (adjoint of the output)
// becomes the adjoint of the input; grads of the parameters go to gparams.
inline void SplineAdjoint(int n, const float* params, int p, Vf xi, Vf y,
                          Vf adjoint, float* gut, float* gparams) {
  Spline s;
  MakeSpline(n, params, p, &s);
  const Piece r = FindPiece<false>(n, s, xi);
  const Vf a = Min((xi - r.knot) / r.width, Splat(1.0f));
  const Vf slope = r.v0 + a * r.dv;
  const Vf gy = Load(gut + p);
  const Vf inverse = 1.0f / s.total;
  const Vf gn = gy * inverse;
  const Vf share = (gy * y + adjoint) * inverse;
  const Vf per_slope = adjoint / slope;
  const Vf da = per_slope * r.dv / r.width;  // adjoint x d log slope / d knot
  Vf ge[kMaxBins + 1], gw[kMaxBins];
  for (int k = 0; k <= n; ++k) ge[k] = Vf{};
  Vf mean_g = Vf{};
  for (int k = 0; k < n; ++k) {
    const Vf mean = 0.5f * (s.slope[k] + s.slope[k + 1]);
    const Vf zero = Vf{};
    const Vi below = r.bin > k;
    const Vi here = r.bin == k;
    const Vf both = 0.5f * s.width[k] * (Select(below, gn, zero) - share);
    ge[k] +=
        both +
        Select(here, gn * r.width * (a - 0.5f * a * a) + (1.0f - a) * per_slope,
               zero);
    ge[k + 1] +=
        both + Select(here, gn * r.width * 0.5f * a * a + a * per_slope, zero);
    gw[k] = Select(below, gn * (mean - slope) - da, zero) +
            Select(here, -0.5f * gn * a * a * r.dv - a * da, zero) -
            share * mean;
    mean_g += s.softmax[k] * gw[k];
  }
  const float scale = 1.0f - static_cast<float>(n) * kMinWidthF;
  for (int k = 0; k <= n; ++k) {
    const Vf f = SlopeScale(Load(params + k * kP + p));
    Store(gparams + k * kP + p, ge[k] * s.slope[k] * f * f);
  }
  for (int k = 0; k < n; ++k) {
    Store(gparams + (n + 1 + k) * kP + p,
          scale * s.softmax[k] * (gw[k] - mean_g));
  }
  Store(gut + p, gn * slope + da);
}

void Backward(const CouplingView& v, const float* tape, const float* adjoint,
              float* scratch, float* weight_gradient, float* bias_gradient,
              float* dcode, float* dx) {
  const size_t layer_floats = static_cast<size_t>(v.rows + 2) * kP;
  float* grows = scratch;                         // [rows][64]
  float* gu = scratch + v.rows * kP;              // [3][64]
  float* transposed = scratch + 2 * v.rows * kP;  // [64][padded in_count]
  for (int i = 0; i < 3 * kP; i += kLanes) Store(gu + i, Vf{});
  if (dcode != nullptr) {
    for (int i = 0; i < v.code_size * kP; i += kLanes) Store(dcode + i, Vf{});
  }
  for (int l = v.layers - 1; l >= 0; --l) {
    const float* rows = tape + l * layer_floats;
    const float* x_in = rows + v.rows * kP;
    const float* y_out = x_in + kP;
    const int t = l % 3, first = t == 0 ? 1 : 0, second = t == 2 ? 1 : 2;
    for (int i = 0; i < v.rows * kP; i += kLanes) Store(grows + i, Vf{});
    for (int p = 0; p < kP; p += kLanes) {
      SplineAdjoint(v.bins, rows + v.output_row * kP, p, Load(x_in + p),
                    Load(y_out + p), Load(adjoint + p), gu + t * kP,
                    grows + v.output_row * kP);
    }
    const float* w = v.weights + l * v.weights_per_layer;
    for (int i = v.num_dense - 1; i >= 0; --i) {
      const DenseLayer& d = v.dense[i];
      float* g = grows + d.out * kP;
      if (d.activation)
        ActivationAdjoint(rows + d.out * kP, g, d.out_count * kP);
      if (weight_gradient != nullptr) {
        AddLayerGradient<kP>(
            d, rows + d.in * kP, g, transposed,
            bias_gradient + static_cast<size_t>(l) * v.rows + d.out,
            weight_gradient + l * v.padded_per_layer + d.padded_offset);
      }
      if (i > 0 || dx != nullptr || l > 0) {
        Product<true>(d.in_count, kP, d.out_count, w + d.weight_offset, 1,
                      d.in_count, g, kP, grows + d.in * kP, kP, nullptr);
      }
      if (i == 0 && dcode != nullptr) {
        Product<true>(v.code_size, kP, d.out_count, w + v.code_offset, 1,
                      v.code_size, g, kP, dcode, kP, nullptr);
      }
    }
    for (int p = 0; p < kP; p += kLanes) {
      Store(gu + first * kP + p,
            Load(gu + first * kP + p) + 2.0f * Load(grows + p));
      Store(gu + second * kP + p,
            Load(gu + second * kP + p) + 2.0f * Load(grows + kP + p));
    }
  }
  if (dx != nullptr) {
    for (int i = 0; i < 3 * kP; i += kLanes) Store(dx + i, Load(gu + i));
  }
}

void Inverse(const CouplingView& v, const float* u, float* scratch, float* x,
             float* log_density) {
  for (int i = 0; i < 3 * kP; i += kLanes) Store(x + i, Load(u + i));
  for (int p = 0; p < kP; p += kLanes) Store(log_density + p, Vf{});
  for (int l = v.layers - 1; l >= 0; --l) {
    const int t = l % 3, first = t == 0 ? 1 : 0, second = t == 2 ? 1 : 2;
    Conditioner(v, l, x + first * kP, x + second * kP, scratch);
    const float* params = scratch + v.output_row * kP;
    float* xt = x + t * kP;
    for (int p = 0; p < kP; p += kLanes) {
      Spline s;
      MakeSpline(v.bins, params, p, &s);
      const Vf target = Load(xt + p) * s.total;
      const Piece r = FindPiece<true>(v.bins, s, target);
      const Vf c = (target - r.area) / r.width;
      const Vf root = Sqrt(Max(r.v0 * r.v0 + 2.0f * r.dv * c, Vf{}));
      const Vf a = Clamp01(2.0f * c / (r.v0 + root));
      Store(xt + p, Clamp01(r.knot + a * r.width));
      Store(log_density + p,
            Load(log_density + p) + Log((r.v0 + a * r.dv) / s.total));
    }
  }
}

}  // namespace

extern const CouplingKernels kCouplingKernels;
const CouplingKernels kCouplingKernels = {Forward, Backward, Inverse};

}  // namespace IBRDF_SIMD_NAMESPACE
}  // namespace ibrdf
