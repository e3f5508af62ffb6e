// Numbers that are not finite.
#pragma once
#include <limits>

namespace ibrdf {

inline constexpr double kInfinity = std::numeric_limits<double>::infinity();
inline constexpr double kNan = std::numeric_limits<double>::quiet_NaN();

}  // namespace ibrdf
