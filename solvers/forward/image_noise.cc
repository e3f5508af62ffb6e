#include "ibrdf/solvers/forward/image_noise.h"

#include <cmath>

#include "ibrdf/base/normal_source.h"

namespace ibrdf {
void AddNoise(double sigma, uint64_t seed, Image* image) {
  if (sigma <= 0.0) return;
  DoubleNormalSource normal(seed);
  for (float& v : image->rgb) {
    v = static_cast<float>(v * std::exp(sigma * normal.Next()));
  }
}

}  // namespace ibrdf
