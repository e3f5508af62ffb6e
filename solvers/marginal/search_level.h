// A search for the reflectance at one resolution.
#pragma once
#include <Eigen/Core>
#include <array>
#include <limits>
#include <vector>

#include "ibrdf/scene/scene.h"
#include "ibrdf/solvers/marginal/marginal_objective.h"
#include "ibrdf/solvers/marginal/marginal_reflectance.h"
#include "ibrdf/solvers/marginal/search_options.h"
#include "ibrdf/solvers/priors/material_prior.h"

namespace ibrdf {

// Where a refinement ended.
struct LocalOptimum {
  bool ok = false;
  std::vector<double> y;  // as MarginalObjective's
  double cost = std::numeric_limits<double>::infinity();
  MarginalValue value;
  LightMode mode;
  DataErrors errors;
};

// A reflectance as a ranking uses it, whatever the light.
struct TabulatedReflectance {
  Eigen::VectorXd parameters;  // MarginalReflectance's
  std::array<RowMatrix, 3> matrices, matte_matrices;
};

// What ranks materials by the marginal posterior and refines them. Immutable;
// may be used from several threads.
class SearchLevel {
 public:
  // prior (of these lobes) and options must outlive it.
  SearchLevel(const LobeFactory& lobes, const MaterialPrior& prior,
              const std::vector<ShadingPoint>& points,
              const Observations& observed,
              const MarginalResolution& resolution,
              const std::vector<Eigen::Vector3d>& directional_lights,
              const ReflectanceSearchOptions& options);

  const MarginalReflectance& reflectance() const { return reflectance_; }

  // `mode` must outlive the objective.
  MarginalObjective Objective(const DataErrors& errors, LightMode* mode) const {
    return MarginalObjective(&reflectance_, &prior_, errors, mode);
  }

  TabulatedReflectance Tabulate(const Eigen::VectorXd& parameters) const;

  // -log posterior of a reflectance of this level at these hyperparameters of
  // light and this deviation of bins; infinite, and `misfit` as it was, where
  // it has none. That directional lights are moved costs nothing here.
  double Rank(const TabulatedReflectance& reflectance,
              const LightHyperparameters& hyperparameters, double sigma,
              double* misfit) const;

  LocalOptimum Refine(const Eigen::VectorXd& parameters,
                      const LightHyperparameters& hyperparameters, double sigma,
                      int iterations) const;

  // Mean log radiance of a mode's light, by channel.
  Eigen::Array3d LightLevel(const Eigen::VectorXd& parameters,
                            const LightMode& mode) const;

  // Laplace's covariance of the lobe parameters, by the Gauss-Newton Hessian;
  // empty where there is none.
  Eigen::MatrixXd Covariance(LocalOptimum* optimum) const;

 private:
  // Whether the object is painted and a reflectance would hardly show it.
  bool HidesPaint(const DataErrors& errors) const;

  const MaterialPrior& prior_;
  const ReflectanceSearchOptions& options_;
  MarginalReflectance reflectance_;
};

}  // namespace ibrdf
