// Cases that the tests of the triangular flow share.
#pragma once
#include <array>
#include <cmath>
#include <cstdint>
#include <random>
#include <string>
#include <utility>
#include <vector>

#include "ibrdf/flow/triangular_flow.h"
#include "tests/support/tiny_model.h"

namespace ibrdf {

struct TriangularCase {
  std::string name;
  TriangularShape shape;
  std::vector<float> weights;
  std::vector<float> code;
};

inline std::vector<float> RandomCode(int size, double norm, uint64_t seed) {
  std::mt19937_64 rng(seed);
  std::normal_distribution<double> normal;
  std::vector<double> z(size);
  double sum = 0.0;
  for (double& v : z) {
    v = normal(rng);
    sum += v * v;
  }
  std::vector<float> code;
  for (const double v : z) {
    code.push_back(static_cast<float>(v * norm / std::sqrt(sum)));
  }
  return code;
}

inline TriangularCase MakeCase(const std::string& name,
                               const TriangularShape& shape, float curvature,
                               double code_norm) {
  return {name, shape, CurvedWeights(shape, curvature, 3),
          RandomCode(shape.code_size, code_norm, 5)};
}

// The parameter whose knot has height h.
inline float ParameterOfHeight(double h) {
  return static_cast<float>(h /
                            (kHeightGain * (1 - std::abs(h) / kHeightRange)));
}

// A small flow whose heights are nearly `heights` everywhere (as many as fit,
// over and over), with knots at even steps: the last layers' biases make them,
// and the code moves them a little.
inline TriangularCase CaseOfHeights(const std::string& name,
                                    const std::vector<double>& heights,
                                    const std::array<int, 3>& bins) {
  TriangularShape shape;
  shape.code_size = 3;
  shape.bins = bins;
  shape.widths = {9};
  shape.marginal_widths = {5};
  TriangularCase c = MakeCase(name, shape, 1e-3f, 1.0);
  EditConditioners(shape, &c.weights,
                   [&](const ConditionerShape& conditioner, float* w) {
                     for (int k = 0; k < conditioner.NumHeights(); ++k) {
                       w[conditioner.dense.back().bias_offset + k] =
                           ParameterOfHeight(heights[k % heights.size()]);
                     }
                   });
  return c;
}

// Flat splines, differences of neighbouring heights on both sides of every
// branch of the kernels (|d| = 0.5 and 0), and heights near their limits.
inline std::vector<TriangularCase> CasesOfHeights() {
  return {
      CaseOfHeights("flat", {0.7}, {5, 2, 3}),
      CaseOfHeights("tiny steps", {0.0, 1e-6, 1e-4, 1.1e-4, -1e-3}, {12, 7, 5}),
      CaseOfHeights("about the switch",
                    {0.0, 0.499, 0.0, 0.501, 0.0, 0.4999, -0.0999, 0.4002, 0.9},
                    {16, 9, 8}),
      CaseOfHeights("steep", {0.0, 3.0, -3.0, 12.0, 0.0, -20.0}, {6, 5, 12}),
      CaseOfHeights("limits", {39.9, -39.9, -39.9, 39.9, 39.9}, {9, 4, 5}),
  };
}

inline std::vector<TriangularCase> TriangularCases() {
  TriangularShape usual;
  TriangularShape odd;
  odd.bins = {2, 5, 3};
  odd.code_size = 3;
  odd.widths = {19, 7};
  odd.marginal_widths = {5};
  TriangularShape many;
  many.bins = {64, 64, 64};
  many.widths = {33};
  many.marginal_widths = {17, 3};
  TriangularShape least;
  least.bins = {2, 2, 2};
  least.code_size = 1;
  least.widths = {1};
  least.marginal_widths = {1};
  std::vector<TriangularCase> cases = {MakeCase("start", usual, 1.0f, 0.5),
                                       MakeCase("rough", usual, 5.0f, 1.0),
                                       MakeCase("far code", usual, 3.0f, 30.0),
                                       MakeCase("odd", odd, 4.0f, 1.0),
                                       MakeCase("64 bins", many, 4.0f, 0.0),
                                       MakeCase("2 bins", least, 4.0f, 1.0)};
  for (TriangularCase& c : CasesOfHeights()) cases.push_back(std::move(c));
  return cases;
}

// Points [3][count] of the closed cube: inside, on faces, edges and corners.
inline std::vector<float> CubePoints(int count, uint64_t seed = 7) {
  std::mt19937_64 rng(seed);
  std::uniform_real_distribution<float> uniform(0.0f, 1.0f);
  std::uniform_int_distribution<int> kind(0, 9);
  std::vector<float> x(3 * static_cast<size_t>(count));
  for (float& v : x) {
    const int k = kind(rng);
    v = k == 0 ? 0.0f : (k == 1 ? 1.0f : uniform(rng));
  }
  return x;
}

// Columns of the closed cube, and the same as points [3][points * columns].
inline FlowColumns CubeColumns(int count, int points, uint64_t seed = 9) {
  const std::vector<float> x = CubePoints(count, seed);
  FlowColumns columns(count, points);
  for (int c = 0; c < count; ++c) columns.SetColumn(c, x[c], x[count + c]);
  columns.x_h = CubePoints(count * points, seed + 1);
  columns.x_h.resize(static_cast<size_t>(count) * points);
  return columns;
}
inline std::vector<float> PointsOf(const FlowColumns& columns) {
  const size_t n = columns.num_points();
  std::vector<float> x(columns.x_h);
  x.resize(3 * n);
  for (size_t i = 0; i < n; ++i) {
    x[n + i] = columns.x_d[i % columns.columns];
    x[2 * n + i] = columns.x_p[i % columns.columns];
  }
  return x;
}

}  // namespace ibrdf
