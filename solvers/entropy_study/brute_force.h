// Entropy over 8 x 8 x 8 parameters, each compared with every view.
#pragma once
#include <vector>

#include "ibrdf/solvers/entropy_study/study_scene.h"

namespace ibrdf {

struct BruteForce {
  // [num_texels, 3]: entropy over log 512; the mean over cells of probability
  // times the error of (roughness, Ks, Kd) against the truth.
  std::vector<double> entropy, error;
  // [num_texels, 3]: Laplace's approximation at the most probable cell, half
  // the log determinant of the covariance, up to a constant. The curvature is
  // that of exact renders, and a normal prior has the variance of the cube.
  std::vector<double> laplace;
};

// p is proportional to exp(-mse / sharpness), the mean of squares over views.
// views: those that count; empty: all. num_threads <= 0: all.
BruteForce EvaluateBruteForce(const StudyScene& scene,
                              const std::vector<int>& views, double sharpness,
                              int num_threads);

// The studies' sharpness, in units of the map's mean radiance, squared.
inline constexpr double kBruteForceSharpness = 1e-2;

}  // namespace ibrdf
