// The middle of a list of values.
#pragma once
#include <algorithm>
#include <cstddef>
#include <vector>

namespace ibrdf {

// Standard deviation of a normal distribution over the median of its absolute
// deviations.
inline constexpr double kDeviationOverMad = 1.4826;

// The median; of an even number of values the upper of the middle two. values:
// at least one, no NaN.
template <typename T>
T UpperMedian(std::vector<T> values) {
  const auto middle =
      values.begin() + static_cast<std::ptrdiff_t>(values.size() / 2);
  std::nth_element(values.begin(), middle, values.end());
  return *middle;
}

}  // namespace ibrdf
