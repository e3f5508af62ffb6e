// Pixels as points of the disc of visible normals.
#pragma once
#include <Eigen/Core>
#include <vector>

#include "ibrdf/image/image.h"
#include "ibrdf/scene/scene.h"

namespace ibrdf {

// A point's normal in its own view: right, up (kept upright), to the viewer.
Eigen::Vector3d NormalToViewer(const ShadingPoint& point);

struct NormalSample {
  Eigen::Vector2d normal;       // right and up, in the pixel's own view
  Eigen::Array3d log_radiance;  // natural
  Eigen::Vector2d position;     // of the pixel, column and row
  size_t point = 0;             // its place in the list of points
  int view = 0;                 // ShadingPoint::view

  // log R/G and log B/G.
  Eigen::Vector2d LogColour() const {
    return {log_radiance[0] - log_radiance[1],
            log_radiance[2] - log_radiance[1]};
  }
};

// The samples of the points whose radiance is finite and > 0 in all channels
// and whose normal is seen at a cosine of 0.2 at least: near the outline a
// pixel mixes normals.
std::vector<NormalSample> SampleNormals(
    const Image& radiance, const std::vector<ShadingPoint>& points);

// The object's size in an image, pixels: the square root of its samples, or of
// a view's in the mean of several.
double ObjectSize(const std::vector<NormalSample>& samples);

}  // namespace ibrdf
