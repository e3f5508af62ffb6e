#include "ibrdf/uncertainty/expected_entropy_kernels.h"

#include "ibrdf/base/simd.h"

namespace ibrdf {
namespace IBRDF_SIMD_NAMESPACE {
namespace {

// Behind this exp(-x) is nothing, and x exp(-x) must stay finite.
constexpr float kFarthest = 80.0f;
// Light whose square is less is none: quotients by it overflow.
constexpr float kNoLight = 1e-30f;
// Parameters that are less probable do not count.
constexpr float kImprobable = 1e-6f;

// Distances of the parameters (alpha', k') from what (alpha, k) shows:
//   k^2 rest + curvature (k' - k best)^2.
struct PairOfFilters {
  Vf rest, curvature, best;
};

PairOfFilters Compare(const float* shown, const float* model, int num_degrees,
                      const Vf* A) {
  Vf dot = {}, square = {};
  for (int l = 0; l < num_degrees; ++l) {
    const Vf m = model[l] * A[l];
    dot += m * (shown[l] * A[l]);
    square += m * m;
  }
  square = Select(square > kNoLight, square, Vf{});
  const Vf best = Select(square > 0.0f, dot / square, Vf{});
  Vf rest = {};
  for (int l = 0; l < num_degrees; ++l) {
    const Vf r = (shown[l] - best * model[l]) * A[l];
    rest += r * r;
  }
  return {rest, square, best};
}

// Entropy, times log of the cells, of what k_j shows.
Vf EntropyOfShown(const SpectrumGrid& g, const PairOfFilters* pairs, float k,
                  float scale) {
  const auto for_each_cell = [&](const auto& body) {
    for (int i = 0; i < g.num_alpha; ++i) {
      const Vf rest = k * k * scale * pairs[i].rest;
      const Vf centre = k * pairs[i].best;
      const Vf curvature = scale * pairs[i].curvature;
      for (int j = 0; j < g.num_ks; ++j) {
        const Vf t = g.factor[j] - centre;
        const float penalty =
            g.penalty == nullptr ? 0.0f : g.penalty[i * g.num_ks + j];
        body(rest + curvature * (t * t) + penalty);
      }
    }
  };
  Vf least = Splat(3e38f), Z = {}, mean = {};
  for_each_cell([&](Vf x) { least = Min(least, x); });
  for_each_cell([&](Vf x) {
    const Vf y = Min(x - least, Splat(kFarthest));
    const Vf e = Exp(-y);
    Z += e;
    mean += y * e;
  });
  return Log(Z) + mean / Z;
}

Vf Expected(const SpectrumGrid& g, const ExpectedSignals& s, const Vf* A) {
  PairOfFilters pairs[kMostGridValues];
  Vf sum = {}, total = {};
  for (int i = 0; i < g.num_alpha; ++i) {
    const float* const shown = s.hypothetical + i * g.num_degrees;
    for (int k = 0; k < g.num_alpha; ++k) {
      pairs[k] = Compare(shown, g.filter + k * g.num_degrees, g.num_degrees, A);
    }
    for (int j = 0; j < g.num_ks; ++j) {
      const float p = s.probability[i * g.num_ks + j];
      if (p < kImprobable) continue;
      sum += p * EntropyOfShown(g, pairs, g.factor[j], s.scale[j]);
      total += p;
    }
  }
  const Vf uniform = Log(Splat(static_cast<float>(g.num_alpha * g.num_ks)));
  return sum / (total * uniform);
}

}  // namespace

void ExpectedEntropy(const SpectrumGrid& grid, const ExpectedSignals& signals) {
  constexpr int kMostDegrees = 16;
  Vf A[kMostDegrees];
  for (int first = 0; first < signals.count; first += kLanes) {
    const int rest = signals.count - first;
    const size_t bytes = sizeof(float) * (rest < kLanes ? rest : kLanes);
    for (int l = 0; l < grid.num_degrees; ++l) {
      A[l] = Vf{};
      std::memcpy(&A[l], signals.incoming + l * signals.stride + first, bytes);
    }
    const Vf expected = Expected(grid, signals, A);
    std::memcpy(signals.expected + first, &expected, bytes);
  }
}

}  // namespace IBRDF_SIMD_NAMESPACE
}  // namespace ibrdf
