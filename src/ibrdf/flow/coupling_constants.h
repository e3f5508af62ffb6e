// Spline and activation constants of the flow, free of other includes so that
// kernels for one instruction set can read them.
#pragma once

namespace ibrdf {

// Knot slopes before normalisation are exp(s(p)), s(p) = p / (1 + |p| / R) with
// R = kSlopeRange, and bin widths (1 - bins * kMinWidth) softmax(p) +
// kMinWidth, so that no bin and no slope vanishes whatever the weights.
inline constexpr double kSlopeRange = 6.0;
inline constexpr double kMinWidth = 1e-3;
}  // namespace ibrdf
