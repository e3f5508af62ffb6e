// Quantiles of a list of values.
#pragma once
#include <algorithm>
#include <cstddef>
#include <vector>

namespace ibrdf {

// Linear between the order statistics. share: in [0, 1]. values: at least one,
// no NaN.
inline double Quantile(std::vector<double> values, double share) {
  const double at = share * static_cast<double>(values.size() - 1);
  const auto low = static_cast<size_t>(at);
  const auto below = values.begin() + static_cast<std::ptrdiff_t>(low);
  std::nth_element(values.begin(), below, values.end());
  if (low + 1 == values.size()) return *below;
  const double part = at - static_cast<double>(low);
  return (1.0 - part) * *below +
         part * *std::min_element(below + 1, values.end());
}

}  // namespace ibrdf
