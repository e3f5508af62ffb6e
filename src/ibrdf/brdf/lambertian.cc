#include "ibrdf/brdf/lambertian.h"

#include <algorithm>
#include <cmath>

#include "ibrdf/base/pi.h"

namespace ibrdf {
namespace {
// Stands for 0 where a logarithm is taken.
constexpr double kTiny = 1e-12;
}  // namespace

Eigen::Array3d Lambertian::Evaluate(double /*theta_h*/, double /*theta_d*/,
                                    double /*phi_d*/) const {
  return albedo / kPi;
}

BrdfFunction Lambertian::Function() const {
  return [brdf = *this](double theta_h, double theta_d, double phi_d) {
    return brdf.Evaluate(theta_h, theta_d, phi_d);
  };
}

double ToLogParameter(const Lambertian& brdf, int channel) {
  return std::log(std::max(brdf.albedo[channel], kTiny));
}

void FromLogParameter(double log_albedo, int channel, Lambertian* brdf) {
  brdf->albedo[channel] = std::exp(log_albedo);
}

double EvaluateLambertian(double log_albedo, double* gradient) {
  const double f = std::exp(log_albedo) / kPi;
  if (gradient != nullptr) *gradient = f;
  return f;
}

}  // namespace ibrdf
