// Constants of the illumination UNet's activation, for its two implementations.
#pragma once

namespace ibrdf {

// Activation: a leaky, smooth ramp through the origin,
//   a(x) = (1 + l)/2 x + (1 - l)/2 (sqrt(x^2 + c^2) - c),  slope in (l, 1),
// with x clamped to +-kUnetSaturation (slope 0 beyond) so that no finite
// weights of reasonable size overflow float.
constexpr float kUnetLeak = 0.1f;
constexpr float kUnetCurvature = 1.0f;  // c
constexpr float kUnetSaturation = 1e8f;

// Added to the variance by instance normalisation.
constexpr float kUnetNormEpsilon = 1e-4f;

}  // namespace ibrdf
