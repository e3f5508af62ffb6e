// Cost of a Lambertian plus Cook-Torrance surface under known light.
#pragma once
#include <ceres/cost_function.h>

#include <Eigen/Core>
#include <vector>

#include "ibrdf/brdf/cook_torrance.h"
#include "ibrdf/image/image.h"
#include "ibrdf/render/transport.h"

namespace ibrdf {

// log diffuse R, G, B; log specular R, G, B; log roughness; logit f0. The
// last two are shared by the channels.
inline constexpr int kCookTorranceParameters = 8;
using CookTorranceVector = Eigen::Matrix<double, kCookTorranceParameters, 1>;

CookTorrance FromCookTorranceVector(const CookTorranceVector& parameters);

// What pixels measured: log(max(I, 0) + floor), natural, [points, 3].
struct LogObservations {
  std::vector<double> values;
  double floor = 0.0;  // radiance, > 0
};

// One residual per point and channel. With d = log(E + floor) - observed and
// rho(d) = sqrt(d^2 + s^2) - s, the Laplacian's |d| rounded at s, residual^2 /
// 2 is rho:
//   r = d sqrt(2 / (sqrt(d^2 + s^2) + s)).
// E is linear in colours and lobe fields, so that the Jacobian is exact for the
// BRDF grid of `transport`, not only in the limit of a fine one.
class CookTorranceCost final : public ceres::CostFunction {
 public:
  // map: of the transport's size. smoothing: s, natural log, > 0. num_threads
  // <= 0: all. Neither `transport` nor `map` nor `observed` is copied: all must
  // outlive *this.
  CookTorranceCost(const Transport& transport, const Image& map,
                   const LogObservations& observed, double smoothing,
                   int num_threads);

  bool Evaluate(double const* const* parameters, double* residuals,
                double** jacobians) const override;

  // Mean |d| over points and channels.
  double Misfit(const CookTorranceVector& parameters) const;

  // Radiance [points, 2, 3] of a Lambertian of albedo 1 and of the lobe at
  // specular colour 1.
  std::vector<float> UnitRadiance(double log_roughness, double logit_f0) const;

 private:
  // As UnitRadiance with `num_fields` in {2, 4}: then also the lobe's
  // derivatives in log roughness and logit f0.
  std::vector<float> RenderFields(double log_roughness, double logit_f0,
                                  int num_fields) const;

  const Transport& transport_;
  const Image& map_;
  const LogObservations& observed_;
  double smoothing_;
  int num_threads_;
  std::vector<Eigen::Vector3d> node_angles_;
};

}  // namespace ibrdf
