// The reflectance of highest posterior probability with the light integrated
// out: many materials cheaply, the best few refined, the best of those
// finished.
#pragma once
#include <Eigen/Core>
#include <functional>
#include <limits>
#include <string>
#include <vector>

#include "ibrdf/base/status.h"
#include "ibrdf/scene/scene.h"
#include "ibrdf/solvers/marginal/search_options.h"
#include "ibrdf/solvers/priors/material_prior.h"

namespace ibrdf {

// Light that the object throws on itself, of which the search knows nothing: by
// what each point's radiance [points][3] is above the map's light alone, at the
// lobes and the log radiance [3][H W] of an optimum (factors > 0; empty: not to
// be had). The image is divided by them and the optimum refined,
// bounce_iterations times. Where it settles the model explains the image with
// its own bounces; that the factors follow the lobes is left out of the
// covariance.
using BounceGain = std::function<std::vector<double>(
    const std::vector<double>& lobes, const std::vector<double>& log_radiance)>;

// A model that a search chooses a reflectance of.
struct SearchedModel {
  LobeFactory lobes;
  const MaterialPrior* prior = nullptr;  // of these lobes; must outlive it
  BounceGain bounce_gain = {};           // unset: it throws none
};

// A material and the local optimum that it led to, costs in nats.
struct MaterialCandidate {
  std::string name;
  double first_cost = 0.0;    // coarse
  double first_misfit = 0.0;  // mean |log L_o - log I| over bins
  // At the finest resolution that the search came to; infinite where this
  // candidate was dropped before.
  double cost = 0.0;
  std::vector<double> parameters;  // at the optimum
  // Mean log radiance of the light there, by channel; 0: not refined.
  Eigen::Array3d light_level = Eigen::Array3d::Zero();
  // At the first resolution, as the material is; infinite: none.
  double screen_cost = std::numeric_limits<double>::infinity();
};

// By cost: the refined ones, then the others by their first cost.
void SortByCost(std::vector<MaterialCandidate>* candidates);

// Where a material led at the coarse resolution, whether it went on or not.
struct CoarseOptimum {
  std::string name;  // of the material
  double cost = 0.0;
  std::vector<double> parameters;  // as LobeModel's
};

struct ReflectanceSearchResult {
  size_t model = 0;                // of the models that were searched
  std::vector<double> parameters;  // as LobeModel's
  std::string initial_guess;       // the material that it began from
  double cost = 0.0;               // -log posterior, nats, up to a constant
  double misfit = 0.0;             // mean |log L_o - log I| over bins
  LightHyperparameters hyperparameters;             // of the light's process
  std::vector<Eigen::Vector3d> directional_lights;  // their directions
  std::vector<MaterialCandidate> candidates;        // by SortByCost
  std::vector<CoarseOptimum> coarse_optima;         // by cost
  // The posterior of the parameters (Laplace, by the Gauss-Newton Hessian);
  // empty where it was not asked for.
  Eigen::MatrixXd covariance;
  // Most probable log radiance and its standard deviation given the
  // reflectance, [3][H W] of the resolution.
  int map_width = 0, map_height = 0;
  std::vector<double> log_radiance, log_radiance_std;
  // The share of its prior variance that is left, [3][H W] in [0, 1].
  std::vector<double> log_radiance_variance_left;
  // The same of its harmonics of degree l = 0, 1, ..., up to kLightDegrees or
  // half the map's rows: variances summed over m and channels.
  std::vector<double> variance_left_by_degree;
};

// Candidates of each model are found by themselves; at the finest resolution
// those of all models compete. The result of every model that has an optimum at
// the finest resolution reached, in the models' order; the covariance is of the
// best one's alone. kInvalidInput where no point can be used, kNoImprovement
// where no material explains the image.
StatusOr<std::vector<ReflectanceSearchResult>> SearchReflectances(
    const std::vector<SearchedModel>& models,
    const std::vector<ShadingPoint>& points, const Observations& observed,
    const ReflectanceSearchOptions& options);

// The same with one model.
StatusOr<ReflectanceSearchResult> SearchReflectance(
    const SearchedModel& model, const std::vector<ShadingPoint>& points,
    const Observations& observed, const ReflectanceSearchOptions& options);

}  // namespace ibrdf
