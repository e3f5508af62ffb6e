// How Transport and LightOperator read their pairs: four-lane arithmetic on
// red, green, blue and a spare lane, and the taps' weights. Internal.
#pragma once
#include <cstddef>
#include <cstring>

#include "ibrdf/brdf/brdf_grid.h"

namespace ibrdf {
namespace taps {

// Fractions are stored in units of 1/65535.
inline constexpr float kUnit = 1.0f / 65535.0f;

// Red, green, blue and a spare lane.
using Float4 [[gnu::vector_size(16)]] = float;
using Double4 [[gnu::vector_size(32)]] = double;

inline Float4 Load4(const float* p) {
  Float4 v;
  std::memcpy(&v, p, sizeof(v));
  return v;
}
inline void Add4(float* p, Float4 x) {
  const Float4 v = Load4(p) + x;
  std::memcpy(p, &v, sizeof(v));
}
inline Double4 Widen(Float4 v) { return __builtin_convertvector(v, Double4); }

// Eight taps of a pair: offsets from its lowest node in corner order (h, d, p).
struct Corners {
  explicit Corners(const BrdfGridShape& s) {
    const int row = s.p + 1, plane = s.d * row;
    for (int k = 0; k < 8; ++k) {
      offset[k] = (k >> 2) * plane + ((k >> 1) & 1) * row + (k & 1);
    }
  }
  int offset[8];
};

template <typename Pair>
void TrilinearWeights(const Pair& pair, float weight[8]) {
  const float h = pair.fh * kUnit, d = pair.fd * kUnit, p = pair.fp * kUnit;
  const float hd[4] = {(1 - h) * (1 - d), (1 - h) * d, h * (1 - d), h * d};
  for (int k = 0; k < 4; ++k) {
    weight[2 * k] = hd[k] * (1 - p);
    weight[2 * k + 1] = hd[k] * p;
  }
}

template <typename Pair>
Float4 Interpolate(const Pair& pair, const Corners& corners,
                   const float* grid) {
  float weight[8];
  TrilinearWeights(pair, weight);
  const float* base = grid + size_t{4} * pair.node;
  Float4 f = {};
  for (int k = 0; k < 8; ++k) {
    f += weight[k] * Load4(base + 4 * corners.offset[k]);
  }
  return f;
}

// Four taps of a near pair into the padded map.
template <typename Pair>
void BilinearWeights(const Pair& pair, float weight[4]) {
  const float x = pair.fx * kUnit, y = pair.fy * kUnit;
  weight[0] = (1 - y) * (1 - x);
  weight[1] = (1 - y) * x;
  weight[2] = y * (1 - x);
  weight[3] = y * x;
}

template <typename Pair>
Float4 LookUp(const Pair& pair, int row, const float* texels) {
  float weight[4];
  BilinearWeights(pair, weight);
  const float* base = texels + size_t{4} * pair.texel;
  return weight[0] * Load4(base) + weight[1] * Load4(base + 4) +
         weight[2] * Load4(base + 4 * row) +
         weight[3] * Load4(base + 4 * row + 4);
}

}  // namespace taps
}  // namespace ibrdf
