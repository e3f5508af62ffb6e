// The lobes of an estimate in the units of brdf.json, with their standard
// deviations.
#pragma once
#include <array>
#include <optional>
#include <vector>

#include "ibrdf/solvers/estimation/solution.h"
#include "ibrdf/solvers/problem/inverse_problem.h"

namespace ibrdf {

inline constexpr char kLobeFormula[] =
    "raw = sum over lobes of colour * density(code) ^ exponent";

struct LobeSummary {
  std::vector<double> code;      // in the unit ball; Lambertian: empty
  std::array<double, 3> colour;  // raw MERL units
  // One standard deviation of the posterior (Laplace, light integrated out);
  // unset where the solution has no covariance.
  struct Deviation {
    std::vector<double> code;
    std::array<double, 3> log_colour;
  };
  std::optional<Deviation> deviation;
};

// Empty where the reflectance was known.
std::vector<LobeSummary> SummariseLobes(const InverseProblem& inverse,
                                        const Solution& solution);

}  // namespace ibrdf
