// The lamp that shades a painted object, from how pixels of one colour differ.
#pragma once
#include <Eigen/Core>
#include <optional>
#include <vector>

#include "ibrdf/scene/scene.h"
#include "ibrdf/solvers/costs/observations.h"

namespace ibrdf {

struct ShadingLight {
  Eigen::Vector3d direction = Eigen::Vector3d::UnitZ();
  // Irradiance of a surface that faces it, over that of what lights all
  // surfaces alike.
  double strength = 0.0;
};

// Pixels of one colour are of one paint, mostly, so what their luminance
// differs by is shading: of a matte surface under one lamp and even light,
// log(strength max(n . direction, 0) + 1). The lamp that explains the
// differences of pairs best, robustly, as shadows and paints of one chroma do
// not follow it. A matte object shows no highlight from which
// FindDirectionalLights would know its lamp. Empty where too few pixels have
// partners or no lamp explains them markedly better than none.
std::optional<ShadingLight> FindShadingLight(
    const std::vector<ShadingPoint>& points, const Observations& observed);

}  // namespace ibrdf
