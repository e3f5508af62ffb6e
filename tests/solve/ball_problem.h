// A ball of the tiny model for the tests of whole solves.
#pragma once
#include <memory>

#include "ibrdf/solvers/problem/inverse_problem.h"
#include "tests/support/solver_testing.h"

namespace ibrdf {
namespace testing {

// size: pixels a side, black. A budget of time that no test needs, so that
// iterations alone end a solve.
inline InverseProblem BallProblem(int size) {
  InverseProblem problem;
  problem.points = SpherePoints(size);
  problem.image = Image(size, size);
  problem.model = std::make_shared<const NeuralBrdfModel>(TinyModel(3));
  problem.transport = TinyTransportOptions();
  problem.num_threads = 1;
  problem.map_width = 16;
  problem.map_height = 8;
  problem.solver.seconds = 1e6;
  return problem;
}

}  // namespace testing
}  // namespace ibrdf
