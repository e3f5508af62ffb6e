// Standard normal numbers from a seed, the same on any machine: Box-Muller on
// bits of the generator, which the standard fixes (unlike
// std::normal_distribution).
//
// There are two, as their bits differ and results of either are kept: a network
// is known by its seed, and so is the noise of an image.
#pragma once
#include <cmath>
#include <cstdint>
#include <random>

#include "ibrdf/base/pi.h"

namespace ibrdf {

// Floats: weights and noise of networks, draws of the estimates.
class NormalSource {
 public:
  explicit NormalSource(uint64_t seed) : bits_(seed) {}

  float Next() {
    const double radius = std::sqrt(-2.0 * std::log(Uniform()));
    return static_cast<float>(radius * std::cos(2.0 * kPi * Uniform()));
  }

 private:
  double Uniform() {  // (0, 1)
    return (static_cast<double>(bits_() >> 12) + 0.5) / 4503599627370496.0;
  }
  std::mt19937_64 bits_;
};

// Doubles, of one bit more: noise of rendered images.
class DoubleNormalSource {
 public:
  explicit DoubleNormalSource(uint64_t seed) : bits_(seed) {}

  double Next() {
    const double radius = std::sqrt(-2.0 * std::log(1.0 - Uniform()));
    return radius * std::cos(2.0 * kPi * Uniform());
  }

 private:
  double Uniform() {  // [0, 1)
    return std::ldexp(static_cast<double>(bits_() >> 11), -53);
  }
  std::mt19937_64 bits_;
};

}  // namespace ibrdf
