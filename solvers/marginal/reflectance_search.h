// The reflectance of highest posterior probability with the light integrated
// out: many materials cheaply, the best few refined, the best of those
// finished.
#pragma once
#include <Eigen/Core>
#include <functional>
#include <string>
#include <vector>

#include "ibrdf/base/status.h"
#include "ibrdf/render/scene.h"
#include "solvers/marginal/marginal_reflectance.h"
#include "solvers/material_prior.h"

namespace ibrdf {

struct ReflectanceSearchOptions {
  LightProcess process;
  // All materials are ranked at the first resolution, the best of them at the
  // second, where some are refined; the end is found at the third.
  MarginalResolution screen = {{8, 4, 0.2}, 16, 8, {48, 20, 12}};
  MarginalResolution coarse = {{12, 4, 0.2}, 24, 12, {48, 20, 12}};
  MarginalResolution fine = {{16, 4, 0.2}, 32, 16, {48, 20, 12}, 20, 56};
  int kept = 20;
  int starts = 4;              // that are refined at the coarse resolution
  int coarse_iterations = 12;  // each start
  // Of those, at most so many are finished at the fine resolution: the ones
  // whose costs there come within the margin, nats, of the lowest. Costs of two
  // ends differ by some ten nats from one resolution to the next.
  int finalists = 3;
  double margin = 12.0;
  int fine_iterations = 20;
  // Standard deviation of log radiance between model and image, of a cell. Not
  // the pixels' noise, which a cell averages out, but what no lobes of the
  // model can render: were it free to fall to the noise, light and reflectance
  // would bend to every error of the model.
  double sigma = 0.03;
  bool covariance = true;
  int num_threads = 0;
  // Light that the object throws on itself, of which the search knows nothing:
  // by what each point's radiance [points][3] is above the map's light alone,
  // at the lobes and the log radiance [3][H W] of an end (factors > 0; empty:
  // not to be had). The image is divided by them and the end refined, so many
  // times. Where it settles the model explains the image with its own bounces;
  // that the factors follow the lobes is left out of the covariance.
  std::function<std::vector<double>(const std::vector<double>& lobes,
                                    const std::vector<double>& log_radiance)>
      bounce_gain;
  int bounce_rounds = 3;
  // Checked between steps, by several threads; true ends early with the best so
  // far.
  std::function<bool()> should_stop;
  // After each material refined and the end; may be empty.
  std::function<void(const std::string& stage, double cost, double misfit)>
      report;
};

// A start and where it led, costs in nats.
struct TriedMaterial {
  std::string name;
  double first_cost = 0.0;    // coarse
  double first_misfit = 0.0;  // mean |log E - log I| over cells
  // At the finest resolution that the search came to; infinite where this start
  // did not come to it.
  double cost = 0.0;
  std::vector<double> parameters;  // at the end
};

struct ReflectanceSearchResult {
  std::vector<double> parameters;  // as LobeModel's
  std::string start;               // the material that it began from
  double cost = 0.0;               // -log posterior, nats, up to a constant
  double misfit = 0.0;             // mean |log E - log I| over cells
  LightScales scales;              // of the light's process
  // By cost: the refined ones, then the others by their first cost.
  std::vector<TriedMaterial> tried;
  // Of the parameters (Laplace, by the Gauss-Newton Hessian); empty where it
  // was not asked for.
  Eigen::MatrixXd covariance;
  // Most probable log radiance and its standard deviation given the
  // reflectance, [3][H W] of the resolution.
  int map_width = 0, map_height = 0;
  std::vector<double> log_radiance, log_radiance_std;
};

// kInvalidInput where no point can be used. radiance [points][3].
StatusOr<ReflectanceSearchResult> SearchReflectance(
    const NeuralBrdfModel& model, const MaterialPrior& prior,
    const std::vector<ShadingPoint>& points,
    const std::vector<double>& radiance,
    const ReflectanceSearchOptions& options);

}  // namespace ibrdf
