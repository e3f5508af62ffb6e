// Points of a sphere, and those where renderers go wrong.
#pragma once
#include <vector>

#include "tests/support/render_testing.h"

namespace ibrdf {
namespace testing {

inline std::vector<ShadingPoint> AllPoints() {
  std::vector<ShadingPoint> points = SpherePoints(8);
  for (const ShadingPoint& p : PolarAndGrazingPoints()) points.push_back(p);
  return points;
}

}  // namespace testing
}  // namespace ibrdf
