// Products of vectors, and how exact the transport's float sums are.
#pragma once
#include <cstddef>
#include <vector>

namespace ibrdf {

// Sums of some thousand float products.
inline constexpr double kFloatSums = 2e-5;

inline double Dot(const std::vector<double>& a, const std::vector<double>& b) {
  double sum = 0.0;
  for (size_t i = 0; i < a.size(); ++i) sum += a[i] * b[i];
  return sum;
}

}  // namespace ibrdf
