// Where further photographs tell the most.
#pragma once
#include <string>
#include <vector>

#include "ibrdf/base/status.h"
#include "ibrdf/io/calibrated_views.h"
#include "ibrdf/io/problem.h"
#include "ibrdf/solvers/uncertainty_map/uncertainty_inputs.h"
#include "ibrdf/surface/texel_observations.h"

namespace ibrdf {

struct NextViews {
  std::vector<CalibratedView> candidates;
  std::vector<int> chosen;  // candidates, the first to photograph first
  // The mean entropy to expect, before any of them and with each of `chosen`
  // added: of the spectrum evaluator, whatever the map's is.
  std::vector<double> expected_entropy;
  std::vector<int> farthest;  // as many by farthest-point sampling
  int texels = 0;             // that were asked, evenly spread over the area
};

struct NextViewOptions {
  int count = 0;  // fewer where there are fewer candidates
  int num_threads = 0;
};

// Greedy search (Wiersma et al. 2025, Eq. 13). Rays decide what a candidate
// sees; silhouettes are not left out. observer: of the inputs' views.
StatusOr<NextViews> ChooseNextViews(const UncertaintyInputs& inputs,
                                    const TexelObserver& observer,
                                    const UncertaintySpec& spec,
                                    std::vector<CalibratedView> candidates,
                                    const NextViewOptions& options);

}  // namespace ibrdf
