#include "ibrdf/solvers/segmentation/normal_polynomials.h"

#include <glog/logging.h>

namespace ibrdf {
namespace {

// By degree; colour of one material varies more slowly than it is bright.
constexpr double kPrecisions[kMostPolynomialDegree + 1] = {0.0025, 0.01, 0.04,
                                                           0.08};

int NumPolynomials(int degree) { return (degree + 1) * (degree + 1); }

}  // namespace

Eigen::MatrixXd NormalPolynomials(const Eigen::MatrixX3d& normals, int degree) {
  CHECK(degree >= 1 && degree <= kMostPolynomialDegree);
  Eigen::MatrixXd p(normals.rows(), NumPolynomials(degree));
  const auto x = normals.col(0).array(), y = normals.col(1).array(),
             z = normals.col(2).array();
  p.col(0).setOnes();
  p.middleCols(1, 3) = normals;
  if (degree >= 2) {
    p.col(4) = x * y;
    p.col(5) = y * z;
    p.col(6) = x * z;
    p.col(7) = x.square() - y.square();
    p.col(8) = 3.0 * z.square() - 1.0;
  }
  if (degree >= 3) {
    p.col(9) = x.cube();
    p.col(10) = y.cube();
    p.col(11) = x.square() * y;
    p.col(12) = y.square() * x;
    p.col(13) = x.square() * z;
    p.col(14) = y.square() * z;
    p.col(15) = x * y * z;
  }
  return p;
}

Eigen::VectorXd PolynomialPrecisions(int degree) {
  Eigen::VectorXd precisions(NumPolynomials(degree));
  for (int d = 0; d <= degree; ++d) {
    precisions.segment(d * d, 2 * d + 1).setConstant(kPrecisions[d]);
  }
  return precisions;
}

}  // namespace ibrdf
