// Directional lights that an image's highlights show.
#pragma once
#include <Eigen/Core>
#include <vector>

#include "ibrdf/scene/scene.h"
#include "ibrdf/solvers/marginal/search_options.h"

namespace ibrdf {

// Unit directions: the lights that the options know, then others that
// highlights show, the brightest of each material first; at most
// options.most_directional_lights.
std::vector<Eigen::Vector3d> LightsOfHighlights(
    const std::vector<ShadingPoint>& points, const Observations& observed,
    const ReflectanceSearchOptions& options);

}  // namespace ibrdf
