// Real spherical harmonics at many directions, in single precision.
#pragma once
#include <cstdint>
#include <vector>

namespace ibrdf {

// HarmonicBasis at many directions: errors are below 2e-6 up to order 10.
// Immutable; safe to share between threads.
class HarmonicBatch {
 public:
  explicit HarmonicBatch(int order);

  int order() const { return order_; }
  int count() const { return (order_ + 1) * (order_ + 1); }

  // Y [count(), stride], row = harmonic, at `num_directions` <= stride unit
  // directions. They are given by their part along the polar axis, cos(theta),
  // and along the axes of phi = 0 and phi = pi / 2: (y, z, x) of a direction of
  // a map, (z, x, y) of one in a frame whose normal is +z.
  void Evaluate(const float* polar, const float* zero, const float* side,
                int num_directions, float* Y, int64_t stride) const;

 private:
  int order_;
  std::vector<float> diagonal_, up_, down_;
};

// Pointers to the constants of HarmonicBatch.
struct HarmonicConstants {
  int order;
  const float *diagonal, *up, *down;
};

namespace portable {
void EvaluateHarmonics(const HarmonicConstants& constants, const float* polar,
                       const float* zero, const float* side, int num_directions,
                       float* Y, int64_t stride);
}
namespace avx2 {
void EvaluateHarmonics(const HarmonicConstants& constants, const float* polar,
                       const float* zero, const float* side, int num_directions,
                       float* Y, int64_t stride);
}
namespace avx512 {
void EvaluateHarmonics(const HarmonicConstants& constants, const float* polar,
                       const float* zero, const float* side, int num_directions,
                       float* Y, int64_t stride);
}

}  // namespace ibrdf
