// Numbers in single precision.
#pragma once
#include <vector>

namespace ibrdf {

inline std::vector<float> ToFloat(const std::vector<double>& v) {
  return {v.begin(), v.end()};
}

}  // namespace ibrdf
