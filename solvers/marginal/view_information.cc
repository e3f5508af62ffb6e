#include "ibrdf/solvers/marginal/view_information.h"

#include <glog/logging.h>

#include <Eigen/Dense>
#include <limits>
#include <utility>

namespace ibrdf {
namespace {

double HalfLogDetOf(const Eigen::MatrixXd& matrix) {
  if (matrix.size() == 0) return 0.0;
  const Eigen::LLT<Eigen::MatrixXd> factor(matrix);
  if (factor.info() != Eigen::Success) {
    return std::numeric_limits<double>::quiet_NaN();
  }
  return factor.matrixLLT().diagonal().array().log().sum();
}

}  // namespace

ViewInformation::ViewInformation(LinearPosterior photographs, int num_nuisance)
    : all_(std::move(photographs)), num_nuisance_(num_nuisance) {
  CHECK(num_nuisance >= 0 && num_nuisance < all_.information.rows());
  all_.information.diagonal().array() += 1.0;
  half_log_det_ = HalfLogDet(all_.information);
}

double ViewInformation::HalfLogDet(const Eigen::MatrixXd& information) const {
  // Schur's complement of the nuisance's block.
  return HalfLogDetOf(information) - HalfLogDetOf(information.bottomRightCorner(
                                         num_nuisance_, num_nuisance_));
}

ViewInformation::WhitenedRows ViewInformation::Whiten(
    const LogRadianceSlopes& view, bool with_light) const {
  WhitenedRows out;
  const Eigen::Index P = view.by_light[0].rows(), n = view.by_light[0].cols();
  CHECK_EQ(all_.light_covariance.rows(), 3 * n);
  RowMatrix J_covariance(3 * P, 3 * n), S(3 * P, 3 * P);
  RowMatrix rows = view.by_parameters;
  for (int c = 0; c < 3; ++c) {
    RowMatrix product;
    Multiply(view.by_light[c], all_.light_covariance.middleRows(c * n, n),
             &product);
    J_covariance.middleRows(c * P, P) = product;
    rows.middleRows(c * P, P).noalias() -=
        view.by_light[c] * all_.light_slope.middleRows(c * n, n);
  }
  for (int d = 0; d < 3; ++d) {
    RowMatrix product;
    MultiplyTransposed(J_covariance.middleCols(d * n, n), view.by_light[d],
                       &product);
    S.middleCols(d * P, P) = product;
  }
  S.diagonal() += view.noise;
  if (!S.allFinite() || !rows.allFinite() || !Factorise(&S)) return out;
  const auto factor = S.triangularView<Eigen::Lower>();
  out.by_parameters = factor.solve(rows);
  if (with_light) out.by_light = factor.solve(J_covariance);
  out.ok = true;
  return out;
}

double ViewInformation::Gain(const LogRadianceSlopes& view) const {
  const WhitenedRows rows = Whiten(view, /*with_light=*/false);
  if (!rows.ok) return std::numeric_limits<double>::quiet_NaN();
  const Eigen::MatrixXd information =
      all_.information + rows.by_parameters.transpose() * rows.by_parameters;
  return HalfLogDet(information) - half_log_det_;
}

void ViewInformation::Add(const LogRadianceSlopes& view) {
  const WhitenedRows rows = Whiten(view, /*with_light=*/true);
  CHECK(rows.ok);
  all_.information.noalias() +=
      rows.by_parameters.transpose() * rows.by_parameters;
  all_.light_slope.noalias() += rows.by_light.transpose() * rows.by_parameters;
  RowMatrix known;
  Multiply(RowMatrix(rows.by_light.transpose()), rows.by_light, &known);
  all_.light_covariance -= known;
  half_log_det_ = HalfLogDet(all_.information);
}

}  // namespace ibrdf
