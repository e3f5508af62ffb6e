#include "ibrdf/brdf/dsbrdf.h"

#include <algorithm>
#include <cmath>

#include "ibrdf/base/pi.h"

namespace ibrdf {
namespace {
// Cosines below it count as it.
constexpr double kMinHalfCosine = 1e-6;
// Exponents and logarithms above it count as it, with no slope: f stays finite.
constexpr double kMaxExponent = 60.0;
}  // namespace

SplineBasis::SplineBasis(int num_coefficients, double theta) {
  const int spans = num_coefficients - 3;
  const double x = std::clamp(theta / (kPi / 2), 0.0, 1.0) * spans;
  first = std::min(static_cast<int>(x), spans - 1);
  // Knots are 0 ... spans, those at the ends four times.
  const auto knot = [&](int i) {
    return static_cast<double>(std::clamp(i, 0, spans));
  };
  // Cox and de Boor: from degree 0 to 3 in place.
  weight = {1.0, 0.0, 0.0, 0.0};
  for (int degree = 1; degree <= 3; ++degree) {
    double carried = 0.0;
    for (int k = 0; k < degree; ++k) {
      const double right = knot(first + k + 1) - x;
      const double left = x - knot(first + k + 1 - degree);
      const double share = weight[k] / (right + left);
      weight[k] = carried + right * share;
      carried = left * share;
    }
    weight[degree] = carried;
  }
}

DsbrdfGeometry::DsbrdfGeometry(const DsbrdfShape& shape, double theta_h,
                               double theta_d)
    : log_cos_h(std::log(std::max(std::cos(theta_h), kMinHalfCosine))),
      basis(shape.coefficients, theta_d) {}

double EvaluateDsbrdf(const DsbrdfShape& shape, const double* parameters,
                      const DsbrdfGeometry& geometry, double* gradient) {
  const SplineBasis& basis = geometry.basis;
  const auto curve = [&](const double* coefficients) {
    double sum = 0.0;
    for (int k = 0; k < 4; ++k) {
      sum += basis.weight[k] * coefficients[basis.first + k];
    }
    return sum;
  };
  const double unit =
      std::exp(std::min(parameters[shape.LogUnit()], kMaxExponent));
  if (gradient != nullptr) {
    std::fill(gradient, gradient + shape.num_parameters(), 0.0);
  }
  double f = 0.0;
  for (int r = 0; r < shape.lobes; ++r) {
    const double log_kappa =
        std::min(curve(parameters + shape.LogKappa(r)), kMaxExponent);
    const double log_gamma =
        std::min(curve(parameters + shape.LogGamma(r)), kMaxExponent);
    const double log_power = std::exp(log_gamma) * geometry.log_cos_h;  // <= 0
    const double exponent =
        std::min(std::exp(log_kappa + log_power), kMaxExponent);
    const double rise = std::expm1(exponent);
    f += unit * rise;
    if (gradient == nullptr || exponent >= kMaxExponent) continue;
    const double slope = unit * (rise + 1.0) * exponent;  // df/dlog exponent
    for (int k = 0; k < 4; ++k) {
      const int at = basis.first + k;
      gradient[shape.LogKappa(r) + at] = slope * basis.weight[k];
      // An underflown exponent times a log_power of 1e26 must be 0.
      gradient[shape.LogGamma(r) + at] =
          slope > 0.0 ? slope * log_power * basis.weight[k] : 0.0;
    }
  }
  if (gradient != nullptr) gradient[shape.LogUnit()] = f;
  return f;
}

Eigen::Array3d Dsbrdf::Evaluate(double theta_h, double theta_d,
                                double /*phi_d*/) const {
  const DsbrdfGeometry geometry(shape, theta_h, theta_d);
  Eigen::Array3d f = Eigen::Array3d::Zero();
  for (int c = 0; c < 3; ++c) {
    if (parameters[c].size() != shape.num_parameters()) continue;
    f[c] = EvaluateDsbrdf(shape, parameters[c].data(), geometry, nullptr);
  }
  return f;
}

BrdfFunction Dsbrdf::Function() const {
  return [brdf = *this](double theta_h, double theta_d, double phi_d) {
    return brdf.Evaluate(theta_h, theta_d, phi_d);
  };
}

}  // namespace ibrdf
