#include "ibrdf/solvers/estimation/label_evidence.h"

#include <glog/logging.h>

#include <Eigen/Cholesky>
#include <string>
#include <unordered_map>
#include <utility>

#include "ibrdf/base/eigen_vectors.h"
#include "ibrdf/brdf/flow_lobes.h"
#include "ibrdf/solvers/estimation/search_settings.h"
#include "ibrdf/solvers/marginal/reflectance_search.h"
#include "ibrdf/solvers/priors/repeated_prior.h"
#include "ibrdf/solvers/problem/with_labels.h"

namespace ibrdf {
namespace {

// Parts of a smaller share of the points are left out of a comparison.
constexpr double kLeastPart = 0.02;
constexpr size_t kMostStarts = 12;
// Searches are shorter than those of an estimate, and bins wider: parts make
// more of them.
constexpr int kScreenBins = 6, kBins = 8;  // across
// The bins' deviation (ReflectanceSearchOptions::sigma), twice that of
// estimates: light that these bins do not resolve is not to look like a
// material.
constexpr double kSigma = 0.06;
const std::vector<SearchStage> kAloneStages = {{4, 2}, {2, 4}};
const std::vector<SearchStage> kTogetherStages = {{4, 2}, {2, 8}};

// Which labels each point has in all labellings, as a number from 0.
std::vector<int> IntersectionOf(
    const std::vector<ComparedLabelling>& labellings) {
  const size_t num_points = labellings.front().labels.size();
  std::map<std::vector<int>, int> number;
  std::vector<int> part;
  for (size_t i = 0; i < num_points; ++i) {
    std::vector<int> labels;
    for (const ComparedLabelling& l : labellings) labels.push_back(l.labels[i]);
    const int next = static_cast<int>(number.size());
    part.push_back(number.emplace(std::move(labels), next).first->second);
  }
  return part;
}

// Sets -1 where a pixel beside a point's is of another part: it may show both,
// and where labellings differ by a seam one of them has it wrong.
void LeaveSeamsOut(const InverseProblem& problem, std::vector<int>* part) {
  const std::vector<bool> beside =
      BesideOtherLabels(problem.points, problem.image.width, *part);
  for (size_t i = 0; i < part->size(); ++i) {
    if (beside[i]) (*part)[i] = -1;
  }
}

// Sets -1 where a part has few points.
void LeaveSmallOut(std::vector<int>* part) {
  std::unordered_map<int, double> size;
  for (const int p : *part) size[p] += 1.0;
  const double least = kLeastPart * static_cast<double>(part->size());
  for (int& p : *part) {
    if (size[p] < least) p = -1;
  }
}

// The problem of the points that have a part.
InverseProblem InParts(InverseProblem problem, const std::vector<int>& part) {
  std::vector<ShadingPoint> kept;
  for (size_t i = 0; i < part.size(); ++i) {
    if (part[i] < 0) continue;
    kept.push_back(problem.points[i]);
    kept.back().part = part[i];
  }
  problem.points = std::move(kept);
  return problem;
}

// For each label of one labelling, the lobes of the other's label that it
// shares most points with.
Eigen::VectorXd Inherit(const ComparedLabelling& from,
                        const ComparedLabelling& to) {
  Eigen::MatrixXi shared = Eigen::MatrixXi::Zero(to.count, from.count);
  for (size_t i = 0; i < to.labels.size(); ++i) {
    ++shared(to.labels[i], from.labels[i]);
  }
  const Eigen::Index size = from.lobes.size() / from.count;
  Eigen::VectorXd lobes(size * to.count);
  for (int m = 0; m < to.count; ++m) {
    Eigen::Index parent;
    shared.row(m).maxCoeff(&parent);
    lobes.segment(m * size, size) = from.lobes.segment(parent * size, size);
  }
  return lobes;
}

// The log of the share of the prior's volume that the posterior has.
double LogVolume(const Eigen::MatrixXd& covariance,
                 const MaterialPrior& prior) {
  const Eigen::MatrixXd root = covariance.llt().matrixL();
  return root.diagonal().array().log().sum() -
         prior.factor.diagonal().array().abs().log().sum();
}

}  // namespace

LabelEvidence::LabelEvidence(const InverseProblem& problem,
                             std::function<bool()> should_stop,
                             SolveContext* context)
    : problem_(problem),
      should_stop_(std::move(should_stop)),
      context_(context) {}

std::vector<LabelCandidate> LabelEvidence::CandidatesOf(const SolveSetup& setup,
                                                        int material) {
  std::vector<int> pixels;
  for (const ShadingPoint& point : setup.problem->points) {
    if (point.material == material) pixels.push_back(point.pixel);
  }
  std::vector<LabelCandidate>& known = candidates_[pixels];
  if (known.empty()) {
    known = FindLabelCandidates(
        setup, material, {kAloneStages, 0, true, should_stop_}, context_);
  }
  return known;
}

std::vector<Eigen::VectorXd> LabelEvidence::StartsOf(
    const InverseProblem& labelled) {
  const StatusOr<SolveSetup> setup = SetUp(labelled);
  if (!setup.ok()) return {};
  std::vector<std::vector<LabelCandidate>> candidates;
  for (size_t m = 0; m < labelled.materials.size(); ++m) {
    candidates.push_back(CandidatesOf(*setup, static_cast<int>(m)));
  }
  std::vector<Eigen::VectorXd> starts;
  for (const LabelCombination& c : Combine(candidates, kMostStarts)) {
    starts.push_back(c.InOneLight(*setup->lobes));
  }
  return starts;
}

void LabelEvidence::Explain(const InverseProblem& labelled,
                            const std::vector<Eigen::VectorXd>& starts,
                            ComparedLabelling* labelling) {
  const StatusOr<SolveSetup> setup = SetUp(labelled);
  if (!setup.ok() || starts.empty() || should_stop_()) return;
  MaterialPrior prior = RepeatPrior(setup->materials, labelling->count);
  for (const Eigen::VectorXd& start : starts) {
    prior.materials.push_back({std::to_string(prior.materials.size()), start});
  }
  ReflectanceSearchOptions o = CoarseSearchOptions(1.0, *setup, context_);
  o.screen.bins.bins_across = kScreenBins;
  o.coarse.bins.bins_across = kBins;
  o.coarse_stages = kTogetherStages;
  o.sigma = kSigma;
  o.ranked_anew = 0;
  LimitIterations(labelled.solver.max_iterations, &o);
  o.num_materials = labelling->count;
  o.covariance = true;
  o.should_stop = should_stop_;
  o.report = {};
  const StatusOr<ReflectanceSearchResult> found = SearchReflectance(
      {FlowLobes::Factory(*labelled.model, setup->lobes->layout(),
                          labelled.num_threads),
       &prior,
       {}},
      labelled.points, SearchedPixels(*setup), o);
  if (!found.ok() || found->covariance.size() == 0) return;
  const double cost = found->cost - LogVolume(found->covariance, prior);
  VLOG(1) << labelling->count << " materials, start " << found->initial_guess
          << " of " << starts.size() << ", misfit " << found->misfit
          << ": -log evidence " << cost << " nats, " << found->cost
          << " at the mode";
  if (!(cost < labelling->cost)) return;
  labelling->cost = cost;
  labelling->misfit = found->misfit;
  labelling->lobes = ToEigen(found->parameters);
}

void LabelEvidence::Compare(std::vector<ComparedLabelling>* labellings) {
  std::vector<int> part = IntersectionOf(*labellings);
  LeaveSeamsOut(problem_, &part);
  LeaveSmallOut(&part);
  ComparedLabelling& first = labellings->front();
  const bool begun = first.lobes.size() > 0;
  for (ComparedLabelling& labelling : *labellings) {
    labelling.cost = std::numeric_limits<double>::infinity();
    if (should_stop_()) continue;
    InverseProblem labelled = WithLabels(problem_, labelling.labels);
    std::vector<Eigen::VectorXd> starts;
    if (&labelling == &first && begun) {
      starts = {first.lobes};
    } else {
      starts = StartsOf(labelled);
      if (begun) starts.push_back(Inherit(first, labelling));
    }
    Explain(InParts(std::move(labelled), part), starts, &labelling);
  }
  // More materials must not win by a better search alone.
  std::vector<Eigen::VectorXd> of_others;
  for (const ComparedLabelling& other : *labellings) {
    if (&other == &first || !(other.cost < first.cost)) continue;
    of_others.push_back(Inherit(other, first));
  }
  if (of_others.empty()) return;
  Explain(InParts(WithLabels(problem_, first.labels), part), of_others, &first);
}

}  // namespace ibrdf
