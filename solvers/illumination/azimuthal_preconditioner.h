// A preconditioner of the light that sees every longitude alike, and no
// difference of left and right.
#pragma once
#include <Eigen/Cholesky>
#include <Eigen/Core>
#include <vector>

#include "ibrdf/solvers/illumination/light_preconditioner.h"

namespace ibrdf {

// Of parameters with unit variances: those of a Fourier transform along the
// rows of a map, [axis of colour][coefficient][row], coefficients as
// LightSpectrum's, then some that nothing else meets. Averaged over all turns
// of the map about the vertical, mirrored and not, J^T W J has a block for each
// axis and frequency and, where the channels are alike, nothing beside them.
class AzimuthalPreconditioner final : public LightPreconditioner {
 public:
  // blocks: J^T W J of axis a and frequency k at [a * (width / 2 + 1) + k],
  // [height]^2 each; diagonal: that of the other parameters.
  AzimuthalPreconditioner(int width, std::vector<Eigen::MatrixXd> blocks,
                          Eigen::VectorXd diagonal);

  void Damp(double damping) override;
  void Apply(const double* r, double* z) const override;

 private:
  const int width_;
  const std::vector<Eigen::MatrixXd> blocks_;
  const Eigen::VectorXd diagonal_;
  std::vector<Eigen::LLT<Eigen::MatrixXd>> factors_;
  Eigen::VectorXd damped_diagonal_;
};

}  // namespace ibrdf
