#include "ibrdf/solvers/problem/sphere_outline.h"

#include <algorithm>
#include <cmath>

#include "ibrdf/base/format.h"
#include "ibrdf/solvers/problem/circle_fit.h"

namespace ibrdf {
namespace {

// A fit that overlaps the mask by no more than this is no better.
constexpr double kBetter = 0.01;
// Outlines no further apart than this, pixels, are one: a mask may have every
// pixel that the ball touches, or those alone whose centre it covers.
constexpr double kOneOutline = 1.0;
// The share of a part of the unit sphere's outline.
constexpr double kCovered = 0.99;

double CoveredShare(const Mask& mask, const PixelCircle& circle) {
  size_t covered = 0;
  for (int y = 0; y < mask.height; ++y) {
    for (int x = 0; x < mask.width; ++x) {
      covered +=
          mask.inside[static_cast<size_t>(y) * mask.width + x] != 0 &&
          std::hypot(x + 0.5 - circle.x, y + 0.5 - circle.y) < circle.radius;
    }
  }
  return static_cast<double>(covered) /
         static_cast<double>(std::max<size_t>(mask.CountInside(), 1));
}

std::string InWords(const CircleFit& fit) {
  return "centre [" + Format("%.2f", fit.circle.x) + ", " +
         Format("%.2f", fit.circle.y) + "], radius " +
         Format("%.2f", fit.circle.radius) +
         " pixels, from the image's top left corner (boundary within " +
         Format("%.2f", fit.residual) + " pixels, root mean square; overlap " +
         Format("%.2f", fit.overlap) + ")";
}

}  // namespace

StatusOr<std::optional<PixelCircle>> FindSphereOutline(
    const Mask& mask, const std::string& path,
    std::vector<std::string>* warnings) {
  const std::optional<PixelCircle> unit_sphere;
  if (mask.empty()) return unit_sphere;
  const PixelCircle usual = {0.5 * mask.width, 0.5 * mask.height,
                             0.5 * std::min(mask.width, mask.height)};
  const double usual_overlap = CircleOverlap(mask, usual);
  if (usual_overlap >= kFillsImage) return unit_sphere;
  const std::optional<CircleFit> fit = FitCircle(mask);
  if (!fit.has_value()) return unit_sphere;
  const double apart =
      std::hypot(fit->circle.x - usual.x, fit->circle.y - usual.y) +
      std::abs(fit->circle.radius - usual.radius);
  if (apart <= kOneOutline) return unit_sphere;
  if (fit->overlap < kLeastCircle || fit->overlap <= usual_overlap + kBetter) {
    if (usual_overlap >= kLeastCircle ||
        CoveredShare(mask, usual) >= kCovered) {
      return unit_sphere;
    }
    return InvalidInput(
        path, "expected the outline of a ball; the nearest circle has " +
                  InWords(*fit) +
                  ". Say geometry.sphere: {centre: [x, y], radius: r} in "
                  "pixels, or give normals, depth or a mesh");
  }
  warnings->push_back(
      path + ": the sphere is taken where the mask is: " + InWords(*fit) +
      (fit->overlap < kIsCircle
           ? "; the mask is not quite a circle: check it, or "
             "say geometry.sphere: {centre: [x, y], radius: r}"
           : ""));
  return std::optional<PixelCircle>(fit->circle);
}

}  // namespace ibrdf
