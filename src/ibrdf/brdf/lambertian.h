// Analytic BRDF: the same radiance in every direction.
#pragma once
#include <Eigen/Core>

#include "ibrdf/brdf/brdf_grid.h"

namespace ibrdf {

// f = albedo / pi, per channel.
struct Lambertian {
  Eigen::Array3d albedo{0.5, 0.5, 0.5};  // >= 0

  // 1/sr, at any angles.
  Eigen::Array3d Evaluate(double theta_h, double theta_d, double phi_d) const;

  // A copy of *this as a function.
  BrdfFunction Function() const;
};

// One channel in an unbounded parameter: log albedo. An albedo of 0 becomes
// the nearest value with a finite logarithm.
double ToLogParameter(const Lambertian& brdf, int channel);
void FromLogParameter(double log_albedo, int channel, Lambertian* brdf);

// f of a channel, 1/sr, and where `gradient` is not null df/dlog_albedo.
double EvaluateLambertian(double log_albedo, double* gradient);

}  // namespace ibrdf
