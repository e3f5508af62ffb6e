// The reflectance of highest posterior probability with the light integrated
// out: many materials cheaply, the best few refined, the best of those
// finished.
#pragma once
#include <Eigen/Core>
#include <functional>
#include <limits>
#include <optional>
#include <string>
#include <vector>

#include "ibrdf/base/status.h"
#include "ibrdf/scene/scene.h"
#include "ibrdf/solvers/marginal/marginal_reflectance.h"
#include "ibrdf/solvers/priors/material_prior.h"

namespace ibrdf {

// The best so far, at most so many, go on by so many steps of the descent.
struct SearchStage {
  int most = 0;
  int iterations = 0;
};

struct ReflectanceSearchOptions {
  LightProcess process;
  // All materials are ranked at the first resolution, the best of them at the
  // second, where some are refined; the optimum is found at the third.
  MarginalResolution screen = {{8, 4, 0.2}, 16, 8, {48, 20, 12}};
  MarginalResolution coarse = {{12, 4, 0.2}, 24, 12, {48, 20, 12}};
  MarginalResolution fine = {{16, 4, 0.2}, 32, 16, {48, 20, 12}, {}};
  int kept = 10;  // of each ranking
  // At the coarse resolution, the best of each going on to the next. The first
  // takes the rankings' best in turns.
  std::vector<SearchStage> coarse_stages = {{10, 2}, {8, 4}, {3, 6}};
  // Nats above the lowest cost: candidates of the coarse resolution that go on
  // to the fine one, and of those, after some steps there, the ones that are
  // finished.
  double coarse_margin = 40.0;
  double margin = 12.0;
  int fine_iterations = 20;
  // Where directional lights are that the caller knows of: unit directions.
  std::vector<Eigen::Vector3d> directional_lights;
  // With those that the image's highlights make beside them
  // (FindDirectionalLights).
  int most_directional_lights = 3;
  // Standard deviation of log radiance between model and image, of a bin. Not
  // the pixels' noise, which a bin averages out, but what no lobes of the
  // model can render: were it free to fall to the noise, light and reflectance
  // would bend to every error of the model.
  double sigma = 0.03;
  // The points have so many. Lobes, prior and results hold as many lobes for
  // each, one material's after the other's.
  int num_materials = 1;
  // The prior of albedo that varies over the surface; unset: it does not.
  std::optional<PaintPrior> paint;
  bool covariance = true;
  int num_threads = 0;
  // Light that the object throws on itself, of which the search knows nothing:
  // by what each point's radiance [points][3] is above the map's light alone,
  // at the lobes and the log radiance [3][H W] of an optimum (factors > 0;
  // empty: not to be had). The image is divided by them and the optimum
  // refined, so many times. Where it settles the model explains the image with
  // its own bounces; that the factors follow the lobes is left out of the
  // covariance.
  std::function<std::vector<double>(const std::vector<double>& lobes,
                                    const std::vector<double>& log_radiance)>
      bounce_gain;
  int bounce_iterations = 3;
  // Checked between steps, by several threads; true ends early with the best so
  // far.
  std::function<bool()> should_stop;
  // After each material refined and the last optimum; may be empty.
  std::function<void(const std::string& stage, double cost, double misfit)>
      report;
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

struct ReflectanceSearchResult {
  std::vector<double> parameters;  // as LobeModel's
  std::string initial_guess;       // the material that it began from
  double cost = 0.0;               // -log posterior, nats, up to a constant
  double misfit = 0.0;             // mean |log L_o - log I| over bins
  LightHyperparameters hyperparameters;             // of the light's process
  std::vector<Eigen::Vector3d> directional_lights;  // their directions
  // By cost: the refined ones, then the others by their first cost.
  std::vector<MaterialCandidate> candidates;
  // The posterior of the parameters (Laplace, by the Gauss-Newton Hessian);
  // empty where it was not asked for.
  Eigen::MatrixXd covariance;
  // Most probable log radiance and its standard deviation given the
  // reflectance, [3][H W] of the resolution.
  int map_width = 0, map_height = 0;
  std::vector<double> log_radiance, log_radiance_std;
  // The share of its prior variance that is left, [3][H W] in [0, 1].
  std::vector<double> log_radiance_variance_left;
};

// kInvalidInput where no point can be used. prior: of these lobes.
StatusOr<ReflectanceSearchResult> SearchReflectance(
    const LobeFactory& lobes, const MaterialPrior& prior,
    const std::vector<ShadingPoint>& points, const Observations& observed,
    const ReflectanceSearchOptions& options);

}  // namespace ibrdf
