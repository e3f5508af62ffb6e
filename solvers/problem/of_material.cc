#include "ibrdf/solvers/problem/of_material.h"

#include <glog/logging.h>

#include <algorithm>

namespace ibrdf {

InverseProblem OfMaterial(const InverseProblem& problem, int material) {
  CHECK(material >= 0 && material < static_cast<int>(problem.materials.size()));
  InverseProblem out = problem;
  out.materials = {problem.materials[material]};
  out.points.clear();
  for (ShadingPoint point : problem.points) {
    if (point.material != material) continue;
    point.material = 0;
    out.points.push_back(point);
  }
  return out;
}

}  // namespace ibrdf
