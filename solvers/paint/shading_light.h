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
  // Log colour of that ratio, of no luminance, as ChromaPlane's: lamp and room
  // are rarely of one colour.
  Eigen::Array2d chroma = Eigen::Array2d::Zero();
};

// What a surface gets of that light, relative to what lights all surfaces
// alike: strength exp(chroma) max(n . direction, 0) + 1, the lamp setting
// softly.
Eigen::Array3d Irradiance(const ShadingLight& light,
                          const Eigen::Vector3d& normal);

// Pixels of one colour are of one paint, mostly, so what they differ by is
// shading: of a matte surface under one lamp and even light, log Irradiance.
// The lamp that explains the differences of pairs best, robustly, as shadows
// and paints of one chroma do not follow it. A matte object shows no highlight
// from which FindDirectionalLights would know its lamp. Empty where too few
// pixels have partners or no lamp explains them markedly better than none.
std::optional<ShadingLight> FindShadingLight(
    const std::vector<ShadingPoint>& points, const Observations& observed);

}  // namespace ibrdf
