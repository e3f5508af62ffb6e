// Adam on float parameters, with its state in one place for checkpoints.
#pragma once
#include <cmath>
#include <cstddef>
#include <vector>

namespace ibrdf {

// Kingma and Ba 2015, with beta 0.9 and 0.99: training noise is low.
struct Adam {
  std::vector<float> mean, square;

  explicit Adam(size_t size = 0) : mean(size, 0.0f), square(size, 0.0f) {}

  // One step on parameters [begin, begin + count); t >= 1 counts the steps
  // these parameters have seen, this one included.
  void Step(const float* gradient, double rate, int64_t t, size_t begin,
            size_t count, float* parameters) {
    const double c1 = 1.0 - std::pow(0.9, static_cast<double>(t));
    const double c2 = 1.0 - std::pow(0.99, static_cast<double>(t));
    const float scale = static_cast<float>(rate / c1);
    const float inverse = static_cast<float>(1.0 / c2);
    for (size_t i = 0; i < count; ++i) {
      const float g = gradient[i];
      float& m = mean[begin + i];
      float& v = square[begin + i];
      m += 0.1f * (g - m);
      v += 0.01f * (g * g - v);
      parameters[begin + i] -= scale * m / (std::sqrt(v * inverse) + 1e-8f);
    }
  }
};

}  // namespace ibrdf
