// Cost of a Lambertian plus Cook-Torrance surface under known light.
#pragma once
#include <ceres/cost_function.h>

#include <Eigen/Core>
#include <vector>

#include "ibrdf/brdf/cook_torrance.h"
#include "ibrdf/brdf/cook_torrance_lobes.h"
#include "ibrdf/image/image.h"
#include "ibrdf/transport/transport.h"

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

// One residual per point and channel. With d = log(L_o + floor) - observed and
// rho(d) = sqrt(d^2 + s^2) - s, the Laplacian's |d| rounded at s, residual^2 /
// 2 is rho:
//   r = d sqrt(2 / (sqrt(d^2 + s^2) + s)).
// L_o is linear in colours and lobe fields, so that the Jacobian is exact for
// the BRDF grid of `transport`, not only in the limit of a fine one. Its
// functions may be called from one thread at a time.
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

  // Radiance [points, kFields, 3] of a Lambertian of albedo 1, of the lobe at
  // specular colour 1, and of that lobe's derivatives in log roughness and
  // logit f0. Valid until the next call of any function with others of these.
  static constexpr int kFields = 4;
  const std::vector<float>& UnitRadiance(double log_roughness,
                                         double logit_f0) const;

 private:
  std::vector<float> RenderFields(double log_roughness, double logit_f0) const;

  const Transport& transport_;
  const Image& map_;
  const LogObservations& observed_;
  double smoothing_;
  CookTorranceLobes lobes_;
  // The last render: steps of the colours alone need no other.
  mutable double last_roughness_ = 0.0, last_f0_ = 0.0;
  mutable std::vector<float> last_radiance_;  // empty: none
};

}  // namespace ibrdf
