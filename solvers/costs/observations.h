// What an image says of the radiance of an object's points.
#pragma once
#include <cstddef>
#include <vector>

#include "ibrdf/image/radiance_interval.h"

namespace ibrdf {

// Values [points * 3], row = point. A point takes part (valid) where all three
// channels have an end at least, and radiance that is finite and positive.
struct Observations {
  // The radiance of an HDR image. Of an interval: a value in it, or its one
  // end; what is no number or not positive is missing.
  std::vector<double> radiance;
  // Ends of the intervals; both empty: all are the radiance itself.
  std::vector<double> low, high;
  std::vector<char> valid;  // [points]
  int num_valid = 0;

  bool exact() const { return low.empty(); }
  RadianceInterval Interval(size_t value) const {
    if (exact()) return {radiance[value], radiance[value]};
    return {low[value], high[value]};
  }
};

// The observations of an HDR image: every value is known.
Observations MakeObservations(std::vector<double> radiance);

// Observations that are intervals; `low` and `high` may be empty.
Observations MakeObservations(std::vector<double> radiance,
                              std::vector<double> low,
                              std::vector<double> high);

// The points of `from` in order, by index.
Observations SelectObservations(const Observations& from,
                                const std::vector<size_t>& points);

// Of the pixels that are valid, and of their channels; at least one is.
double MeanRadiance(const Observations& observed);

}  // namespace ibrdf
