#include "solvers/illumination_solver.h"

#include <optional>

#include "solvers/joint/edge_prior.h"
#include "solvers/joint/joint_method.h"

namespace ibrdf {
namespace {

// The objective of a known BRDF, with the prior that it points to.
class LightObjective {
 public:
  LightObjective(const LightOperator& light, const Observations& observed,
                 const IlluminationStepOptions& options,
                 const std::vector<float>& prior_mean,
                 IlluminationModel* model) {
    JointTerms terms;
    terms.observed = &observed;
    terms.likelihood = options.likelihood;
    terms.known_brdf = &light;
    terms.illumination = model;
    terms.light_mean = prior_mean;
    terms.light_sigma = options.prior.weight_sigma;
    if (options.prior.edge_scale > 0.0) {
      edges_.emplace(model->height(), model->width(), options.prior.edge_scale,
                     options.prior.edge_delta);
      terms.light_priors.push_back(&*edges_);
    }
    objective_.emplace(std::move(terms));
  }
  JointObjective* get() { return &*objective_; }

 private:
  std::optional<EdgePrior> edges_;
  std::optional<JointObjective> objective_;
};

IlluminationCost Terms(const JointCost& cost) {
  return {cost.likelihood, cost.illumination_prior};
}

}  // namespace

IlluminationCost EvaluateIllumination(
    const LightOperator& light, const Observations& observed,
    const IlluminationStepOptions& options,
    const std::vector<float>& prior_mean, const float* parameters,
    IlluminationModel* model, std::vector<double>* E, std::vector<float>* map) {
  LightObjective objective(light, observed, options, prior_mean, model);
  JointState state;
  state.light.assign(parameters, parameters + model->num_parameters());
  const JointCost cost = objective.get()->Evaluate(state);
  if (E != nullptr) *E = objective.get()->radiance();
  if (map != nullptr) *map = objective.get()->map();
  return Terms(cost);
}

IlluminationCost SolveIllumination(const LightOperator& light,
                                   const Observations& observed,
                                   const IlluminationStepOptions& options,
                                   const std::vector<float>& prior_mean,
                                   IlluminationModel* model,
                                   std::vector<float>* parameters) {
  LightObjective objective(light, observed, options, prior_mean, model);
  JointMethodOptions o;
  o.max_iterations = options.max_iterations;
  o.max_cg_iterations = options.max_cg_iterations;
  o.tolerance = options.tolerance;
  o.should_stop = options.should_stop;
  JointState state;
  state.light = *parameters;
  const JointSummary summary = MinimiseJoint(
      options.lbfgs ? JointMethod::kLbfgs : JointMethod::kGaussNewton,
      objective.get(), &state, o);
  *parameters = std::move(state.light);
  return Terms(summary.end);
}

}  // namespace ibrdf
