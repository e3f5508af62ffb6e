// Tolerances of tests of maps.
#pragma once

namespace ibrdf {

// Rounding of a chain of double sines and arc tangents.
inline constexpr double kRounding = 1e-12;
// Rounding of float texels, float overlaps and OpenEXR's float directions.
inline constexpr double kFloatRounding = 2e-6;

}  // namespace ibrdf
