// Compact sources of light: the sun, lamps, windows far away. A Gaussian
// process of log radiance that is right for the rest of light holds none.
#pragma once
#include <Eigen/Core>
#include <vector>

#include "ibrdf/render/scene.h"

namespace ibrdf {

// sr. A lamp has no width; its radiance is that of so large a piece of sky.
inline constexpr double kLampSolidAngle = 0.1;

// Where light that makes the image's highlights comes from if it mirrors: unit
// directions, at most `most`, the brightest first. A highlight is a local
// maximum of luminance over the directions around it. radiance [points][3].
std::vector<Eigen::Vector3d> FindLamps(const std::vector<ShadingPoint>& points,
                                       const std::vector<double>& radiance,
                                       int most);

// A lamp at offsets [2], radians along two axes of its tangent plane.
Eigen::Vector3d MovedLamp(const Eigen::Vector3d& lamp, const double* offsets);

}  // namespace ibrdf
