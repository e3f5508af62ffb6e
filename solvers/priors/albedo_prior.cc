#include "ibrdf/solvers/priors/albedo_prior.h"

#include <glog/logging.h>

namespace ibrdf {
namespace {

double Square(double x) { return x * x; }

// exp(-|n_p - n_q|^2 / (2 length^2)) [points]^2.
Eigen::MatrixXd SmoothKernel(const Eigen::MatrixX3d& normals, double length) {
  const Eigen::Index P = normals.rows();
  Eigen::MatrixXd kernel(P, P);
  for (Eigen::Index p = 0; p < P; ++p) {
    kernel.col(p) =
        (-(normals.rowwise() - normals.row(p)).rowwise().squaredNorm().array() /
         (2.0 * Square(length)))
            .exp();
  }
  return kernel;
}

}  // namespace

AlbedoPrior AlbedoPrior::Scaled(double factor) const {
  AlbedoPrior scaled = *this;
  scaled.luminance_std *= factor;
  scaled.chroma_std *= factor;
  scaled.own_luminance *= factor;
  scaled.own_chroma *= factor;
  scaled.smooth_luminance *= factor;
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
                                 const Eigen::MatrixX3d& chroma,
                                 const Eigen::MatrixX3d& normals) {
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
  Eigen::MatrixXd luminance =
      Square(prior.luminance_std) * kernel + Square(prior.own_luminance) * one;
  if (normals.rows() > 0 && prior.smooth_luminance > 0.0) {
    CHECK_EQ(normals.rows(), P);
    luminance += Square(prior.smooth_luminance) *
                 SmoothKernel(normals, prior.smooth_length);
  }
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
