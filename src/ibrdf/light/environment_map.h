// Distant illumination as an equirectangular radiance map.
#pragma once
#include <Eigen/Core>

#include "ibrdf/image/image.h"

namespace ibrdf {

// An equirectangular map is an Image of height H, width W (y up): row r is
// theta = pi (r + 1/2) / H from +y, column c is phi = 2 pi (c + 1/2) / W, and
// the direction is (sin theta sin phi, cos theta, sin theta cos phi).

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

// Area-weighted mean over blocks; width and height must divide the map's.
// Any other size: solid-angle-exact resampling of the piecewise constant map.
Image ResizeMap(const Image& map, int height, int width);

// Solid-angle-weighted mean radiance per channel.
Eigen::Array3d MeanRadiance(const Image& map);

}  // namespace ibrdf
