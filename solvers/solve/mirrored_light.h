// What a mirror in the object's place would show of a known light.
#pragma once
#include <vector>

#include "ibrdf/image/image.h"
#include "ibrdf/scene/scene.h"
#include "ibrdf/solvers/solve/residual_statistics.h"

namespace ibrdf {

// Log of the map's mean radiance over what each of these points' pixels mirrors
// [indices * 3], in the map's units. map: of any size; points: of the whole
// image, whose width is in pixels.
std::vector<double> MirroredLogRadiance(const Image& map,
                                        const std::vector<ShadingPoint>& points,
                                        int image_width,
                                        const std::vector<size_t>& indices);

// The share, in [0, 1], of what the residuals of neighbouring pixels differ by
// that mirrored light explains: what R^2 of a linear regression on differences
// of the render's logarithm gains by those of the mirrored light's. Paint has
// some 0. An object that mirrors more sharply than the lobes do, or more
// detail than the map has that it is solved with, has most of 1.
double MirroredShare(const Image& map, const std::vector<ShadingPoint>& points,
                     int image_width, const ResidualRows& rows);

}  // namespace ibrdf
