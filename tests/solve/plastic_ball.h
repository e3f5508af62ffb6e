// A ball of plastic in a known room, with paint.
#pragma once
#include <cmath>
#include <vector>

#include "ibrdf/brdf/cook_torrance.h"
#include "ibrdf/solvers/solve/solve.h"
#include "tests/solve/ball_problem.h"

namespace ibrdf {
namespace testing {

// A room with a lamp, a window and a dark floor; no turn of it is like it.
inline Image Room() {
  Image map(32, 16);
  for (int y = 0; y < 16; ++y) {
    for (int x = 0; x < 32; ++x) {
      const bool lamp = x >= 3 && x < 6 && y >= 3 && y < 6;
      const bool window = x >= 12 && x < 18 && y >= 5 && y < 9;
      float* rgb = map.At(x, y);
      for (int c = 0; c < 3; ++c) {
        rgb[c] = y >= 9 ? 0.1f : 0.3f;
        if (lamp) rgb[c] = c == 2 ? 10.0f : 20.0f;
        if (window) rgb[c] = c == 2 ? 4.0f : 2.5f;
      }
    }
  }
  return map;
}

inline CookTorrance Plastic() {
  CookTorrance brdf;
  brdf.diffuse = {0.4, 0.3, 0.2};
  brdf.roughness = 0.2;
  return brdf;
}

// Under Room(), with radiance e^paint(normal) times that of the BRDF, paint of
// all channels or an array of them.
template <typename Paint>
InverseProblem BallInRoom(const BrdfFunction& brdf, const Paint& paint,
                          int size = 40) {
  InverseProblem problem = BallProblem(size);
  const Image map = Room();
  problem.map_width = map.width;
  problem.map_height = map.height;
  problem.known_map = map;
  const Transport transport(problem.points, map.height, map.width,
                            problem.transport);
  std::vector<double> L_o(3 * problem.points.size());
  transport.Render(BrdfGrid::FromFunction(brdf, problem.transport.grid),
                   map.rgb.data(), L_o.data());
  for (size_t p = 0; p < problem.points.size(); ++p) {
    Eigen::Map<Eigen::Array3d>(&L_o[3 * p]) *=
        (Eigen::Array3d::Zero() + paint(problem.points[p].normal)).exp();
  }
  SetNoisyImage(L_o, 0.01, &problem);
  return problem;
}

template <typename Paint>
InverseProblem PlasticBall(const Paint& paint) {
  return BallInRoom(Plastic().Function(), paint);
}

// Matte, large enough for places beside each other.
template <typename Paint>
InverseProblem PaintedBall(const Paint& paint) {
  CookTorrance brdf = Plastic();
  brdf.f0 = 0.02;
  return BallInRoom(brdf.Function(), paint, 72);
}

inline double NoPaint(const Eigen::Vector3f&) { return 0.0; }
// Stripes with no sharp edge, the dark ones 0.3 times as bright.
inline double Stripes(const Eigen::Vector3f& normal) {
  return 0.6 * std::sin(7.0 * normal.x() + 4.0 * normal.y());
}

// What a solve that chooses whether there is paint makes of it.
inline StatusOr<Solution> SolvedWithAutoPaint(InverseProblem problem) {
  problem.variation = ReflectanceVariation::kAuto;
  problem.solver.max_iterations = 20;
  return SolveInverseRendering(problem, nullptr, nullptr);
}

}  // namespace testing
}  // namespace ibrdf
