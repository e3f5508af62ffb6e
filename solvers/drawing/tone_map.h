// From radiance and residuals to display colours.
#pragma once
#include <cstdint>
#include <vector>

#include "ibrdf/image/image.h"

namespace ibrdf {

// The value below which `percentile` (0 to 100) of the values lie; not empty.
double Percentile(std::vector<double> values, double percentile);

// 1 / x, x the `percentile` (0 to 100) of max(R, G, B) over the pixels inside
// `mask` (empty: all) that are finite and > 0; 1 where there is none. Images
// that are to be compared share the exposure of their reference.
double ExposureOf(const Image& reference, const Mask& mask, double percentile);

// The sRGB transfer curve (IEC 61966-2-1): linear [0, 1], clipped, to [0, 255].
uint8_t EncodeSrgb(double linear);

// Its inverse, from and to [0, 1].
double DecodeSrgb(double encoded);

// Blue (-1), white (0), red (+1), as sRGB bytes; t is clipped.
void DivergingColour(double t, uint8_t rgb[3]);

}  // namespace ibrdf
