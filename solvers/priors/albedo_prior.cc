#include "ibrdf/solvers/priors/albedo_prior.h"

#include <glog/logging.h>

namespace ibrdf {
namespace {

double Square(double x) { return x * x; }

}  // namespace

AlbedoPrior AlbedoPrior::Scaled(double factor) const {
  AlbedoPrior scaled = *this;
  scaled.luminance_std *= factor;
  scaled.chroma_std *= factor;
  scaled.own_luminance *= factor;
  scaled.own_chroma *= factor;
  return scaled;
}

Eigen::MatrixX3d LogChroma(const std::vector<double>& log_radiance) {
  CHECK_EQ(log_radiance.size() % 3, 0u);
  Eigen::MatrixX3d chroma = Eigen::Map<const Eigen::MatrixX3d>(
      log_radiance.data(), static_cast<Eigen::Index>(log_radiance.size() / 3),
      3);
  const Eigen::VectorXd luminance = chroma.rowwise().mean();
  chroma.colwise() -= luminance;
  return chroma;
}

Eigen::MatrixXd AlbedoCovariance(const AlbedoPrior& prior,
                                 const Eigen::MatrixX3d& chroma) {
  const Eigen::Index P = chroma.rows();
  Eigen::MatrixXd kernel(P, P);
  for (Eigen::Index p = 0; p < P; ++p) {
    for (Eigen::Index q = 0; q < P; ++q) {
      const double distance = (chroma.row(p) - chroma.row(q)).squaredNorm();
      kernel(p, q) =
          1.0 / (1.0 + distance / (2.0 * Square(prior.colour_length)));
    }
  }
  const Eigen::MatrixXd one = Eigen::MatrixXd::Identity(P, P);
  const Eigen::MatrixXd luminance =
      Square(prior.luminance_std) * kernel + Square(prior.own_luminance) * one;
  const Eigen::MatrixXd colour =
      Square(prior.chroma_std) * kernel + Square(prior.own_chroma) * one;
  Eigen::MatrixXd K(3 * P, 3 * P);
  for (int c = 0; c < 3; ++c) {
    for (int d = 0; d < 3; ++d) {
      K.block(c * P, d * P, P, P) =
          luminance + ((c == d ? 1.0 : 0.0) - 1.0 / 3.0) * colour;
    }
  }
  return K;
}

}  // namespace ibrdf
