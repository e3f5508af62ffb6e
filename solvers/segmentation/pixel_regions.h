// Regions of an object that no sharp step of colour parts.
#pragma once
#include <vector>

#include "ibrdf/solvers/segmentation/material_pixels.h"

namespace ibrdf {

// The region of each pixel, numbered from 0 in the pixels' order. Pixels that
// share a side are of one region where their smooth logs differ by less than
// `step` in every channel.
std::vector<int> FindRegions(const MaterialPixels& pixels, double step);

}  // namespace ibrdf
