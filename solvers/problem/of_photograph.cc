#include "ibrdf/solvers/problem/of_photograph.h"

namespace ibrdf {

InverseProblem OfPhotograph(const InverseProblem& problem, size_t k) {
  InverseProblem out = problem;
  out.image = problem.other_photographs.at(k)->image;
  out.bounds = problem.other_photographs[k]->bounds;
  out.other_photographs.clear();
  return out;
}

}  // namespace ibrdf
