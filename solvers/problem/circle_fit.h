// The circle that a mask's boundary lies on.
#pragma once
#include <optional>

#include "ibrdf/image/image.h"
#include "ibrdf/io/problem.h"

namespace ibrdf {

struct CircleFit {
  PixelCircle circle;
  double residual = 0.0;  // of the boundary's points that it is fitted to, root
                          // mean square distance in pixels
  double overlap = 0.0;   // CircleOverlap
};

// Intersection over union of the mask and the pixels whose centres are inside.
double CircleOverlap(const Mask& mask, const PixelCircle& circle);

// The points halfway between a pixel of the mask and a neighbour outside it,
// without those at the image's border. A circle through three of them which is
// near to most is fitted again, algebraically and then by least squares of
// distances, to the points near to it: bites, holes and specks of the mask do
// not move it. Unset: fewer than 12 points, or no circle of finite size.
std::optional<CircleFit> FitCircle(const Mask& mask);

}  // namespace ibrdf
