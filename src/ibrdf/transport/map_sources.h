// A map as the transport reads it: blocks of texels, and a frame of repeated
// texels around it. Internal.
#pragma once
#include <vector>

namespace ibrdf {

// Radiance times solid angle, summed over blocks of block x block texels,
// row-major: four floats per block, the last one 0. map [H, W, 3].
std::vector<float> SumBlocks(const float* map, int height, int width,
                             int block);

// The texel that each entry of a padded map, [height + 2][width + 1], holds:
// its first and last row are those of the map half a turn on (across the pole),
// its last column is the first.
std::vector<int> PaddedTexels(int height, int width);

}  // namespace ibrdf
