// How normals are turned to the viewer. Internal.
#pragma once
#include <Eigen/Core>
#include <cmath>

#include "ibrdf/scene/scene.h"

namespace ibrdf {

// Turns a normal to the viewer: flipped where the surface shows its back, then
// tilted about the view so that n.wo >= kMinViewCosine.
inline Eigen::Vector3d FaceViewer(Eigen::Vector3d normal,
                                  const Eigen::Vector3d& geometric,
                                  const Eigen::Vector3d& wo) {
  if (geometric.dot(wo) < 0.0) normal = -normal;
  const double cosine = normal.dot(wo);
  // The margin keeps the promise after rounding to float.
  constexpr double kLeast = kMinViewCosine * (1.0 + 1e-3);
  if (cosine >= kLeast) return normal;
  Eigen::Vector3d tangent = normal - cosine * wo;
  if (!(tangent.norm() > 1e-9)) return wo;  // straight away: no better guess
  tangent.normalize();
  return std::sqrt(1.0 - kLeast * kLeast) * tangent + kLeast * wo;
}

}  // namespace ibrdf
