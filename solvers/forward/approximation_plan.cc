#include "ibrdf/solvers/forward/approximation_plan.h"

#include <cmath>

#include "ibrdf/base/format.h"
#include "ibrdf/base/pi.h"

namespace ibrdf {
namespace {

constexpr char kBoth[] = "; spherical harmonics and spherical Gaussians are ";

std::string Light(const ApproximationPlan& plan) {
  if (plan.approximation == Approximation::kHarmonics) {
    return "spherical harmonics up to l = " + std::to_string(plan.order);
  }
  std::string light = std::to_string(plan.gaussians) + " spherical Gaussians";
  if (plan.spots > 0) {
    light += ", " + std::to_string(plan.spots) +
             (plan.spots == 1 ? " for a bright spot" : " for bright spots");
  }
  return light;
}

std::string DescribeTaken(const ApproximationPlan& plan) {
  return "; light in " + Light(plan) + (plan.forced ? ", as asked" : "") +
         Format(
             ": predicted error of log radiance %.4f, found %.4f at %d points",
             plan.predicted_error, plan.found_error, plan.checked) +
         Format(" (allowed %.4f; point by point %.4f)", plan.log_error,
                plan.quadrature_error) +
         Format(", about %.2f s of a core for %.2f s", plan.seconds,
                plan.quadrature_seconds);
}

}  // namespace

std::string Describe(const ApproximationPlan& plan) {
  switch (plan.verdict) {
    case ApproximationVerdict::kNotConsidered:
      return "";
    case ApproximationVerdict::kNarrowLobe:
      return kBoth + Format("not within %.4f for a lobe of %.1f degrees",
                            plan.log_error, plan.lobe_half_width * 180.0 / kPi);
    case ApproximationVerdict::kPredictedOff:
      return kBoth + Format("not within %.4f: predicted at best %.4f",
                            plan.log_error, plan.predicted_error);
    case ApproximationVerdict::kNonePays:
      return kBoth + Format(
                         "slower or not within %.4f: predicted at best %.4f, "
                         "point by point %.4f",
                         plan.log_error, plan.predicted_error,
                         plan.quadrature_error);
    case ApproximationVerdict::kTaken:
      return DescribeTaken(plan);
  }
  return "";
}

}  // namespace ibrdf
