// Self-shadowing of an image's points, found once: it depends on geometry
// alone, whatever the map, its size and the reflectance, so one table serves
// every Transport of a solve.
#pragma once
#include <cstdint>
#include <vector>

#include "ibrdf/visibility/visibility_grid.h"

namespace ibrdf {

struct VisibilityOptions {
  int rows = 128;       // of VisibilityGrid: steps of 1.4 degrees
  int num_threads = 0;  // <= 0: all
};

// Safe to share between threads once all points are there.
class Visibility {
 public:
  // `points`: as FindShadingPoints or a selection of them; each index once.
  Visibility(const Scene& scene, const std::vector<ShadingPoint>& points,
             const VisibilityOptions& options);

  // More points of the same scene, with new indices.
  void Add(const std::vector<ShadingPoint>& points);

  const VisibilityGrid& grid() const { return grid_; }

  // The bits of a point, by ShadingPoint::index; null where nothing is hidden
  // from it. The point must be one of the constructor's.
  const uint64_t* Hidden(const ShadingPoint& point) const;

  // Rays cast so far.
  int64_t num_rays() const { return num_rays_; }
  size_t MemoryBytes() const;

 private:
  VisibilityGrid grid_;
  int num_threads_;
  int64_t num_rays_ = 0;
  // By index: words into bits_, kClear or kAbsent.
  std::vector<int64_t> begin_;
  std::vector<uint64_t> bits_;
};

}  // namespace ibrdf
