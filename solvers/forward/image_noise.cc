#include "ibrdf/solvers/forward/image_noise.h"

#include <cmath>
#include <random>

namespace ibrdf {
namespace {

// Box-Muller on bits of the generator, which the standard fixes (unlike
// std::normal_distribution): the same seed gives the same noise anywhere.
class NormalNumbers {
 public:
  explicit NormalNumbers(uint64_t seed) : rng_(seed) {}
  double Next() {
    constexpr double kTwoPi = 6.28318530717958647693;
    const double radius = std::sqrt(-2.0 * std::log(1.0 - Uniform()));
    return radius * std::cos(kTwoPi * Uniform());
  }

 private:
  double Uniform() {
    return std::ldexp(static_cast<double>(rng_() >> 11), -53);
  }
  std::mt19937_64 rng_;
};

}  // namespace

void AddNoise(double sigma, uint64_t seed, Image* image) {
  if (sigma <= 0.0) return;
  NormalNumbers normal(seed);
  for (float& v : image->rgb) {
    v = static_cast<float>(v * std::exp(sigma * normal.Next()));
  }
}

}  // namespace ibrdf
