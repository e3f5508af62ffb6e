// What several views under known light leave unknown of a surface: read,
// observe, evaluate, and choose the next views. Nothing is solved.
#pragma once
#include <optional>
#include <string>
#include <vector>

#include "ibrdf/base/status.h"
#include "ibrdf/io/problem.h"
#include "ibrdf/solvers/uncertainty_map/next_views.h"
#include "ibrdf/solvers/uncertainty_map/texel_entropy.h"
#include "ibrdf/solvers/uncertainty_map/uncertainty_inputs.h"

namespace ibrdf {

struct UncertaintyOptions {
  int add = 0;                            // views to choose, >= 0
  std::string candidates = "sphere:100";  // LoadCandidates
  int num_threads = 0;                    // <= 0: all
  TexelProgress progress;                 // of the evaluation; may be empty
};

struct StageSeconds {
  std::string stage;
  double seconds;
};

struct UncertaintyResult {
  UncertaintyInputs inputs;
  TexelEntropy texels;
  std::optional<NextViews> next;  // of `add` > 0
  std::vector<StageSeconds> stages;
};

// Refuses views of which none has a sample of the surface; warns of each that
// has none.
StatusOr<UncertaintyResult> MapUncertainty(const Problem& problem,
                                           const UncertaintyOptions& options);

}  // namespace ibrdf
