#include "ibrdf/solvers/estimation/label_candidates.h"

#include <glog/logging.h>

#include <algorithm>
#include <cmath>
#include <utility>

#include "ibrdf/base/eigen_vectors.h"
#include "ibrdf/brdf/flow_lobes.h"
#include "ibrdf/solvers/estimation/marginal_search.h"
#include "ibrdf/solvers/estimation/search_settings.h"
#include "ibrdf/solvers/marginal/reflectance_search.h"
#include "ibrdf/solvers/problem/of_material.h"

namespace ibrdf {
namespace {

constexpr size_t kOfLabel = 3;  // candidates

LabelCandidate CentralMaterial(const SolveSetup& setup) {
  LabelCandidate out;
  const ReflectanceEstimate central = MeanMaterial(setup);
  out.name = central.initial_guess;
  out.parameters = ToEigen(central.lobes);
  return out;
}

ReflectanceSearchOptions OptionsFor(const LabelSearch& search,
                                    const SolveSetup& of_label,
                                    SolveContext* context) {
  const InverseProblem& alone = *of_label.problem;
  ReflectanceSearchOptions o = CoarseSearchOptions(1.0, of_label, context);
  o.coarse_stages = search.stages;
  o.ranked_anew = search.ranked_anew;
  LimitIterations(alone.solver.max_iterations, &o);
  if (search.should_stop) o.should_stop = search.should_stop;
  if (search.quiet) {
    o.report = {};
    return o;
  }
  o.report = [report = o.report, label = alone.materials.front().value](
                 const std::string& stage, double cost, double misfit) {
    report("label " + label + ": " + stage, cost, misfit);
  };
  return o;
}

}  // namespace

std::string LabelCombination::Name() const {
  std::string name;
  for (const LabelCandidate& m : materials) {
    name += (name.empty() ? "" : " + ") + m.name;
  }
  return name;
}

Eigen::VectorXd LabelCombination::InOneLight(const LobeModel& lobes) const {
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

std::vector<LabelCandidate> FindLabelCandidates(const SolveSetup& setup,
                                                int material,
                                                const LabelSearch& search,
                                                SolveContext* context) {
  const InverseProblem alone = OfMaterial(*setup.problem, material);
  const StatusOr<SolveSetup> of_label = SetUp(alone);
  if (!of_label.ok()) return {CentralMaterial(setup)};
  const StatusOr<ReflectanceSearchResult> found =
      SearchReflectance({FlowLobes::Factory(*alone.model, setup.lobes->layout(),
                                            alone.num_threads),
                         &setup.materials},
                        alone.points, SearchedPixels(*of_label),
                        OptionsFor(search, *of_label, context));
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

std::vector<LabelCombination> Combine(
    const std::vector<std::vector<LabelCandidate>>& candidates, size_t most) {
  std::vector<LabelCombination> best = {LabelCombination()};
  for (const std::vector<LabelCandidate>& of_label : candidates) {
    std::vector<LabelCombination> longer;
    for (const LabelCombination& c : best) {
      for (const LabelCandidate& candidate : of_label) {
        LabelCombination next = c;
        next.cost += candidate.cost;
        next.materials.push_back(candidate);
        longer.push_back(std::move(next));
      }
    }
    std::stable_sort(longer.begin(), longer.end(),
                     [](const LabelCombination& a, const LabelCombination& b) {
                       return a.cost < b.cost;
                     });
    longer.resize(std::min(longer.size(), most));
    best = std::move(longer);
  }
  return best;
}

}  // namespace ibrdf
