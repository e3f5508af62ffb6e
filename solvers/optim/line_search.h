// How far to go along a direction in which the cost falls.
#pragma once
#include <functional>

namespace ibrdf {

// What going some length along the direction brings.
struct LineSearchTrial {
  double gain = 0.0;  // of cost; not finite where the cost is not
  bool accepted = false;
};

// Backtracking: the first length that `trial` accepts, tried from `longest` on;
// 0 where none longer than `shortest` is. A parabola through the cost at both
// ends of a trial, which falls by `slope` > 0 per length at the near one, has
// its lowest point at the next length, kept between a tenth and a half of the
// last; a trial whose gain is not finite is followed by a tenth.
double LineSearch(double longest, double shortest, double slope,
                  const std::function<LineSearchTrial(double)>& trial);

}  // namespace ibrdf
