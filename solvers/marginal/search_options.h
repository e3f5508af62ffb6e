// What a search for the reflectance is told beside the image.
#pragma once
#include <Eigen/Core>
#include <functional>
#include <optional>
#include <string>
#include <vector>

#include "ibrdf/solvers/marginal/marginal_reflectance.h"
#include "ibrdf/solvers/priors/albedo_prior.h"
#include "ibrdf/solvers/priors/light_process.h"

namespace ibrdf {

// The best so far, at most so many, go on by so many steps of the descent. The
// deviation of bins is so many times ReflectanceSearchOptions::sigma.
struct SearchStage {
  int most = 0;
  int iterations = 0;
  double tolerance = 1.0;
};

struct ReflectanceSearchOptions {
  LightProcess process;
  // All materials are ranked at the first resolution, the best of them at the
  // second, where some are refined; the optimum is found at the third.
  MarginalResolution screen = {{8, 4, 0.2}, 16, 8, {48, 20, 12}};
  MarginalResolution coarse = {{12, 4, 0.2}, 24, 12, {48, 20, 12}};
  MarginalResolution fine = {{16, 4, 0.2}, 32, 16, {48, 20, 12}, {}};
  int kept = 10;  // of each ranking
  // Materials are ranked with these multiples of sigma as the deviation of
  // bins.
  std::vector<double> ranking_tolerances = {1.0};
  // At the coarse resolution, the best of each going on to the next. The first
  // takes the rankings' best in turns.
  std::vector<SearchStage> coarse_stages = {{10, 2}, {8, 4}, {3, 6}};
  // So many more join before the second stage: the best of a ranking under the
  // light of the first stage's best.
  int ranked_anew = 4;
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
  // Rounds of SearchedModel::bounce_gain.
  int bounce_iterations = 3;
  // Checked between steps, by several threads; true ends early with the best so
  // far.
  std::function<bool()> should_stop;
  // After each material refined and the last optimum; may be empty.
  std::function<void(const std::string& stage, double cost, double misfit)>
      report;

  bool Stopped() const { return should_stop && should_stop(); }
};

}  // namespace ibrdf
