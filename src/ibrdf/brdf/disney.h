// Analytic BRDF: the base of the principled model (Burley 2012): its diffuse
// part with retro-reflection and one GGX lobe.
#pragma once
#include <Eigen/Core>

#include "ibrdf/brdf/brdf_grid.h"

namespace ibrdf {

// f = (1 - metallic) base / pi (1 + (F90 - 1) (1 - cos_i)^5)
//                              (1 + (F90 - 1) (1 - cos_o)^5)
//     + D F G / (4 cos_i cos_o),
// F90 = 1/2 + 2 roughness cos^2(theta_d); D: GGX (Trowbridge and Reitz 1975) of
// alpha = roughness^2; G: Smith's, one factor a direction (Walter et al. 2007),
// of the same alpha, as in Burley 2015; F: Schlick's from
// F0 = (1 - metallic) 0.08 specular + metallic base.
// Burley's values are in [0, 1]. Fits to tables of another scale need more: a
// base above 1 and a specular up to 12.5 (F0 = 1) are taken.
struct Disney {
  Eigen::Array3d base{0.5, 0.5, 0.5};  // >= 0
  double roughness = 0.5;              // [0, 1]
  double metallic = 0.0;               // [0, 1]
  double specular = 0.5;               // [0, 12.5]

  // 1/sr at angles in radians. Finite for all angles; where a direction is
  // below the horizon f continues as it was at the horizon. Reciprocal.
  Eigen::Array3d Evaluate(double theta_h, double theta_d, double phi_d) const;

  // A copy of *this as a function.
  BrdfFunction Function() const;
};

// Unbounded parameters for fits: (log base R, G, B, logit roughness, logit
// metallic, logit of 0.08 specular).
inline constexpr int kDisneyParameters = 6;
using DisneyLog = Eigen::Matrix<double, kDisneyParameters, 1>;

Disney FromLogParameters(const DisneyLog& parameters);

// What f takes from the angles alone, to be kept over the iterations of a fit.
struct DisneyGeometry {
  DisneyGeometry(double theta_h, double theta_d, double phi_d);

  double cos_i, cos_o;          // [0, 1]
  double cos2_h, cos2_d;        // squares
  double schlick_i, schlick_o;  // (1 - cos)^5
  double schlick_d;
};

// f of that channel, 1/sr, and where `gradient` is not null df/dparameters.
double EvaluateDisney(const DisneyLog& parameters,
                      const DisneyGeometry& geometry, int channel,
                      DisneyLog* gradient);

}  // namespace ibrdf
