#include "ibrdf/solvers/problem/silhouette.h"

#include <cstdint>

#include "ibrdf/base/format.h"

namespace ibrdf {

Silhouette FindSilhouette(const Scene& scene, const Camera& camera, int width,
                          int height, const Mask& mask,
                          const std::vector<ShadingPoint>& points,
                          int num_threads) {
  Silhouette silhouette;
  silhouette.object = Mask(width, height, 0);
  for (const ShadingPoint& point : points) {
    silhouette.object.inside[static_cast<size_t>(point.pixel)] = 1;
  }
  silhouette.covered = points.size();
  silhouette.of_mask =
      mask.empty() ? silhouette.object.inside.size() : mask.CountInside();
  if (mask.empty()) return silhouette;
  Mask beside = mask;
  for (uint8_t& inside : beside.inside) inside = inside == 0 ? 1 : 0;
  // Fails where there are none: the sizes fitted before.
  const StatusOr<std::vector<ShadingPoint>> outside =
      FindShadingPoints(scene, camera, width, height, beside, 1, num_threads);
  size_t more = 0;
  if (outside.ok()) {
    more = outside->size();
    for (const ShadingPoint& point : *outside) {
      silhouette.object.inside[static_cast<size_t>(point.pixel)] = 1;
    }
  }
  silhouette.overlap = static_cast<double>(silhouette.covered) /
                       static_cast<double>(silhouette.of_mask + more);
  return silhouette;
}

std::string FitAdvice(const Problem& problem) {
  if (problem.geometry.kind != GeometryKind::kMesh) return "";
  return problem.geometry.fit == MeshFit::kUnitSphere
             ? ".fit: unit_sphere moved and scaled the mesh, not the camera"
             : ".fit: none leaves the mesh in the file's coordinates";
}

Status CheckSilhouette(const Problem& problem, const Silhouette& silhouette,
                       std::vector<std::string>* warnings) {
  if (problem.image.mask.empty() || silhouette.overlap >= kUsualOverlap) {
    return OkStatus();
  }
  const std::string text =
      "the object covers " + std::to_string(silhouette.covered) +
      " of the mask's " + std::to_string(silhouette.of_mask) +
      " pixels (overlap " + Format("%.2f", silhouette.overlap) +
      "): check the camera, its field of view and up axis, and geometry" +
      FitAdvice(problem);
  if (static_cast<double>(silhouette.covered) <
      kLeastCovered * static_cast<double>(silhouette.of_mask)) {
    return InvalidInput(problem.image.mask, text);
  }
  warnings->push_back(problem.image.mask + ": " + text);
  return OkStatus();
}

}  // namespace ibrdf
