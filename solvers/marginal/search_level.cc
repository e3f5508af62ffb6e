#include "ibrdf/solvers/marginal/search_level.h"

#include <glog/logging.h>

#include <Eigen/Dense>
#include <array>

#include "ibrdf/base/eigen_vectors.h"
#include "ibrdf/light/log_map.h"
#include "ibrdf/solvers/marginal/marginal_descent.h"
#include "ibrdf/solvers/optim/conditioning.h"

namespace ibrdf {
namespace {

// A ranking finds modes to so many nats; materials differ by tens.
constexpr double kRankingTolerance = 0.5;

}  // namespace

SearchLevel::SearchLevel(const LobeFactory& lobes, const MaterialPrior& prior,
                         const std::vector<ShadingPoint>& points,
                         const Observations& observed,
                         const MarginalResolution& resolution,
                         const std::vector<Eigen::Vector3d>& directional_lights,
                         const ReflectanceSearchOptions& options)
    : prior_(prior),
      options_(options),
      reflectance_(lobes, points, observed, options.process, resolution,
                   options.num_threads, directional_lights, options.paint,
                   options.num_materials) {}

TabulatedReflectance SearchLevel::Tabulate(
    const Eigen::VectorXd& parameters) const {
  return {parameters, reflectance_.Matrices(parameters.data()),
          reflectance_.MatteMatrices(parameters.data())};
}

double SearchLevel::Rank(const TabulatedReflectance& reflectance,
                         const LightHyperparameters& hyperparameters,
                         double sigma, double* misfit) const {
  LightMode mode;
  const MarginalLikelihood& likelihood = reflectance_.likelihood();
  const DataErrors errors =
      likelihood.FindErrors(reflectance.matrices, reflectance.matte_matrices,
                            sigma, hyperparameters, kRankingTolerance, &mode);
  const MarginalValue value =
      likelihood.Evaluate(reflectance.matrices, errors, hyperparameters,
                          kRankingTolerance, &mode, nullptr);
  if (!value.ok) return std::numeric_limits<double>::infinity();
  if (HidesPaint(errors)) return std::numeric_limits<double>::infinity();
  *misfit = value.misfit;
  double of_hyperparameters = 0.0;
  for (const double y : hyperparameters.Whitened())
    of_hyperparameters += 0.5 * y * y;
  return value.cost +
         prior_.Cost(reflectance.parameters.head(prior_.num_parameters()),
                     nullptr) +
         of_hyperparameters;
}

LocalOptimum SearchLevel::Refine(const Eigen::VectorXd& parameters,
                                 const LightHyperparameters& hyperparameters,
                                 double sigma, int iterations) const {
  LocalOptimum optimum;
  optimum.errors = reflectance_.likelihood().FindErrors(
      reflectance_.Matrices(parameters.data()),
      reflectance_.MatteMatrices(parameters.data()), sigma, hyperparameters,
      MarginalObjective::kModeTolerance, &optimum.mode);
  const MarginalObjective objective = Objective(optimum.errors, &optimum.mode);
  optimum.y = objective.Whitened(parameters, hyperparameters);
  MarginalDescentOptions o;
  o.max_iterations = iterations;
  o.should_stop = options_.should_stop;
  const MarginalDescent descent = Descend(objective, o, &optimum.y);
  optimum.ok = descent.ok && !HidesPaint(optimum.errors);
  optimum.cost = descent.cost;
  optimum.value = objective.last_value();
  return optimum;
}

Eigen::Array3d SearchLevel::LightLevel(const Eigen::VectorXd& parameters,
                                       const LightMode& mode) const {
  const std::vector<double> log_radiance =
      reflectance_.LogRadiance(parameters.data(), mode);
  const MarginalResolution& r = reflectance_.resolution();
  return LogMap({r.map_width, r.map_height},
                {log_radiance.begin(), log_radiance.end()})
      .Mean();
}

Eigen::MatrixXd SearchLevel::Covariance(LocalOptimum* optimum) const {
  const Eigen::MatrixXd information =
      Objective(optimum->errors, &optimum->mode).Information(optimum->y.data());
  if (information.size() == 0) return {};
  VLOG(1) << "marginal posterior: condition of the information, scaled, "
          << ScaledCondition(information);
  const Eigen::Index n = information.rows();
  const Eigen::MatrixXd inverse =
      information.llt().solve(Eigen::MatrixXd::Identity(n, n));
  const Eigen::MatrixXd factor = prior_.factor.triangularView<Eigen::Lower>();
  return factor * inverse.topLeftCorner(factor.rows(), factor.rows()) *
         factor.transpose();
}

bool SearchLevel::HidesPaint(const DataErrors& errors) const {
  return options_.paint &&
         errors.matte_share.mean() < options_.paint->least_matte_share;
}

}  // namespace ibrdf
