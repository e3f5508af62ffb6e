// A ball of the tiny model for the tests of whole solves.
#pragma once
#include <cmath>
#include <memory>
#include <random>
#include <vector>

#include "ibrdf/brdf/flow_lobes.h"
#include "ibrdf/solvers/problem/inverse_problem.h"
#include "ibrdf/transport/transport.h"
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

// Radiance of two lobes of a model under a map [points * 3].
inline std::vector<double> BallRadiance(const InverseProblem& problem,
                                        const NeuralBrdfModel& model,
                                        const std::vector<double>& parameters,
                                        const Image& map) {
  const FlowLobes lobes(model, 2, problem.transport.grid, 1);
  std::vector<double> L_o(3 * problem.points.size());
  Transport(problem.points, map.height, map.width, problem.transport)
      .Render(lobes.Grid(parameters.data()), map.rgb.data(), L_o.data());
  return L_o;
}

// The parameters of two materials of TinyModel(3), two lobes each: the second
// is darker, and of another hue.
inline const std::vector<double> kTwoMaterials[2] = {
    {0.3, -0.4, 0.2, 0.1, 5.0, 4.6, 4.2, -0.5, 0.1, 0.3, -0.2, 3.0, 3.5, 3.3},
    {-0.2, 0.3, 0.1, -0.3, 3.0, 3.4, 3.9, 0.2, 0.4, -0.1, 0.2, 2.0, 2.2, 2.6}};

// Radiance of these under a map [points * 3], by ShadingPoint::material.
inline std::vector<double> RadianceOfTwo(
    const InverseProblem& problem, const std::vector<ShadingPoint>& points,
    const Image& map) {
  const FlowLobes lobes(*problem.model, 2, problem.transport.grid, 1);
  const BrdfGrid grids[2] = {lobes.Grid(kTwoMaterials[0].data()),
                             lobes.Grid(kTwoMaterials[1].data())};
  std::vector<double> L_o(3 * points.size());
  Transport(points, map.height, map.width, problem.transport)
      .Render({&grids[0], &grids[1]}, map.rgb.data(), L_o.data());
  return L_o;
}

// Makes it the image, with log-normal noise of that deviation.
inline void SetNoisyImage(const std::vector<double>& L_o, double deviation,
                          InverseProblem* problem) {
  std::mt19937 rng(1);
  std::normal_distribution<double> noise(0.0, deviation);
  for (size_t i = 0; i < L_o.size(); ++i) {
    problem->image.rgb[3 * problem->points[i / 3].pixel + i % 3] =
        static_cast<float>(L_o[i] * std::exp(noise(rng)));
  }
}

}  // namespace testing
}  // namespace ibrdf
