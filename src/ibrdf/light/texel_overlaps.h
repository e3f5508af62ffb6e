// Overlaps of the texels of two maps on the sphere, for conservative
// resampling.
#pragma once
#include <cstdint>
#include <vector>

#include "ibrdf/light/area_average.h"
#include "ibrdf/light/map_frame.h"

namespace ibrdf {

// Solid angle that a texel of one map shares with one of another, sr.
struct TexelOverlap {
  int32_t source, target;
  float solid_angle;
};

// For each interval [from[i], to[i]] (from <= to <= from + 1) its parts among
// the intervals of `edges`, which ascend from 0 to 1 and repeat with period 1.
std::vector<std::vector<IntervalPart>> PeriodicParts(
    const std::vector<double>& from, const std::vector<double>& to,
    const std::vector<double>& edges);

// Sampled and balanced overlaps of two maps. Those of a source texel add to its
// solid angle to rounding; those of a target texel to how far the balance has
// converged. A pair may occur twice.
std::vector<TexelOverlap> SampledOverlaps(
    const MapGrid& source, const std::vector<double>& source_angles,
    const MapGrid& target, const std::vector<double>& target_angles,
    int num_threads);

}  // namespace ibrdf
