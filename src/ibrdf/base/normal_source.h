// Standard normal numbers from a seed.
#pragma once
#include <cmath>
#include <cstdint>
#include <random>

namespace ibrdf {

// They do not depend on the standard library.
class NormalSource {
 public:
  explicit NormalSource(uint64_t seed) : bits_(seed) {}

  float Next() {  // Box-Muller
    const double radius = std::sqrt(-2.0 * std::log(Uniform()));
    return static_cast<float>(radius * std::cos(2.0 * kPi * Uniform()));
  }

 private:
  static constexpr double kPi = 3.14159265358979323846;
  double Uniform() {  // (0, 1)
    return (static_cast<double>(bits_() >> 12) + 0.5) / 4503599627370496.0;
  }
  std::mt19937_64 bits_;
};

}  // namespace ibrdf
