// Which of several labellings of an object's materials the image makes most
// probable.
#pragma once
#include <Eigen/Core>
#include <functional>
#include <limits>
#include <map>
#include <vector>

#include "ibrdf/solvers/estimation/label_candidates.h"
#include "ibrdf/solvers/estimation/solve_context.h"
#include "ibrdf/solvers/problem/inverse_problem.h"

namespace ibrdf {

// A material of each of the problem's points, and the reflectances that were
// found for it.
struct ComparedLabelling {
  std::vector<int> labels;  // [points], from 0
  int count = 1;            // of materials
  Eigen::VectorXd lobes;    // [count][lobes' parameters]; empty: none yet
  // -log evidence, nats; infinite where there is none.
  double cost = std::numeric_limits<double>::infinity();
  double misfit = 0.0;  // mean |log L_o - log I| over bins
};

// Compares labellings at the search's coarse resolution, the light and the
// reflectances (Laplace) integrated out. What is found of a label serves all
// labellings that have it.
class LabelEvidence {
 public:
  // problem: without labels; it and the context must outlive this. should_stop:
  // as ReflectanceSearchOptions has it.
  LabelEvidence(const InverseProblem& problem,
                std::function<bool()> should_stop, SolveContext* context);

  // Sets the costs and lobes of all. Bins do not mix what one of them parts, so
  // that all explain the same numbers. The first, where it has lobes, begins
  // from those alone; from what they say of its labels the others begin as
  // well. Ends early, with infinite costs, once it should stop.
  void Compare(std::vector<ComparedLabelling>* labellings);

 private:
  std::vector<LabelCandidate> CandidatesOf(const SolveSetup& setup,
                                           int material);
  std::vector<Eigen::VectorXd> StartsOf(const InverseProblem& labelled);
  void Explain(const InverseProblem& labelled,
               const std::vector<Eigen::VectorXd>& starts,
               ComparedLabelling* labelling);

  const InverseProblem& problem_;
  const std::function<bool()> should_stop_;
  SolveContext* const context_;
  // By the pixels of a label.
  std::map<std::vector<int>, std::vector<LabelCandidate>> candidates_;
};

}  // namespace ibrdf
