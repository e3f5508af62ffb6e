// Labels for the pixels that tell of none themselves.
#pragma once
#include <vector>

#include "ibrdf/scene/scene.h"

namespace ibrdf {

// Points with a label of -1 take that of the nearest labelled one: over pixels
// that share a side where they are joined so, else by distance in the image.
// labels [points]: at least one is >= 0. image_width > 0.
void SpreadLabels(const std::vector<ShadingPoint>& points, int image_width,
                  std::vector<int>* labels);

}  // namespace ibrdf
