// Lobes under a known light, from the materials that explain the image best.
#pragma once
#include <Eigen/Core>
#include <memory>
#include <string>
#include <vector>

#include "ibrdf/solvers/estimation/coarse_steps.h"
#include "ibrdf/solvers/estimation/known_light_search.h"
#include "ibrdf/solvers/estimation/posterior.h"
#include "ibrdf/solvers/estimation/solve_context.h"
#include "ibrdf/solvers/estimation/solve_setup.h"

namespace ibrdf {

// All materials of the prior are rendered under the light, the few that explain
// the image best take some steps of Ceres' trust region, and the best of those
// are finished at a scale b that falls with their misfit. Steps are taken on a
// coarse grid; what they lead to is judged on the problem's.
class CandidateSearch {
 public:
  // The setup and the context must outlive this.
  CandidateSearch(const SolveSetup& setup, Observation pixels,
                  SolveContext* context);

  // `earlier`, of a search on fewer pixels, is a candidate too; may be null.
  // It is called once: the pixels go to the estimate.
  Estimate Run(const Estimate* earlier);

 private:
  // A reflectance and what the pixels look like in it.
  struct Candidate {
    std::string name;
    JointState state;
    Eigen::Array3d ambient = Eigen::Array3d::Zero();
    JointCost priors;
    std::vector<double> radiance;  // [points * 3], without the ambient term
    double cost = 0.0;             // when candidates were last compared
    double scale = 0.0;            // of the likelihood
    bool settled = false;
  };

  Candidate MakeCandidate(const std::string& name, JointState state,
                          const Eigen::Array3d& ambient);
  // After at most so many steps of the lobes and an unknown ambient term, from
  // a trust region of this radius.
  Candidate Moved(const Candidate& from, int max_steps, double radius);
  // At the present scale; renders nothing.
  TraceEntry Entry(const std::string& stage, const Candidate& candidate) const;
  // The best materials after some steps each, and the first one as it is.
  std::vector<Candidate> FirstCandidates(
      const std::vector<RankedMaterial>& ranked);
  // Outer iterations of all in turn, after each of which the worst is given up.
  // The one that is left comes first; the costs are at its scale.
  std::vector<Candidate> Finalists(std::vector<Candidate> candidates);
  // Sorts the first so many, at least one, best first: compared at one scale,
  // the least of theirs, which is the likelihood's then.
  void SortBest(size_t count, std::vector<Candidate>* candidates);
  // Steps at a scale that may fall, unless they do not lower the cost.
  void OuterIteration(Candidate* candidate);

  const SolveSetup& setup_;
  SolveContext* const context_;
  CoarseSteps steps_;
  std::unique_ptr<ObservedPixels> pixels_;
  double scale_;
};

}  // namespace ibrdf
