// What photographs say of a reflectance under unknown light, and what another
// photograph would add before it is taken.
//
// Log radiance moves by G d + J l with parameters and light. With the light
// integrated out, data of noise D have the covariance A = D + J K J^T, and the
// parameters the Fisher information G^T A^-1 G (MarginalLikelihood). Another
// photograph adds rows to G and J. Its values are not needed: to first order
// information depends on them by the estimate alone (MacKay, "Information-Based
// Objective Functions for Active Data Selection", Neural Computation 4(4),
// 1992). The light that the first photographs left unknown is what the next
// one's rows share with theirs, so it is kept as a covariance, and rows are
// added as in a Kalman filter.
#pragma once
#include <Eigen/Core>

#include "ibrdf/solvers/marginal/marginal_likelihood.h"
#include "ibrdf/solvers/marginal/marginal_reflectance.h"

namespace ibrdf {

// Safe to share between threads while nothing is added.
class ViewInformation {
 public:
  // photographs: of parameters whose prior is N(., 1), of which the last
  // num_nuisance are integrated out: nobody asks for them.
  ViewInformation(LinearPosterior photographs, int num_nuisance);

  // Nats that all views give beyond the prior:
  //   log det(covariance of the parameters, prior over posterior) / 2.
  double information() const { return half_log_det_; }

  // Nats that a view would add, >= 0 but for rounding: half the gain in log det
  // of the information. NaN where its rows are not finite.
  // by_parameters: of the parameters as they were given.
  double Gain(const LogRadianceSlopes& view) const;

  // The view is taken; it must have a finite gain.
  void Add(const LogRadianceSlopes& view);

 private:
  // The view's rows in units of what is not known of them: B^-1 (G - J slope),
  // S = D + J covariance J^T = B B^T. With light: B^-1 J covariance.
  struct WhitenedRows {
    bool ok = false;
    RowMatrix by_parameters;  // [3 * bins][n]
    RowMatrix by_light;       // [3 * bins][3 * sources] or empty
  };
  WhitenedRows Whiten(const LogRadianceSlopes& view, bool with_light) const;
  // log det / 2 of what is left of an information when the nuisance is
  // integrated out.
  double HalfLogDet(const Eigen::MatrixXd& information) const;

  LinearPosterior all_;  // information: with the prior's
  int num_nuisance_;
  double half_log_det_ = 0.0;
};

}  // namespace ibrdf
