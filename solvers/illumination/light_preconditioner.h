// Approximate inverses of the Hessian of an image's light.
#pragma once
#include <Eigen/Core>
#include <array>

namespace ibrdf {

// Rows of W^1/2 J at some of the points, J the derivative of their radiance by
// the log radiance of the texels, W the weights of the likelihood. Each counts
// for all the points that it stands for: J^T W J of the rows is that of the
// image, nearly.
struct InformationRows {
  int num_points = 0;
  std::array<Eigen::MatrixXf, 3> of_channel;  // [num_points * H][W]
};

// Approximates H = J^T W J + D, J by the parameters of an IlluminationModel, D
// the inverse variances of their prior. Not thread-safe.
class LightPreconditioner {
 public:
  virtual ~LightPreconditioner() = default;
  // What follows is of H + damping * D. To be called before Apply.
  virtual void Damp(double damping) = 0;
  // z [parameters], nearly H^-1 r: symmetric positive definite.
  virtual void Apply(const double* r, double* z) const = 0;
};

}  // namespace ibrdf
