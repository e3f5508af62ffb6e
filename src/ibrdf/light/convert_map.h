// Environment maps from one frame to another.
#pragma once
#include <string>

#include "ibrdf/base/status.h"
#include "ibrdf/image/image.h"
#include "ibrdf/light/map_frame.h"

namespace ibrdf {

// The map in the frame `to` at size `size`. Refuses sizes that CheckMapSize
// refuses, `where` names the file or field. Texels that stand for nothing are
// 0. Threads do not change the bits; num_threads <= 0 takes all.
//
// A texel of the result is the mean over its solid angle of the map's texels,
// constant each: light is neither lost nor made, which bilinear lookups of a
// hard sun do not promise. There are three ways, by what the frames allow:
//
// 1. Texels change places, bit by bit: between latlong frames of one size that
//    differ by mirroring and by a shift of whole columns. A quarter turn is
//    whole where the height is even. So is any frame to itself at its size.
// 2. Between all other latlong maps the overlaps of texels are products of
//    those of rows and columns, and exact.
// 3. To and from probes and cubes the overlaps are sampled, 4 x 4 points in
// each
//    texel of the finer map and as densely in the coarser one, then balanced:
//    all overlaps of a texel add to its solid angle. For the old map's texels
//    they do to float rounding, so that the light of each is kept; for the new
//    one's to 1e-3 or a few, which is how far a constant map ripples (measured:
//    up to 2.6e-3, root mean square 4e-4). A mean of 0.7 % of a texel's light
//    goes to a neighbour of where it belongs. A cross of 768 x 1024 takes some
//    5 s on one core.
//
// Error of radiance: a feature moves by less than half a texel of the coarser
// map, and so does the solid-angle-weighted mean of direction times radiance.
StatusOr<Image> ConvertMap(const std::string& where, const Image& map,
                           MapFrame from, MapFrame to, MapSize size,
                           int num_threads = 0);

// A map of a file's frame as the library has it, about as fine (RowsForSize).
// Refuses sizes that CheckMapSize refuses.
StatusOr<Image> ToLibraryFrame(const std::string& where, const Image& map,
                               MapFrame from, int num_threads = 0);

// A map of the library as a file of the frame `to` has it, of SizeForRows. A
// map that is not twice as wide as high is refined until it is, so that what is
// written can be read.
StatusOr<Image> FromLibraryFrame(const std::string& where, const Image& map,
                                 MapFrame to, int num_threads = 0);

// Integral of radiance over the sphere, W/m^2 per channel, texels constant.
Eigen::Array3d TotalRadiance(const Image& map, const MapGrid& grid);

}  // namespace ibrdf
