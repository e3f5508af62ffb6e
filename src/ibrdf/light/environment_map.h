// Distant illumination as an equirectangular radiance map.
#pragma once
#include <Eigen/Core>
#include <cstddef>
#include <vector>

#include "ibrdf/image/image.h"

namespace ibrdf {

// An equirectangular map is an Image of height H, width W (y up): row r is
// theta = pi (r + 1/2) / H from +y, column c is phi = 2 pi (c + 1/2) / W, and
// the direction is (sin theta sin phi, cos theta, sin theta cos phi).
//
// This is the frame ibrdf_0_1 of map_frame.h, kLibraryMapFrame: every map in
// memory has it, whatever its file has. Maps of files have other frames, camera
// by default, which is this one mirrored left to right. They are exchanged
// where files are read and written, in io/map_file.h, and nowhere else; the
// exchange with camera moves whole columns and keeps every bit.

// The size of a map, texels.
struct MapSize {
  int width = 0, height = 0;

  size_t num_texels() const { return static_cast<size_t>(width) * height; }
  bool operator==(const MapSize& o) const {
    return width == o.width && height == o.height;
  }
  bool operator!=(const MapSize& o) const { return !(*this == o); }
};

// Unit direction of a continuous map position; row in [0, H], column in [0, W]
// count from texel edges (texel centres at +1/2).
Eigen::Vector3d MapDirection(double row, double column, int height, int width);

// Continuous position of a direction (any length > 0): row in [0, H],
// column in [0, W).
void MapPosition(const Eigen::Vector3d& direction, int height, int width,
                 double* row, double* column);
// The same to within 2e-9 of the sizes, for inner loops.
void FastMapPosition(const Eigen::Vector3d& direction, int height, int width,
                     double* row, double* column);

// Solid angle of a texel of `row`, sr; over the whole map they add to 4 pi.
double TexelSolidAngle(int row, int height, int width);

// Bilinear lookup between texel centres, wrapped in longitude. Beyond the first
// and last row of centres the texel across the pole (column + W/2) is the
// other neighbour.
struct MapTaps {
  int texel[4];      // row * W + column
  double weight[4];  // >= 0, sum 1
};
MapTaps BilinearTaps(const Eigen::Vector3d& direction, int height, int width);
Eigen::Array3d LookUpMap(const Image& map, const Eigen::Vector3d& direction);

// A map at another size, in two ways.
//
// Radiance adds up: a texel of the new map is the mean over its solid angle of
// the old one's texels, constant each, so that no light is lost.
Image ResizeMap(const Image& map, int height, int width);
// Log radiance does not, and what is fitted to it should see no edges of texels
// where the map grows: planes [channels][to.height][to.width] of the old ones,
// bilinear between their texels' centres.
std::vector<float> ResamplePlanes(const std::vector<float>& planes,
                                  MapSize from, MapSize to);

// Solid-angle-weighted mean radiance per channel.
Eigen::Array3d MeanRadiance(const Image& map);

}  // namespace ibrdf
