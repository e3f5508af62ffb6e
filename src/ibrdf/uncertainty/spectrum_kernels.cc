#include "ibrdf/uncertainty/spectrum_kernels.h"

#include "ibrdf/base/simd.h"

namespace ibrdf {
namespace IBRDF_SIMD_NAMESPACE {
namespace {

// Behind this exp(-x) is nothing, and x exp(-x) must stay finite.
constexpr float kFarthest = 80.0f;
// Light whose square is less is none: quotients by it overflow.
constexpr float kNoLight = 1e-30f;

// The distances of one alpha, as a function of k: rest + curvature (k -
// best)^2. All terms are >= 0: in the expanded square bright texels would lose
// all digits.
struct Parabola {
  Vf rest, curvature, best;

  Vf operator()(float k) const {
    const Vf t = k - best;
    return rest + curvature * (t * t);
  }
};

Parabola ParabolaOf(const float* filter, int num_degrees, const Vf* A,
                    const Vf* B) {
  Vf dot = {}, square = {};
  for (int l = 0; l < num_degrees; ++l) {
    const Vf model = filter[l] * A[l];
    dot += model * B[l];
    square += model * model;
  }
  // No light, no curvature: then all k are alike.
  square = Select(square > kNoLight, square, Vf{});
  const Vf best = Select(square > 0.0f, dot / square, Vf{});
  Vf rest = {};
  for (int l = 0; l < num_degrees; ++l) {
    const Vf r = best * (filter[l] * A[l]) - B[l];
    rest += r * r;
  }
  return {rest, square, best};
}

struct Result {
  Vf entropy, distance;
  Vi cell;
};

Result EntropyOf(const SpectrumGrid& g, const Vf* A, const Vf* B) {
  Parabola rows[kMostGridValues];
  const auto penalty = [&](int i, int j) {
    return g.penalty == nullptr ? 0.0f : g.penalty[i * g.num_ks + j];
  };
  Vf least = Splat(3e38f);
  Result out{Vf{}, Vf{}, Vi{}};
  for (int i = 0; i < g.num_alpha; ++i) {
    rows[i] = ParabolaOf(g.filter + i * g.num_degrees, g.num_degrees, A, B);
    for (int j = 0; j < g.num_ks; ++j) {
      const Vf x = rows[i](g.factor[j]);
      const Vf y = x + penalty(i, j);
      const Vi less = y < least;
      least = Min(least, y);
      out.distance = Select(less, x, out.distance);
      out.cell = (less & (i * g.num_ks + j)) | (~less & out.cell);
    }
  }
  // H = log Z + sum y exp(-y) / Z: one exponential a cell, and no logarithm.
  Vf Z = {}, mean = {};
  for (int i = 0; i < g.num_alpha; ++i) {
    for (int j = 0; j < g.num_ks; ++j) {
      const Vf y =
          Min(rows[i](g.factor[j]) + penalty(i, j) - least, Splat(kFarthest));
      const Vf e = Exp(-y);
      Z += e;
      mean += y * e;
    }
  }
  const Vf uniform = Log(Splat(static_cast<float>(g.num_alpha * g.num_ks)));
  out.entropy =
      Min(Max((Log(Z) + mean / Z) / uniform, Splat(0.0f)), Splat(1.0f));
  return out;
}

Vf LoadFirst(const float* p, size_t bytes) {
  Vf v = {};
  std::memcpy(&v, p, bytes);
  return v;
}

// A and B of one vector of signals, from signal `first` on.
void Signals(const SpectrumGrid& grid, const SpectrumScale& scale,
             const SpectrumSignals& signals, int first, size_t bytes, Vf* A,
             Vf* B) {
  Vf factor = Splat(1.0f);
  if (scale.outgoing_0 != nullptr) {
    factor = LoadFirst(scale.outgoing_0 + first, bytes);
  }
  for (int l = 0; l < grid.num_degrees; ++l) {
    A[l] = LoadFirst(signals.incoming + l * signals.stride + first, bytes);
    B[l] = LoadFirst(signals.outgoing + l * signals.stride + first, bytes);
    Vf unit = factor * scale.scale[l];
    if (scale.relative_floor > 0.0f) {
      const Vf size = A[l] + scale.relative_floor;
      unit /= scale.roots ? Sqrt(size) : size;
    }
    if (scale.roots) {
      A[l] = Sqrt(A[l]);
      B[l] = Sqrt(B[l]);
    }
    A[l] = Min(A[l] * unit, Splat(kLargestSignal));
    B[l] = Min(B[l] * unit, Splat(kLargestSignal));
  }
}

}  // namespace

void SpectrumEntropy(const SpectrumGrid& grid, const SpectrumScale& scale,
                     const SpectrumSignals& signals) {
  constexpr int kMostDegrees = 16;
  Vf A[kMostDegrees], B[kMostDegrees];
  for (int first = 0; first < signals.count; first += kLanes) {
    const int rest = signals.count - first;
    const size_t bytes = sizeof(float) * (rest < kLanes ? rest : kLanes);
    Signals(grid, scale, signals, first, bytes, A, B);
    const Result r = EntropyOf(grid, A, B);
    Vf size = {};
    for (int l = 0; l < grid.num_degrees; ++l) size += B[l] * B[l];
    const Vf misfit =
        Select(size > 0.0f, Min(r.distance / size, Splat(1.0f)), Vf{});
    std::memcpy(signals.entropy + first, &r.entropy, bytes);
    std::memcpy(signals.distance + first, &r.distance, bytes);
    std::memcpy(signals.misfit + first, &misfit, bytes);
    std::memcpy(signals.cell + first, &r.cell, bytes);
  }
}

}  // namespace IBRDF_SIMD_NAMESPACE
}  // namespace ibrdf
