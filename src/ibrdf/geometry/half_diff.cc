#include "ibrdf/geometry/half_diff.h"

#include <Eigen/Geometry>
#include <algorithm>
#include <cmath>

namespace ibrdf {

HalfDiff ToHalfDiff(const Eigen::Vector3d& wi, const Eigen::Vector3d& wo) {
  Eigen::Vector3d h = wi + wo;
  const double length = h.norm();
  if (length > 0.0) {
    h /= length;
  } else {
    h = Eigen::Vector3d::UnitZ();
  }
  HalfDiff a;
  // atan2 of sine and cosine keeps full precision at both ends of the range.
  const double sin_h = std::hypot(h.x(), h.y());
  a.theta_h = std::atan2(sin_h, std::max(h.z(), 0.0));
  const double cos_d = wi.dot(h);
  a.theta_d = std::atan2(wi.cross(h).norm(), std::max(cos_d, 0.0));
  // wi rotated by -phi_h about the normal, then by -theta_h about the binormal.
  const double cos_p = sin_h > 0.0 ? h.x() / sin_h : 1.0;
  const double sin_p = sin_h > 0.0 ? h.y() / sin_h : 0.0;
  const double x = cos_p * wi.x() + sin_p * wi.y();
  const double y = -sin_p * wi.x() + cos_p * wi.y();
  const double dx = h.z() * x - sin_h * wi.z();
  a.phi_d = FoldPhi(std::atan2(y, dx));
  return a;
}

void FromHalfDiff(const HalfDiff& angles, Eigen::Vector3d* wi,
                  Eigen::Vector3d* wo) {
  const double sh = std::sin(angles.theta_h), ch = std::cos(angles.theta_h);
  const double sd = std::sin(angles.theta_d), cd = std::cos(angles.theta_d);
  const double x = sd * std::cos(angles.phi_d);
  const double y = sd * std::sin(angles.phi_d);
  *wi = Eigen::Vector3d(ch * x + sh * cd, y, -sh * x + ch * cd);
  const Eigen::Vector3d h(sh, 0.0, ch);
  *wo = 2.0 * cd * h - *wi;
}

double ThetaHBound(double theta_d, double phi_d) {
  const double sine = std::sin(theta_d) * std::abs(std::cos(phi_d));
  return std::atan2(std::max(std::cos(theta_d), 0.0), sine);
}

}  // namespace ibrdf
