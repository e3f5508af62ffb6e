// A paint whose channels differ in everything, for tests.
#pragma once
#include "ibrdf/brdf/cook_torrance.h"

namespace ibrdf {
namespace testing {

inline CookTorrance ColouredPaint(const Eigen::Array3d& roughness,
                                  const Eigen::Array3d& f0) {
  CookTorrance brdf;
  brdf.diffuse = {0.5, 0.1, 0.02};
  brdf.specular = {0.9, 0.7, 2.0};
  brdf.roughness = roughness;
  brdf.f0 = f0;
  return brdf;
}

}  // namespace testing
}  // namespace ibrdf
