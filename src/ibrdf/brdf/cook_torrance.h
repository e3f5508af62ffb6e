// Analytic BRDF: Lambertian plus one microfacet lobe (Cook and Torrance 1982).
#pragma once
#include <Eigen/Core>

#include "ibrdf/brdf/brdf_grid.h"

namespace ibrdf {

// f = diffuse / pi + specular D F G / (4 cos_i cos_o): Beckmann D of slopes
// `roughness`, Schlick F from `f0`, G of symmetric V-grooves. Per channel; the
// directional albedo is at most diffuse + specular.
struct CookTorrance {
  Eigen::Array3d diffuse{0.3, 0.3, 0.3};    // >= 0
  Eigen::Array3d specular{1.0, 1.0, 1.0};   // >= 0
  Eigen::Array3d roughness{0.1, 0.1, 0.1};  // RMS slope, > 0
  Eigen::Array3d f0{0.04, 0.04, 0.04};      // reflectance at 0 degrees, [0, 1]

  // 1/sr at angles in radians. Finite for all angles; where a direction is
  // below the horizon the lobe continues as it was at the horizon.
  Eigen::Array3d Evaluate(double theta_h, double theta_d, double phi_d) const;

  // A copy of *this as a function.
  BrdfFunction Function() const;
};

// One channel in unbounded parameters, for fits:
// (log diffuse, log specular, log roughness, logit f0).
using CookTorranceLog = Eigen::Vector4d;

// Zeros (and f0 of 0 or 1) become the nearest values with a finite logarithm.
CookTorranceLog ToLogParameters(const CookTorrance& brdf, int channel);
void FromLogParameters(const CookTorranceLog& parameters, int channel,
                       CookTorrance* brdf);

// f of that channel, 1/sr, and where `gradient` is not null df/dparameters.
double EvaluateCookTorrance(const CookTorranceLog& parameters, double theta_h,
                            double theta_d, double phi_d,
                            Eigen::Vector4d* gradient);

}  // namespace ibrdf
