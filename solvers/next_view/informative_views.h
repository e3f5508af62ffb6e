// The photographs that would tell the most of a reflectance, its light unknown.
#pragma once
#include <string>
#include <vector>

#include "ibrdf/base/status.h"
#include "ibrdf/io/calibrated_views.h"
#include "ibrdf/solvers/estimation/solution.h"
#include "ibrdf/solvers/next_view/next_view_candidates.h"
#include "ibrdf/solvers/problem/inverse_problem.h"

namespace ibrdf {

struct InformativeViews {
  std::string from;                        // NextViewCandidates'
  std::vector<CalibratedView> candidates;  // all of them
  // Nats that the photographs say of codes and colours beyond the prior.
  double information = 0.0;
  // Nats that each candidate would add, if it were the next one [candidates]; 0
  // where it sees nothing.
  std::vector<double> first_gains;
  // Candidates, the first to photograph first, and the nats that each adds to
  // the photographs and those before it.
  std::vector<int> chosen;
  std::vector<double> gains;
  std::vector<int> farthest;  // as many by farthest-point sampling
  double seconds = 0.0;
};

// `count` candidates, greedily: half the gain in log det of the information of
// codes and colours, the light integrated out (ViewInformation), at the
// solution. Fewer where fewer see the object. The light's hyperparameters are
// held; light that the object throws on itself is left out.
// kNoImprovement, with the reason, where the solution says nothing to choose
// by: it has no posterior, or paint. problem: as it was solved, with the
// solution's model (WithModelOf). The same bits for any number of threads.
StatusOr<InformativeViews> ChooseInformativeViews(
    const InverseProblem& problem, const Solution& solution,
    const NextViewCandidates& candidates, int count);

}  // namespace ibrdf
