#include "ibrdf/solvers/illumination/azimuthal_preconditioner.h"

#include <utility>

#include "ibrdf/solvers/priors/light_spectrum.h"

namespace ibrdf {

AzimuthalPreconditioner::AzimuthalPreconditioner(
    int width, std::vector<Eigen::MatrixXd> blocks, Eigen::VectorXd diagonal)
    : width_(width),
      blocks_(std::move(blocks)),
      diagonal_(std::move(diagonal)) {}

void AzimuthalPreconditioner::Damp(double damping) {
  factors_.clear();
  for (const Eigen::MatrixXd& block : blocks_) {
    Eigen::MatrixXd damped = block;
    damped.diagonal().array() += 1.0 + damping;
    factors_.emplace_back(damped);
  }
  damped_diagonal_ = diagonal_.array() + (1.0 + damping);
}

void AzimuthalPreconditioner::Apply(const double* r, double* z) const {
  const Eigen::Index height = blocks_.front().rows();
  const size_t frequencies = blocks_.size() / 3;
  Eigen::Index at = 0;
  for (size_t axis = 0; axis < 3; ++axis) {
    for (int j = 0; j < width_; ++j, at += height) {
      const size_t k = static_cast<size_t>(LightSpectrum::FrequencyOf(j));
      Eigen::Map<Eigen::VectorXd>(z + at, height) =
          factors_[axis * frequencies + k].solve(
              Eigen::Map<const Eigen::VectorXd>(r + at, height));
    }
  }
  Eigen::Map<Eigen::VectorXd>(z + at, diagonal_.size()) =
      Eigen::Map<const Eigen::VectorXd>(r + at, diagonal_.size())
          .cwiseQuotient(damped_diagonal_);
}

}  // namespace ibrdf
