// The posterior of reflectance and light at the pixels of an observation (Chen
// et al. 2020, Eq. 1), as the stages of a solve evaluate it.
#pragma once
#include <Eigen/Core>
#include <limits>
#include <memory>
#include <string>
#include <vector>

#include "ibrdf/light/log_map.h"
#include "ibrdf/solvers/estimation/material_ranking.h"
#include "ibrdf/solvers/estimation/solution.h"
#include "ibrdf/solvers/estimation/solve_context.h"
#include "ibrdf/solvers/estimation/solve_setup.h"
#include "ibrdf/solvers/joint/joint_objective.h"
#include "ibrdf/solvers/marginal/reflectance_search.h"
#include "ibrdf/solvers/priors/directional_lights.h"
#include "ibrdf/solvers/priors/light_prior.h"
#include "ibrdf/solvers/priors/light_process.h"

namespace ibrdf {

// What integrating the light out says of it.
struct LightPosterior {
  LightHyperparameters hyperparameters = LightHyperparameters::Average();
  std::vector<Eigen::Vector3d> directional_lights;  // unit, towards the light
  // MAP estimate of log radiance and its standard deviation given the
  // reflectance, both at the resolution of the search; empty where there was
  // none.
  LogMap mode;
  Image log_std;
  // The share of the prior's variance that is left, in [0, 1].
  Image variance_left;
  // The same of its harmonics of degree l = 0, 1, ...
  std::vector<double> variance_left_by_degree;
};

// Priors of the light, centred at a constant map.
struct LightPriors {
  std::vector<float> mean;  // of the light's parameters
  std::vector<std::unique_ptr<LightPrior>> on_map;
};

// The unknown light as a stage has it.
struct LightModel {
  std::unique_ptr<IlluminationModel> map;  // null: the light is known
  // The Gaussian process is a prior of the map beside the parameters' own. (A
  // map that is the process's own output has it in its parameters.)
  bool has_process_prior = false;
  LightPriors priors;
  // Log radiance by channel of the constant map that gives the image its level.
  Eigen::Array3d level = Eigen::Array3d::Zero();
};

// Reflectance and light between two stages.
struct Iterate {
  JointState state;
  LightModel light;    // what state.light are the parameters of
  double scale = 0.0;  // b of the likelihood, which scale continuation lowers
  Eigen::Array3d ambient = Eigen::Array3d::Zero();  // stray light, radiance
};

// The reflectance as a search leaves it.
struct ReflectanceEstimate {
  std::vector<double> lobes;  // as LobeModel; empty where it is known
  // How far the local optima are whose mean the lobes are: root mean square of
  // the log-RMSE, aligned where the light is unknown, by their weights. 0: it
  // is one optimum.
  double between_optima = 0.0;
  // As MaterialSolution's.
  double structured_misfit = std::numeric_limits<double>::quiet_NaN();
  // The material whose candidate became the estimate, and its lobes.
  std::string initial_guess;
  std::vector<double> initial_lobes;
  Eigen::MatrixXd covariance;                 // of the lobes; empty: not known
  std::vector<MaterialCandidate> candidates;  // by cost
  std::vector<CoarseOptimum> coarse_optima;   // likewise, of the light unknown
  MaterialRanking ranking;  // of the light unknown; else empty
  LightPosterior light;
};

// What `no_improvement` is judged by: an initial guess of the reflectance under
// the constant map that gives its image the right level, with the light's
// priors centred there.
struct Reference {
  JointState state;
  LightPriors priors;
  Eigen::Array3d ambient = Eigen::Array3d::Zero();
};

// What the stages of a solve hand to its summary.
struct Estimate {
  Iterate iterate;
  Reference reference;
  ReflectanceEstimate reflectance;
  std::unique_ptr<ObservedPixels> pixels;  // that the iterate was found from
};

// The map that the parameters of an iterate's unknown light make.
LogMap LogMapOf(const Iterate& iterate);

// The map of the iterate's model, or the problem's where the light is known.
MapSize SizeOf(const LightModel& light, const SolveSetup& setup);

// A model whose priors are centred at radiance 1.
LightModel MakeLightModel(std::unique_ptr<IlluminationModel> map,
                          bool has_process_prior);

// The model's priors centred at the constant map of log radiance `level`.
LightPriors PriorsAt(const Eigen::Array3d& level, const LightModel& light,
                     const LightPosterior& posterior);

// Log radiance by channel of the constant map under which these lobes (any,
// where they are known) give the pixels' mean log radiance.
Eigen::Array3d MatchedLevel(const std::vector<double>& lobes,
                            const LightModel& light, const SolveSetup& setup,
                            ObservedPixels* pixels);

// The estimate begins anew with another model of the light: a constant map at
// the level that the lobes at hand ask for, where its priors are centred.
void BeginLight(LightModel light, const SolveSetup& setup, Estimate* estimate);
// The same at the level of the estimate's last model.
void BeginLightAtLevel(LightModel light, Estimate* estimate);

// The initial lobes under a constant map at their own level, which the result
// is held against, for the estimate's present model of the light.
void SetReference(const SolveSetup& setup, Estimate* estimate);

// The objective on some pixels. It must not outlive what it was made from, nor
// a change of the iterate's light, priors or scale.
struct PosteriorObjective {
  std::unique_ptr<LightOperator> known_brdf;
  std::unique_ptr<JointObjective> objective;
};
PosteriorObjective ObjectiveOn(ObservedPixels* pixels, const SolveSetup& setup,
                               const LightModel& light,
                               const LightPriors& priors, double scale);

// The prior of the reflectance is that of the materials, as in the searches;
// where the light is unknown, at the level that suits it best, as the scale
// ambiguity and not the prior says where the level is. The joint maximum has
// the paper's.
TraceEntry MakeEntry(const std::string& stage, const SolveSetup& setup,
                     const SolveContext& context, int num_pixels, double scale,
                     const JointState& state, const JointCost& cost);

// The cost of an iterate at some pixels.
TraceEntry Evaluate(const std::string& stage, const SolveSetup& setup,
                    const SolveContext& context, const Iterate& iterate,
                    ObservedPixels* pixels);

RobustLogLikelihood LikelihoodOf(
    const SolveSetup& setup, double scale,
    const Eigen::Array3d& ambient = Eigen::Array3d::Zero());

}  // namespace ibrdf
