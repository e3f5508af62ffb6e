// Probabilities of boxes of the cube under a flow, and counts of samples.
#pragma once
#include <algorithm>
#include <cmath>
#include <cstdint>
#include <vector>

#include "ibrdf/flow/brdf_flow.h"

namespace ibrdf {

// h x d x p equal boxes of the cube, x_p the fastest.
struct CubeCells {
  int h = 16, d = 6, p = 6;
  int count() const { return h * d * p; }
};

// Points of the midpoint rule in each cell.
struct CellRule {
  int h = 16, d = 24, p = 24;
};

// Integrals of exp(LogDensity) over the cells: shares nothing with Inverse.
inline std::vector<double> CellProbabilities(const BrdfFlow& flow,
                                             const float* code,
                                             const CubeCells& cells,
                                             const CellRule& rule = {}) {
  const int nd = cells.d * rule.d, np = cells.p * rule.p;
  std::vector<double> probability(cells.count(), 0.0);
  for (int ih = 0; ih < cells.h; ++ih) {
    FlowColumns x(nd * np, rule.h);
    for (int c = 0; c < x.columns; ++c) {
      x.SetColumn(c, (c / np + 0.5) / nd, (c % np + 0.5) / np);
      for (int i = 0; i < rule.h; ++i) {
        x.x_h[static_cast<size_t>(i) * x.columns + c] =
            static_cast<float>((ih + (i + 0.5) / rule.h) / cells.h);
      }
    }
    std::vector<float> log_density(x.num_points());
    flow.LogDensityOnColumns(x, code, 1, log_density.data(), nullptr);
    for (int64_t k = 0; k < x.num_points(); ++k) {
      const int c = static_cast<int>(k % x.columns);
      const int cell =
          (ih * cells.d + c / np / rule.d) * cells.p + c % np / rule.p;
      probability[cell] += std::exp(static_cast<double>(log_density[k]));
    }
  }
  const double volume = 1.0 / (static_cast<double>(cells.h) * rule.h * nd * np);
  for (double& p : probability) p *= volume;
  return probability;
}

// The same by differences of Latent, for densities with peaks that no midpoint
// rule resolves: exact in x_h and x_p; in each of sub x sub parts of a cell the
// conditioners see the centre.
inline std::vector<double> CellProbabilitiesByLatent(const BrdfFlow& flow,
                                                     const float* code,
                                                     const CubeCells& cells,
                                                     int sub) {
  const int nd = cells.d * sub, np = cells.p * sub;
  std::vector<double> probability(cells.count(), 0.0);
  const auto latent = [&](const std::vector<double>& x) {
    std::vector<double> u(x.size());
    flow.Latent(x.data(), static_cast<int64_t>(x.size() / 3), code, 1,
                u.data());
    return u;
  };
  // For each strip of x_p: its own edges, then edges in x_d, then in x_h.
  for (int ip = 0; ip < np; ++ip) {
    const double x_p = (ip + 0.5) / np;
    std::vector<double> h, d, p;
    const auto add = [&](double xh, double xd, double xp) {
      h.push_back(xh);
      d.push_back(xd);
      p.push_back(xp);
    };
    for (int i = 0; i < 2; ++i) add(0.0, 0.0, static_cast<double>(ip + i) / np);
    for (int i = 0; i <= nd; ++i) add(0.0, static_cast<double>(i) / nd, x_p);
    for (int id = 0; id < nd; ++id) {
      for (int i = 0; i <= cells.h; ++i) {
        add(static_cast<double>(i) / cells.h, (id + 0.5) / nd, x_p);
      }
    }
    const size_t n = h.size();
    h.insert(h.end(), d.begin(), d.end());
    h.insert(h.end(), p.begin(), p.end());
    const std::vector<double> u = latent(h);
    const double strip = u[2 * n + 1] - u[2 * n];
    for (int id = 0; id < nd; ++id) {
      const double part = strip * (u[n + 3 + id] - u[n + 2 + id]);
      const double* column = u.data() + 3 + nd + id * (cells.h + 1);
      for (int i = 0; i < cells.h; ++i) {
        probability[(i * cells.d + id / sub) * cells.p + ip / sub] +=
            part * (column[i + 1] - column[i]);
      }
    }
  }
  return probability;
}

// x: [3][count].
inline std::vector<int64_t> CellCounts(const std::vector<double>& x,
                                       const CubeCells& cells) {
  const size_t n = x.size() / 3;
  std::vector<int64_t> counts(cells.count(), 0);
  const auto bin = [](double v, int size) {
    return std::min(static_cast<int>(v * size), size - 1);
  };
  for (size_t i = 0; i < n; ++i) {
    ++counts[(bin(x[i], cells.h) * cells.d + bin(x[n + i], cells.d)) * cells.p +
             bin(x[2 * n + i], cells.p)];
  }
  return counts;
}

// Points [3][count] of the closed cube: a lattice with all faces, edges and
// corners.
inline std::vector<double> LatticeOfCube(int side) {
  const size_t n = static_cast<size_t>(side) * side * side;
  std::vector<double> x(3 * n);
  for (size_t i = 0; i < n; ++i) {
    x[i] = static_cast<double>(i / side / side) / (side - 1);
    x[n + i] = static_cast<double>(i / side % side) / (side - 1);
    x[2 * n + i] = static_cast<double>(i % side) / (side - 1);
  }
  return x;
}

}  // namespace ibrdf
