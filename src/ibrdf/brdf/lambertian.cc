#include "ibrdf/brdf/lambertian.h"

#include "ibrdf/base/pi.h"

namespace ibrdf {

Eigen::Array3d Lambertian::Evaluate(double /*theta_h*/, double /*theta_d*/,
                                    double /*phi_d*/) const {
  return albedo / kPi;
}

BrdfFunction Lambertian::Function() const {
  return [brdf = *this](double theta_h, double theta_d, double phi_d) {
    return brdf.Evaluate(theta_h, theta_d, phi_d);
  };
}

}  // namespace ibrdf
