// What an estimated reflectance is like.
#pragma once
#include <limits>
#include <string>
#include <vector>

#include "ibrdf/brdf/merl_table.h"
#include "ibrdf/solvers/estimation/solution.h"
#include "ibrdf/solvers/problem/inverse_problem.h"

namespace ibrdf {

// A material that the model was trained on.
struct NearMaterial {
  std::string name;
  double brdf_log_difference = 0.0;  // as of Alternative
};

// The directional albedo, seen from 30 degrees off the normal, in two parts.
// Diffuse: pi times the least f_r among light directions within 60 degrees of
// the normal, the most that a Lambertian surface can have of it there.
// Specular: the rest. Shares of the luminance, which no scale changes; sum 1.
struct ReflectanceShares {
  double diffuse = std::numeric_limits<double>::quiet_NaN();
  double specular = std::numeric_limits<double>::quiet_NaN();
};

// NaN where the albedo is not finite and > 0.
ReflectanceShares SharesOf(const MerlTable& brdf);

struct MaterialSummary {
  std::vector<NearMaterial> nearest;  // three at most, the nearest first
  ReflectanceShares shares;
};

// Empty where the reflectance was known.
MaterialSummary SummariseMaterial(const InverseProblem& inverse,
                                  const Solution& solution);

// Sentences; empty for what is not known.
std::string MaterialWords(const MaterialSummary& summary);

}  // namespace ibrdf
