// Narrow lobes of reflectance, and few rays that stand for them.
#pragma once
#include <Eigen/Core>
#include <vector>

#include "ibrdf/base/pi.h"
#include "ibrdf/brdf/brdf_grid.h"

namespace ibrdf {

// Angle between half-vector and normal, radians, at which the mean of the
// channels falls to half of its value at the normal, for light and view 20
// degrees from the half-vector, across their plane; pi/2 where it never does.
double LobeHalfWidth(const BrdfFunction& brdf);

// A lobe whose LobeHalfWidth is below this shows the object as a mirror does:
// patches, which are patches, blur it.
inline constexpr double kNarrowLobe = 4.0 * kPi / 180;

struct LobeBundles {
  std::vector<int> of;  // each direction's, in [0, count)
  // Unit means, by weight, of the directions of each; zero where it has none.
  std::vector<Eigen::Vector3f> means;
};

// `count` bundles, a power of 2, of about equal weights (>= 0) and compact:
// directions (unit) are cut in two across their widest extent, and so on.
LobeBundles BundleDirections(const std::vector<Eigen::Vector3f>& directions,
                             const std::vector<float>& weights, int count);

}  // namespace ibrdf
