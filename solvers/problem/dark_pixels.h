// Pixels that a known light hardly reaches, and the stray light that they show.
#pragma once
#include <Eigen/Core>
#include <vector>

#include "ibrdf/image/image.h"
#include "ibrdf/scene/scene.h"
#include "ibrdf/transport/transport.h"

namespace ibrdf {

// A lamp and nothing else leaves part of an object without light. What the
// image holds there is light that the known map does not have: of the room, of
// the lens, an offset of the sensor.
struct DarkPixels {
  // By pixel of the image, 1: the known light does not reach it, and it takes
  // no part. Empty: the light reaches all.
  std::vector<char> unlit;
  int num_unlit = 0;  // of the object's pixels
  // Pixels whose light is lost in the spread of the stray light: their value
  // bounds the light from above, and says no more.
  int num_below_floor = 0;
  // Radiance that every pixel has beside the known light's, >= 0: the mean of
  // its prior, or its value where the deviation is 0.
  Eigen::Array3d ambient = Eigen::Array3d::Zero();
  Eigen::Array3d ambient_deviation = Eigen::Array3d::Zero();
};

// kPenumbra: the light is at the point's horizon to within a row of the map's
// texels, and how much there is hangs on where in its texel a lamp stands.
enum class Lighting : char { kLit, kPenumbra, kNone };

// How the map [H, W] lights each point. All are kLit where none is kNone. A
// point that sees some of the object is kLit where `transport` has bounces.
std::vector<Lighting> FindLighting(const std::vector<ShadingPoint>& points,
                                   const Image& map,
                                   const TransportOptions& transport);

// The stray light of an image by its points of Lighting::kNone: their median,
// and its prior's deviation, the larger of their spread and a tenth of it. 0 in
// all channels where such points are few or black, to a millionth of the lit
// ones' median.
struct StrayLight {
  Eigen::Array3d ambient = Eigen::Array3d::Zero();
  Eigen::Array3d deviation = Eigen::Array3d::Zero();
  // 1.4826 times the median absolute deviation.
  Eigen::Array3d spread = Eigen::Array3d::Zero();
};
StrayLight MeasureStrayLight(const Image& image,
                             const std::vector<ShadingPoint>& points,
                             const std::vector<Lighting>& lighting);

// Whether a pixel's radiance is within the spread of the stray light in all
// channels.
bool IsBelowFloor(const Eigen::Array3d& radiance, const StrayLight& stray);

}  // namespace ibrdf
