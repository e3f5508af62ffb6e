// Half/difference coordinates of a direction pair (Rusinkiewicz 1998;
// Chen et al. 2020, Eq. 4).
#pragma once
#include <Eigen/Core>
#include <cmath>

#include "ibrdf/base/pi.h"

namespace ibrdf {

// Local frame, normal = +z. Angles in radians. Isotropy drops phi_h;
// reciprocity folds phi_d into [0, pi).
struct HalfDiff {
  double theta_h;  // [0, pi/2]  normal to half-vector
  double theta_d;  // [0, pi/2]  half-vector to light
  double phi_d;    // [0, pi)
};

// [-pi, pi] to [0, pi), by reciprocity.
inline double FoldPhi(double phi) {
  if (phi < 0.0) phi += kPi;
  return phi >= kPi ? 0.0 : phi;
}

// wi, wo: unit, z > 0. At theta_h = 0 or theta_d = 0, where phi_d is not
// defined, some finite value of its range is returned.
HalfDiff ToHalfDiff(const Eigen::Vector3d& wi, const Eigen::Vector3d& wo);

// The pair of directions with the half-vector at azimuth 0; inverse of
// ToHalfDiff up to a rotation about the normal and exchange of wi and wo.
// A direction may fall below the horizon (z <= 0).
void FromHalfDiff(const HalfDiff& angles, Eigen::Vector3d* wi,
                  Eigen::Vector3d* wo);

// Largest theta_h for which both directions stay above the horizon,
// tan(theta_h) tan(theta_d) |cos(phi_d)| < 1; in [0, pi/2].
double ThetaHBound(double theta_d, double phi_d);

}  // namespace ibrdf
