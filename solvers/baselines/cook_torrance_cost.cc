#include "ibrdf/solvers/baselines/cook_torrance_cost.h"

#include <glog/logging.h>

#include <array>
#include <cmath>

namespace ibrdf {

CookTorrance FromCookTorranceVector(const CookTorranceVector& parameters) {
  CookTorrance brdf;
  for (int c = 0; c < 3; ++c) {
    FromLogParameters(
        {parameters[c], parameters[3 + c], parameters[6], parameters[7]}, c,
        &brdf);
  }
  return brdf;
}

CookTorranceCost::CookTorranceCost(const Transport& transport, const Image& map,
                                   const LogObservations& observed,
                                   double smoothing, int num_threads)
    : transport_(transport),
      map_(map),
      observed_(observed),
      smoothing_(smoothing),
      lobes_(transport.grid_shape(), num_threads) {
  CHECK_EQ(map.width, transport.map_width());
  CHECK_EQ(map.height, transport.map_height());
  CHECK_EQ(observed.values.size(), size_t{3} * transport.num_points());
  CHECK_GT(observed.floor, 0.0);
  CHECK_GT(smoothing, 0.0);
  set_num_residuals(static_cast<int>(observed.values.size()));
  mutable_parameter_block_sizes()->push_back(kCookTorranceParameters);
}

std::vector<float> CookTorranceCost::RenderFields(double log_roughness,
                                                  double logit_f0) const {
  std::vector<double> parameters(lobes_.num_parameters(), 0.0);
  lobes_.Mixture(parameters.data()).code(1) << log_roughness, logit_f0;
  std::vector<float> fields;
  lobes_.Tabulate(parameters.data(), true, &fields);
  // The first lobe's derivatives, which are 0, are left out.
  const size_t nodes = lobes_.grid_shape().num_nodes();
  std::array<const float*, kFields> pointers{};
  for (int k = 0; k < kFields; ++k) {
    const int field = k == 0 ? 0 : CookTorranceLobes::kCode + k;
    pointers[k] = &fields[field * nodes];
  }
  std::vector<float> radiance(size_t{3} * kFields * transport_.num_points());
  transport_.RenderLobes(pointers.data(), kFields, map_.rgb.data(),
                         radiance.data());
  return radiance;
}

const std::vector<float>& CookTorranceCost::UnitRadiance(
    double log_roughness, double logit_f0) const {
  if (last_radiance_.empty() || last_roughness_ != log_roughness ||
      last_f0_ != logit_f0) {
    last_radiance_ = RenderFields(log_roughness, logit_f0);
    last_roughness_ = log_roughness;
    last_f0_ = logit_f0;
  }
  return last_radiance_;
}

bool CookTorranceCost::Evaluate(double const* const* parameters,
                                double* residuals, double** jacobians) const {
  const Eigen::Map<const CookTorranceVector> p(parameters[0]);
  const bool with_jacobian = jacobians != nullptr && jacobians[0] != nullptr;
  const std::vector<float>& radiance = UnitRadiance(p[6], p[7]);
  const double s = smoothing_;
  for (int i = 0; i < transport_.num_points(); ++i) {
    for (int c = 0; c < 3; ++c) {
      const auto field = [&](int k) -> double {
        return radiance[(static_cast<size_t>(i) * kFields + k) * 3 + c];
      };
      const double diffuse = std::exp(p[c]) * field(0);
      const double specular_colour = std::exp(p[3 + c]);
      const double specular = specular_colour * field(1);
      const double L_o = diffuse + specular + observed_.floor;
      const int row = 3 * i + c;
      const double d = std::log(L_o) - observed_.values[row];
      if (!std::isfinite(d)) return false;  // step rejected
      const double root = std::sqrt(d * d + s * s);
      residuals[row] = d * std::sqrt(2.0 / (root + s));
      if (!with_jacobian) continue;
      const double dr_dE = std::sqrt(0.5 * (root + s)) / root / L_o;
      Eigen::Map<CookTorranceVector> J(jacobians[0] +
                                       row * kCookTorranceParameters);
      J.setZero();
      J[c] = dr_dE * diffuse;
      J[3 + c] = dr_dE * specular;
      J[6] = dr_dE * specular_colour * field(2);
      J[7] = dr_dE * specular_colour * field(3);
      if (!J.allFinite()) return false;
    }
  }
  return true;
}

double CookTorranceCost::Misfit(const CookTorranceVector& parameters) const {
  const std::vector<float>& radiance =
      UnitRadiance(parameters[6], parameters[7]);
  double sum = 0.0;
  for (int i = 0; i < transport_.num_points(); ++i) {
    for (int c = 0; c < 3; ++c) {
      const size_t at = static_cast<size_t>(i) * 3 * kFields + c;
      const double L_o = std::exp(parameters[c]) * radiance[at] +
                         std::exp(parameters[3 + c]) * radiance[at + 3];
      sum += std::abs(std::log(L_o + observed_.floor) -
                      observed_.values[3 * i + c]);
    }
  }
  return sum / static_cast<double>(observed_.values.size());
}

}  // namespace ibrdf
