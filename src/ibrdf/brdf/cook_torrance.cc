#include "ibrdf/brdf/cook_torrance.h"

#include <algorithm>
#include <cmath>

#include "ibrdf/base/pi.h"

namespace ibrdf {
namespace {
// Cosines below it count as it: f stays finite at grazing angles.
constexpr double kMinCosine = 1e-4;
// Stands for 0 where a logarithm is taken.
constexpr double kTiny = 1e-12;
// Log roughnesses beyond +- it count as it, with no slope: f stays finite.
constexpr double kMaxLogRoughness = 100.0;

// What f takes from the angles alone.
struct Geometry {
  double tan2_h;      // tan^2(theta_h)
  double lobe_scale;  // G / (4 cos_i cos_o pi cos^4(theta_h))
  double schlick;     // (1 - cos(theta_d))^5
};

Geometry GeometryOf(double theta_h, double theta_d, double phi_d) {
  const double nh = std::max(std::cos(theta_h), kMinCosine);
  const double oh = std::max(std::cos(theta_d), kMinCosine);
  // Not by 1 - c2, which cancels within a mirror's lobe.
  const double sh = std::sin(theta_h);
  const double along = sh * std::sin(theta_d) * std::cos(phi_d);
  const double larger = std::max(nh * oh + std::abs(along), kMinCosine);
  const double smaller = std::max(nh * oh - std::abs(along), 0.0);
  // G / (cos_i cos_o), G = min(1, 2 nh cos_i / oh, 2 nh cos_o / oh): written so
  // that the smaller cosine may vanish.
  double masking = 2.0 * nh / (oh * larger);
  if (masking * larger * smaller > 1.0) masking = 1.0 / (larger * smaller);
  const double c2 = nh * nh;
  Geometry g{};
  g.tan2_h = sh * sh / c2;
  g.lobe_scale = masking / (4.0 * kPi * c2 * c2);
  g.schlick = std::pow(1.0 - oh, 5);
  return g;
}

}  // namespace

Eigen::Array3d CookTorrance::Evaluate(double theta_h, double theta_d,
                                      double phi_d) const {
  const Geometry g = GeometryOf(theta_h, theta_d, phi_d);
  const Eigen::Array3d m2 = roughness.square();
  const Eigen::Array3d fresnel = f0 + (1.0 - f0) * g.schlick;
  return diffuse / kPi +
         specular * fresnel * g.lobe_scale * (-g.tan2_h / m2).exp() / m2;
}

BrdfFunction CookTorrance::Function() const {
  return [brdf = *this](double theta_h, double theta_d, double phi_d) {
    return brdf.Evaluate(theta_h, theta_d, phi_d);
  };
}

CookTorranceLog ToLogParameters(const CookTorrance& brdf, int channel) {
  const double f0 = std::clamp(brdf.f0[channel], kTiny, 1.0 - kTiny);
  return {std::log(std::max(brdf.diffuse[channel], kTiny)),
          std::log(std::max(brdf.specular[channel], kTiny)),
          std::log(std::max(brdf.roughness[channel], kTiny)),
          std::log(f0 / (1.0 - f0))};
}

void FromLogParameters(const CookTorranceLog& parameters, int channel,
                       CookTorrance* brdf) {
  brdf->diffuse[channel] = std::exp(parameters[0]);
  brdf->specular[channel] = std::exp(parameters[1]);
  brdf->roughness[channel] =
      std::exp(std::clamp(parameters[2], -kMaxLogRoughness, kMaxLogRoughness));
  brdf->f0[channel] = 1.0 / (1.0 + std::exp(-parameters[3]));
}

double EvaluateCookTorrance(const CookTorranceLog& parameters, double theta_h,
                            double theta_d, double phi_d,
                            Eigen::Vector4d* gradient) {
  const Geometry g = GeometryOf(theta_h, theta_d, phi_d);
  const double diffuse = std::exp(parameters[0]) / kPi;
  const double m2 = std::exp(
      2.0 * std::clamp(parameters[2], -kMaxLogRoughness, kMaxLogRoughness));
  const double f0 = 1.0 / (1.0 + std::exp(-parameters[3]));
  const double fresnel = f0 + (1.0 - f0) * g.schlick;
  const double facets =
      std::exp(parameters[1]) * g.lobe_scale * std::exp(-g.tan2_h / m2) / m2;
  const double lobe = facets * fresnel;
  if (gradient != nullptr) {
    const bool moves = std::abs(parameters[2]) < kMaxLogRoughness;
    *gradient << diffuse, lobe,
        moves ? lobe * 2.0 * (g.tan2_h / m2 - 1.0) : 0.0,
        facets * (1.0 - g.schlick) * f0 * (1.0 - f0);
  }
  return diffuse + lobe;
}

}  // namespace ibrdf
