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
#include "ibrdf/solvers/estimation/marginal_search.h"
#include "ibrdf/solvers/estimation/scale_ambiguity.h"
#include "ibrdf/solvers/estimation/search_settings.h"
#include "ibrdf/solvers/priors/repeated_prior.h"
#include "ibrdf/solvers/problem/of_material.h"

namespace ibrdf {
namespace {

// Shares of the time that remains, at most: of the search for each material by
// itself, all together, and of the joint one.
constexpr double kAloneShare = 0.25;
constexpr double kJointShare = 0.55;
// Candidates of a material, and combinations that the joint search ranks.
constexpr size_t kOfLabel = 3;
constexpr size_t kCombinations = 30;
const std::vector<SearchStage> kAloneStages = {{6, 2}, {3, 5}};

// A material that may be one label's.
struct LabelCandidate {
  std::string name;
  double cost = 0.0;
  Eigen::VectorXd parameters;
  // Mean log radiance of the light that it implies; unset: none is known.
  std::optional<Eigen::Array3d> light_level;
};

// A material of each label.
struct Combination {
  double cost = 0.0;
  std::vector<LabelCandidate> materials;
};

LabelCandidate CentralMaterial(const SolveSetup& setup) {
  LabelCandidate out;
  const ReflectanceEstimate central = MeanMaterial(setup);
  out.name = central.initial_guess;
  out.parameters = ToEigen(central.lobes);
  return out;
}

// The best few materials of a label by itself; the most central one where its
// pixels tell of none.
std::vector<LabelCandidate> CandidatesOf(const SolveSetup& setup, int material,
                                         double share, SolveContext* context) {
  const InverseProblem alone = OfMaterial(*setup.problem, material);
  const StatusOr<SolveSetup> of_label = SetUp(alone);
  if (!of_label.ok()) return {CentralMaterial(setup)};
  ReflectanceSearchOptions o = CoarseSearchOptions(share, *of_label, context);
  o.coarse_stages.resize(kAloneStages.size());
  for (size_t k = 0; k < kAloneStages.size(); ++k) {
    o.coarse_stages[k].most = kAloneStages[k].most;
    o.coarse_stages[k].iterations =
        std::min(o.coarse_stages[k].iterations, kAloneStages[k].iterations);
  }
  LimitIterations(alone.solver.max_iterations, &o);
  o.report = [report = o.report, label = alone.materials.front().value](
                 const std::string& stage, double cost, double misfit) {
    report("label " + label + ": " + stage, cost, misfit);
  };
  const StatusOr<ReflectanceSearchResult> found =
      SearchReflectance({FlowLobes::Factory(*alone.model, setup.lobes->layout(),
                                            alone.num_threads),
                         &setup.materials},
                        alone.points, SearchedPixels(*of_label), o);
  if (!found.ok()) return {CentralMaterial(setup)};
  std::vector<LabelCandidate> out;
  for (const MaterialCandidate& c : found->candidates) {
    if (!std::isfinite(c.cost) || out.size() == kOfLabel) break;
    out.push_back({c.name, c.cost, ToEigen(c.parameters), c.light_level});
    VLOG(1) << "label " << alone.materials.front().value << ": " << c.name
            << ", cost " << c.cost << ", light at "
            << c.light_level.transpose();
  }
  return out;
}

// The combinations of lowest sums of costs, the best first.
std::vector<Combination> Combine(
    const std::vector<std::vector<LabelCandidate>>& candidates) {
  std::vector<Combination> best = {Combination()};
  for (const std::vector<LabelCandidate>& of_label : candidates) {
    std::vector<Combination> longer;
    for (const Combination& c : best) {
      for (const LabelCandidate& candidate : of_label) {
        Combination next = c;
        next.cost += candidate.cost;
        next.materials.push_back(candidate);
        longer.push_back(std::move(next));
      }
    }
    std::stable_sort(longer.begin(), longer.end(),
                     [](const Combination& a, const Combination& b) {
                       return a.cost < b.cost;
                     });
    longer.resize(std::min(longer.size(), kCombinations));
    best = std::move(longer);
  }
  return best;
}

// The parameters of all materials, their colours moved so that all see the mean
// of the lights that they imply.
Eigen::VectorXd InOneLight(const LobeModel& lobes,
                           const std::vector<LabelCandidate>& materials) {
  Eigen::Array3d sum = Eigen::Array3d::Zero();
  double count = 0.0;
  for (const LabelCandidate& m : materials) {
    if (!m.light_level) continue;
    sum += *m.light_level;
    count += 1.0;
  }
  const Eigen::Array3d level = sum / std::max(count, 1.0);
  const Eigen::Index size = lobes.num_parameters();
  Eigen::VectorXd all(size * static_cast<Eigen::Index>(materials.size()));
  Eigen::Index first = 0;
  for (const LabelCandidate& m : materials) {
    all.segment(first, size) = m.parameters;
    if (m.light_level) {
      lobes.Mixture(all.data() + first).ShiftColours(*m.light_level - level);
    }
    first += size;
  }
  return all;
}

std::string NameOf(const std::vector<LabelCandidate>& materials) {
  std::string name;
  for (const LabelCandidate& m : materials) {
    name += (name.empty() ? "" : " + ") + m.name;
  }
  return name;
}

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

ReflectanceEstimate OfLabel(const ReflectanceSearchResult& found, int material,
                            const std::vector<double>& parameters, size_t size,
                            const std::map<std::string, Combination>& by_name) {
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

}  // namespace

StatusOr<LabelledReflectance> EstimateLabelledReflectance(
    const SolveSetup& setup, SolveContext* context) {
  const InverseProblem& problem = *setup.problem;
  const int num_materials = static_cast<int>(problem.materials.size());
  std::vector<std::vector<LabelCandidate>> candidates;
  for (int m = 0; m < num_materials; ++m) {
    candidates.push_back(
        CandidatesOf(setup, m, kAloneShare / (num_materials - m), context));
  }
  MaterialPrior prior = RepeatPrior(setup.materials, num_materials);
  std::map<std::string, Combination> by_name;
  for (Combination& c : Combine(candidates)) {
    const std::string name = NameOf(c.materials);
    prior.materials.push_back({name, InOneLight(*setup.lobes, c.materials)});
    by_name[name] = std::move(c);
  }
  ReflectanceSearchOptions o = SearchOptions(kJointShare, setup, context);
  o.covariance = problem.solver.max_iterations > 0;
  o.num_materials = num_materials;
  const StatusOr<ReflectanceSearchResult> found = SearchReflectance(
      {FlowLobes::Factory(*problem.model, setup.lobes->layout(),
                          problem.num_threads),
       &prior, BounceGainOf(setup, o.fine)},
      problem.points, SearchedPixels(setup), o);
  if (!found.ok()) return found.status();
  LabelledReflectance out;
  std::vector<double> parameters = found->parameters;
  const LevelGauge gauge(*problem.model, setup.materials, problem.num_threads);
  out.light = LightOf(*found, FixLevel(gauge, num_materials, &parameters));
  const size_t size = setup.lobes->num_parameters();
  for (int m = 0; m < num_materials; ++m) {
    out.materials.push_back(OfLabel(*found, m, parameters, size, by_name));
  }
  return out;
}

}  // namespace ibrdf
