#include "ibrdf/solvers/solve/found_labels.h"

#include <glog/logging.h>

#include <algorithm>
#include <functional>
#include <string>
#include <utility>
#include <vector>

#include "ibrdf/solvers/estimation/label_evidence.h"
#include "ibrdf/solvers/estimation/solve_setup.h"
#include "ibrdf/solvers/problem/with_labels.h"
#include "ibrdf/solvers/segmentation/label_proposals.h"

namespace ibrdf {
namespace {

// Nats by which the image must be more probable of two materials than of one,
// and of each further one. What one metal mirrors has sharp edges too, and the
// coarse light does not hold all of it: of 45 balls of one material one gained
// more, 111; five of several gained 87 to 403
// (docs/notes/labels_from_the_image.md).
constexpr double kGainOfSecond = 85.0, kGainOfFurther = 45.0;
constexpr double kLabelsShare = 0.5;  // of the time that remains, at most

std::vector<LabelProposal> Proposals(const InverseProblem& problem) {
  const StatusOr<SolveSetup> setup = SetUp(problem);
  if (!setup.ok()) return {};
  LabelProposalOptions options;
  options.most_materials = kMostFoundLabels;
  options.num_threads = problem.num_threads;
  return ProposeLabels(setup->pixels.points, setup->pixels.observed,
                       problem.image.width, options);
}

// Those of as many materials, beside the best so far, which comes first.
std::vector<ComparedLabelling> WithProposals(
    ComparedLabelling best, const std::vector<LabelProposal>& proposals,
    int count) {
  std::vector<ComparedLabelling> compared = {std::move(best)};
  for (const LabelProposal& proposal : proposals) {
    if (proposal.count != count) continue;
    ComparedLabelling& labelling = compared.emplace_back();
    labelling.labels = proposal.labels;
    labelling.count = count;
  }
  return compared;
}

}  // namespace

FoundLabels FindLabels(const InverseProblem& problem, SolveContext* context) {
  const std::function<bool()> stop = context->StopAfter(kLabelsShare);
  ComparedLabelling best;
  best.labels.assign(problem.points.size(), 0);
  const std::vector<LabelProposal> proposals = Proposals(problem);
  FoundLabels found;
  LabelEvidence evidence(problem, stop, context);
  for (int count = 2; count <= kMostFoundLabels; ++count) {
    std::vector<ComparedLabelling> compared =
        WithProposals(best, proposals, count);
    if (compared.size() == 1) continue;
    evidence.Compare(&compared);
    found.cut_short = stop();
    if (found.cut_short) break;
    const auto least = std::min_element(
        compared.begin() + 1, compared.end(),
        [](const auto& a, const auto& b) { return a.cost < b.cost; });
    const double gain = compared.front().cost - least->cost;
    context->Report("labels: " + std::to_string(count) + " materials",
                    static_cast<int>(problem.points.size()), least->cost,
                    least->misfit);
    const bool better =
        gain > (best.count == 1 ? kGainOfSecond : kGainOfFurther);
    (better ? found.gain : found.gain_of_more) = gain;
    if (!better) break;
    best = std::move(*least);
  }
  found.labels = std::move(best.labels);
  return found;
}

}  // namespace ibrdf
