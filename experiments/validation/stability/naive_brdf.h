// Angles and Cook-Torrance as the papers write them, in float.
#pragma once
#include <Eigen/Geometry>
#include <algorithm>
#include <array>
#include <cmath>

namespace ibrdf {
namespace stability {

// acos of a dot product of unit vectors. The clamp is what its first NaN asks
// for.
inline float AngleBetween(const Eigen::Vector3f& a, const Eigen::Vector3f& b) {
  return std::acos(std::clamp(a.dot(b), -1.0f, 1.0f));
}

// (theta_h, theta_d, phi_d) of unit vectors, normal = +z: Rusinkiewicz 1998,
// wi turned by -phi_h about the normal and by -theta_h about the binormal.
inline std::array<float, 3> NaiveHalfDiff(const Eigen::Vector3f& wi,
                                          const Eigen::Vector3f& wo) {
  const float pi = static_cast<float>(M_PI);
  const Eigen::Vector3f h = (wi + wo).normalized();
  const float theta_h = AngleBetween(h, Eigen::Vector3f::UnitZ());
  const float theta_d = AngleBetween(h, wi);
  const float phi_h = std::atan2(h.y(), h.x());
  const Eigen::Vector3f d =
      Eigen::AngleAxisf(-theta_h, Eigen::Vector3f::UnitY()) *
      (Eigen::AngleAxisf(-phi_h, Eigen::Vector3f::UnitZ()) * wi);
  float phi_d = std::atan2(d.y(), d.x());
  if (phi_d < 0.0f) phi_d += pi;
  if (phi_d >= pi) phi_d -= pi;
  return {theta_h, theta_d, phi_d};
}

// Specular term of Cook and Torrance 1982 with Beckmann's D, Schlick's F.
inline float NaiveCookTorrance(const Eigen::Vector3f& wi,
                               const Eigen::Vector3f& wo, float m, float f0) {
  const std::array<float, 3> angles = NaiveHalfDiff(wi, wo);
  const float cos_h = std::cos(angles[0]), tan_h = std::tan(angles[0]);
  const float cos_d = std::cos(angles[1]);
  const float cos_i = wi.z(), cos_o = wo.z();
  const float D = std::exp(-(tan_h * tan_h) / (m * m)) /
                  (static_cast<float>(M_PI) * m * m * std::pow(cos_h, 4.0f));
  const float F = f0 + (1.0f - f0) * std::pow(1.0f - cos_d, 5.0f);
  const float G = std::min(
      {1.0f, 2.0f * cos_h * cos_i / cos_d, 2.0f * cos_h * cos_o / cos_d});
  return D * F * G / (4.0f * cos_i * cos_o);
}

}  // namespace stability
}  // namespace ibrdf
