#include "ibrdf/solvers/estimation/labelled_search.h"

#include <glog/logging.h>

#include <algorithm>
#include <cmath>
#include <map>
#include <optional>
#include <string>
#include <utility>

#include "ibrdf/base/eigen_vectors.h"
#include "ibrdf/brdf/flow_lobes.h"
#include "ibrdf/solvers/estimation/label_candidates.h"
#include "ibrdf/solvers/estimation/scale_ambiguity.h"
#include "ibrdf/solvers/estimation/search_settings.h"
#include "ibrdf/solvers/priors/repeated_prior.h"

namespace ibrdf {
namespace {

// Shares of the time that remains, at most: of the search for each material by
// itself, all together, and of the joint one.
constexpr double kAloneShare = 0.25;
constexpr double kJointShare = 0.55;
constexpr size_t kCombinations = 30;  // that the joint search ranks

// Log colours of all lobes move by what brings the materials' mean levels to
// the gauge's; returns that.
double FixLevel(const LevelGauge& gauge, int num_materials,
                std::vector<double>* parameters) {
  const size_t size = parameters->size() / num_materials;
  std::vector<double> fixed = *parameters;
  double level = 0.0;
  for (int m = 0; m < num_materials; ++m) {
    level += gauge.Fix(&fixed[m * size]) / num_materials;
  }
  gauge.Shift(level, num_materials, parameters->data());
  return level;
}

// A material's part of a vector [materials][size].
std::vector<double> PartOf(const std::vector<double>& all, int material,
                           size_t size) {
  const auto first = all.begin() + static_cast<std::ptrdiff_t>(material * size);
  return {first, first + static_cast<std::ptrdiff_t>(size)};
}

ReflectanceEstimate OfLabel(
    const ReflectanceSearchResult& found, int material,
    const std::vector<double>& parameters, size_t size,
    const std::map<std::string, LabelCombination>& by_name) {
  ReflectanceEstimate out;
  out.lobes = PartOf(parameters, material, size);
  const LabelCandidate& initial =
      by_name.at(found.initial_guess).materials[material];
  out.initial_guess = initial.name;
  out.initial_lobes = ToVector(initial.parameters);
  const auto n = static_cast<Eigen::Index>(size);
  if (found.covariance.size() > 0) {
    out.covariance = found.covariance.block(material * n, material * n, n, n);
  }
  for (const MaterialCandidate& c : found.candidates) {
    if (!std::isfinite(c.cost)) continue;
    MaterialCandidate of_label = c;
    of_label.name = by_name.at(c.name).materials[material].name;
    of_label.parameters = PartOf(c.parameters, material, size);
    out.candidates.push_back(std::move(of_label));
  }
  return out;
}

// What the joint search begins from.
struct JointPrior {
  MaterialPrior prior;  // its materials: combinations
  std::map<std::string, LabelCombination> by_name;
};

JointPrior PriorOfAll(const SolveSetup& setup, SolveContext* context) {
  const int num_materials = static_cast<int>(setup.problem->materials.size());
  std::vector<std::vector<LabelCandidate>> candidates;
  for (int m = 0; m < num_materials; ++m) {
    LabelSearch search;
    search.should_stop = context->StopAfter(kAloneShare / (num_materials - m));
    candidates.push_back(FindLabelCandidates(setup, m, search, context));
  }
  JointPrior joint{RepeatPrior(setup.materials, num_materials), {}};
  for (LabelCombination& c : Combine(candidates, kCombinations)) {
    const std::string name = c.Name();
    joint.prior.materials.push_back({name, c.InOneLight(*setup.lobes)});
    joint.by_name[name] = std::move(c);
  }
  return joint;
}

}  // namespace

StatusOr<LabelledReflectance> EstimateLabelledReflectance(
    const SolveSetup& setup, SolveContext* context) {
  const InverseProblem& problem = *setup.problem;
  const int num_materials = static_cast<int>(problem.materials.size());
  const JointPrior joint = PriorOfAll(setup, context);
  ReflectanceSearchOptions o = SearchOptions(kJointShare, setup, context);
  o.covariance = problem.solver.max_iterations > 0;
  o.num_materials = num_materials;
  const StatusOr<ReflectanceSearchResult> found = SearchReflectance(
      {FlowLobes::Factory(*problem.model, setup.lobes->layout(),
                          problem.num_threads),
       &joint.prior, BounceGainOf(setup, o.fine)},
      problem.points, SearchedPixels(setup), o);
  if (!found.ok()) return found.status();
  LabelledReflectance out;
  std::vector<double> parameters = found->parameters;
  const LevelGauge gauge(*problem.model, setup.materials, problem.num_threads);
  out.light = LightOf(*found, FixLevel(gauge, num_materials, &parameters));
  const size_t size = setup.lobes->num_parameters();
  for (int m = 0; m < num_materials; ++m) {
    out.materials.push_back(
        OfLabel(*found, m, parameters, size, joint.by_name));
  }
  return out;
}

}  // namespace ibrdf
