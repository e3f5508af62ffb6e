#include "ibrdf/solvers/segmentation/normal_polynomials.h"

#include <gtest/gtest.h>

#include <Eigen/SVD>

namespace ibrdf {
namespace {

Eigen::MatrixX3d SomeNormals() {
  std::srand(7);
  const Eigen::MatrixX3d any = Eigen::MatrixX3d::Random(200, 3);
  return any.rowwise().normalized();
}

TEST(NormalPolynomials, AreAsManyAsHarmonicsAndIndependent) {
  for (int degree = 1; degree <= kMostPolynomialDegree; ++degree) {
    const Eigen::MatrixXd p = NormalPolynomials(SomeNormals(), degree);
    ASSERT_EQ((degree + 1) * (degree + 1), p.cols());
    EXPECT_EQ(p.cols(), PolynomialPrecisions(degree).size());
    const Eigen::VectorXd singular =
        Eigen::JacobiSVD<Eigen::MatrixXd>(p).singularValues();
    EXPECT_GT(singular.minCoeff(), 1e-3 * singular.maxCoeff()) << degree;
  }
}

// So that labels of a photograph do not depend on how the world is turned.
TEST(NormalPolynomials, SpanTheSameWhereTheWorldIsTurned) {
  const Eigen::Matrix3d turn =
      Eigen::AngleAxisd(1.1, Eigen::Vector3d(0.3, -0.5, 0.8).normalized())
          .toRotationMatrix();
  for (int degree = 1; degree <= kMostPolynomialDegree; ++degree) {
    const Eigen::MatrixXd p = NormalPolynomials(SomeNormals(), degree);
    const Eigen::MatrixXd turned =
        NormalPolynomials(SomeNormals() * turn, degree);
    const Eigen::MatrixXd left =
        turned - p * p.colPivHouseholderQr().solve(turned);
    EXPECT_LT(left.cwiseAbs().maxCoeff(), 1e-9) << degree;
  }
}

}  // namespace
}  // namespace ibrdf
