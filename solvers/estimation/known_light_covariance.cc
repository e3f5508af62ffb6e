#include "ibrdf/solvers/estimation/known_light_covariance.h"

#include <Eigen/Dense>
#include <algorithm>
#include <cmath>

#include "ibrdf/base/eigen_vectors.h"
#include "ibrdf/solvers/costs/log_radiance_cost.h"
#include "ibrdf/solvers/marginal/reflectance_search.h"

namespace ibrdf {
namespace {

// A joint estimate's bins across a disc of 16.
constexpr double kIndependent = 200.0;

// G^T D^-1 G of the data that count; clipped and black ones do not.
Eigen::MatrixXd DataInformation(const std::vector<double>& L_o,
                                const std::vector<double>& dL_o,
                                const Observations& observed,
                                const RobustLogLikelihood& likelihood,
                                double weight, Eigen::Index n) {
  Eigen::MatrixXd information = Eigen::MatrixXd::Zero(n, n);
  for (size_t i = 0; i < L_o.size(); ++i) {
    if (!observed.valid[i / 3] || observed.Interval(i).IsOneSided()) continue;
    const Eigen::Map<const Eigen::VectorXd> slope(
        dL_o.data() + i * static_cast<size_t>(n), n);
    const Eigen::VectorXd g =
        slope / (L_o[i] + likelihood.ambient[static_cast<int>(i % 3)] +
                 likelihood.epsilon);
    information.selfadjointView<Eigen::Lower>().rankUpdate(g, weight);
  }
  return information.selfadjointView<Eigen::Lower>();
}

}  // namespace

double IndependentShare(int num_points) {
  return std::min(1.0, kIndependent / num_points);
}

Eigen::MatrixXd KnownLightCovariance(const Transport& transport,
                                     const LobeModel& lobes,
                                     const MaterialPrior& prior,
                                     const std::vector<float>& map,
                                     const Observations& observed,
                                     const RobustLogLikelihood& likelihood,
                                     const std::vector<double>& parameters) {
  const auto n = static_cast<Eigen::Index>(parameters.size());
  std::vector<double> L_o, dL_o;
  if (observed.num_valid == 0 ||
      !RenderLobeModel(transport, lobes, parameters.data(), map.data(), &L_o,
                       &dL_o)) {
    return {};
  }
  const double model = ReflectanceSearchOptions().sigma;
  const double variance =
      2.0 * likelihood.scale * likelihood.scale + model * model;
  const double share = IndependentShare(observed.num_valid);
  Eigen::MatrixXd information =
      DataInformation(L_o, dL_o, observed, likelihood, share / variance, n);
  prior.AddWallInformation(ToEigen(parameters), &information);
  // With y = factor^-1 (x - mean), whose prior covariance is 1: well
  // conditioned where the image says nothing.
  const Eigen::MatrixXd factor =
      prior.factor.triangularView<Eigen::Lower>().toDenseMatrix();
  const Eigen::LLT<Eigen::MatrixXd> whitened(Eigen::MatrixXd::Identity(n, n) +
                                             factor.transpose() * information *
                                                 factor);
  if (whitened.info() != Eigen::Success) return {};
  const Eigen::MatrixXd half =
      whitened.matrixL().solve(factor.transpose().eval());
  Eigen::MatrixXd covariance = half.transpose() * half;
  if (!covariance.allFinite()) return {};
  return covariance;
}

}  // namespace ibrdf
