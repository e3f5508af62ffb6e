// The object's silhouette over the mask.
#pragma once
#include <cstddef>
#include <string>
#include <vector>

#include "ibrdf/base/status.h"
#include "ibrdf/image/image.h"
#include "ibrdf/io/problem.h"
#include "ibrdf/scene/scene.h"

namespace ibrdf {

// Below this share of the mask's pixels that see the object there is nothing to
// estimate from, and the problem is refused; below this overlap it is worth a
// word. The same silhouette drawn by two programs overlaps by 0.95 and more.
inline constexpr double kLeastCovered = 0.05;
inline constexpr double kUsualOverlap = 0.92;

struct Silhouette {
  Mask object;           // pixels whose centre sees the object
  size_t covered = 0;    // those of the mask
  size_t of_mask = 0;    // all of the mask; an empty one holds all
  double overlap = 1.0;  // intersection of mask and object over their union
};

// points: of the mask's pixels, as FindShadingPoints has them for that size.
Silhouette FindSilhouette(const Scene& scene, const Camera& camera, int width,
                          int height, const Mask& mask,
                          const std::vector<ShadingPoint>& points,
                          int num_threads);

// Follows "geometry" in messages.
std::string FitAdvice(const Problem& problem);

// Refuses a mask that hardly meets the object, warns of one that overlaps less
// than usual. Ok where the problem has no mask.
Status CheckSilhouette(const Problem& problem, const Silhouette& silhouette,
                       std::vector<std::string>* warnings);

}  // namespace ibrdf
