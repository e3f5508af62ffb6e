#include "ibrdf/brdf/disney.h"

#include <algorithm>
#include <cmath>

#include "ibrdf/base/pi.h"

namespace ibrdf {
namespace {
// Smallest alpha^2: keeps D finite at theta_h = 0.
constexpr double kMinAlpha2 = 1e-10;
constexpr double kSpecularScale = 0.08;  // Burley 2012, section 5.5

double Logistic(double x) { return 1.0 / (1.0 + std::exp(-x)); }

double Pow5(double x) { return x * x * x * x * x; }

// The values of one channel.
struct Channel {
  double base, roughness, metallic, f0;  // f0: of the dielectric part
};

// f, and its derivatives in the four values where `gradient` is not null.
double EvaluateChannel(const Channel& v, const DisneyGeometry& g,
                       Eigen::Vector4d* gradient) {
  const double r2 = v.roughness * v.roughness;
  const double alpha2 = std::max(r2 * r2, kMinAlpha2);
  const double t = (1.0 - g.cos2_h) + g.cos2_h * alpha2;
  const double root_i = std::sqrt(alpha2 + (1.0 - alpha2) * g.cos_i * g.cos_i);
  const double root_o = std::sqrt(alpha2 + (1.0 - alpha2) * g.cos_o * g.cos_o);
  const double sum_i = g.cos_i + root_i, sum_o = g.cos_o + root_o;
  // D G / (4 cos_i cos_o): Smith's factor is 2 cos / (cos + root).
  const double facets = alpha2 / (kPi * t * t) / (sum_i * sum_o);
  const double f0 = (1.0 - v.metallic) * v.f0 + v.metallic * v.base;
  const double fresnel = f0 + (1.0 - f0) * g.schlick_d;

  const double rise = 2.0 * v.roughness * g.cos2_d - 0.5;  // F90 - 1
  const double in = 1.0 + rise * g.schlick_i;
  const double out = 1.0 + rise * g.schlick_o;
  const double diffuse = (1.0 - v.metallic) * v.base / kPi;
  if (gradient != nullptr) {
    const double lobe_f0 = facets * (1.0 - g.schlick_d);  // df/dF0
    const double log_facets_alpha2 =
        1.0 / alpha2 - 2.0 * g.cos2_h / t -
        (1.0 - g.cos_i * g.cos_i) / (2.0 * root_i * sum_i) -
        (1.0 - g.cos_o * g.cos_o) / (2.0 * root_o * sum_o);
    const double alpha2_roughness =
        alpha2 > kMinAlpha2 ? 4.0 * r2 * v.roughness : 0.0;
    *gradient << (1.0 - v.metallic) / kPi * in * out + lobe_f0 * v.metallic,
        facets * fresnel * log_facets_alpha2 * alpha2_roughness +
            diffuse * (g.schlick_i * out + g.schlick_o * in) * 2.0 * g.cos2_d,
        -v.base / kPi * in * out + lobe_f0 * (v.base - v.f0),
        lobe_f0 * (1.0 - v.metallic);
  }
  return diffuse * in * out + facets * fresnel;
}

}  // namespace

DisneyGeometry::DisneyGeometry(double theta_h, double theta_d, double phi_d) {
  const double nh = std::max(std::cos(theta_h), 0.0);
  const double oh = std::max(std::cos(theta_d), 0.0);
  const double along = std::sin(theta_h) * std::sin(theta_d) * std::cos(phi_d);
  cos_i = std::clamp(nh * oh - along, 0.0, 1.0);
  cos_o = std::clamp(nh * oh + along, 0.0, 1.0);
  cos2_h = nh * nh;
  cos2_d = oh * oh;
  schlick_i = Pow5(1.0 - cos_i);
  schlick_o = Pow5(1.0 - cos_o);
  schlick_d = Pow5(1.0 - oh);
}

Eigen::Array3d Disney::Evaluate(double theta_h, double theta_d,
                                double phi_d) const {
  const DisneyGeometry g(theta_h, theta_d, phi_d);
  Eigen::Array3d f;
  for (int c = 0; c < 3; ++c) {
    f[c] = EvaluateChannel(
        {base[c], roughness, metallic, kSpecularScale * specular}, g, nullptr);
  }
  return f;
}

BrdfFunction Disney::Function() const {
  return [brdf = *this](double theta_h, double theta_d, double phi_d) {
    return brdf.Evaluate(theta_h, theta_d, phi_d);
  };
}

Disney FromLogParameters(const DisneyLog& parameters) {
  Disney brdf;
  for (int c = 0; c < 3; ++c) brdf.base[c] = std::exp(parameters[c]);
  brdf.roughness = Logistic(parameters[3]);
  brdf.metallic = Logistic(parameters[4]);
  brdf.specular = Logistic(parameters[5]) / kSpecularScale;
  return brdf;
}

double EvaluateDisney(const DisneyLog& parameters,
                      const DisneyGeometry& geometry, int channel,
                      DisneyLog* gradient) {
  const Channel v = {std::exp(parameters[channel]), Logistic(parameters[3]),
                     Logistic(parameters[4]), Logistic(parameters[5])};
  if (gradient == nullptr) return EvaluateChannel(v, geometry, nullptr);
  Eigen::Vector4d values;
  const double f = EvaluateChannel(v, geometry, &values);
  gradient->setZero();
  (*gradient)[channel] = values[0] * v.base;
  (*gradient)[3] = values[1] * v.roughness * (1.0 - v.roughness);
  (*gradient)[4] = values[2] * v.metallic * (1.0 - v.metallic);
  (*gradient)[5] = values[3] * v.f0 * (1.0 - v.f0);
  return f;
}

}  // namespace ibrdf
