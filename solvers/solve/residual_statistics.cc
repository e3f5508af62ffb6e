#include "ibrdf/solvers/solve/residual_statistics.h"

#include <glog/logging.h>

#include <algorithm>
#include <cmath>
#include <utility>
#include <vector>

#include "ibrdf/light/log_map.h"

namespace ibrdf {
namespace {

constexpr int kMostPixels = 2000;  // that correlation is taken of
// As a multiple of the mean: beyond it a residual counts as that.
constexpr double kLargestResidual = 4.0;

std::vector<float> RadianceOf(const LogMap& log_map) {
  std::vector<float> radiance;
  log_map.Exp(&radiance);
  return radiance;
}

// Whole rows of the image, evenly spread: indices of pixels.
std::vector<size_t> SomeRows(const Observation& pixels, int width) {
  const size_t stride = pixels.points.size() / kMostPixels + 1;
  std::vector<size_t> out;
  for (size_t i = 0; i < pixels.points.size(); ++i) {
    const size_t row = pixels.points[i].pixel / width;
    if (row % stride == stride / 2 && pixels.observed.valid[i]) {
      out.push_back(i);
    }
  }
  return out;
}

// What the log radiance of these pixels lacks [indices * 3].
std::vector<double> ResidualsOf(const Estimate& estimate,
                                const std::vector<size_t>& indices,
                                const SolveSetup& setup) {
  Observation some;
  for (const size_t i : indices) {
    some.points.push_back(setup.pixels.points[i]);
  }
  const Iterate& iterate = estimate.iterate;
  const std::vector<float> map =
      setup.light_unknown() ? RadianceOf(LogMapOf(iterate)) : setup.known_map;
  std::vector<double> L_o(3 * indices.size());
  const std::vector<BrdfGrid> grids = setup.GridsOf(iterate.state.lobes);
  ObservedPixels(setup, std::move(some))
      .TransportFrom(SizeOf(iterate.light, setup))
      .Render(ByMaterial(grids), map.data(), L_o.data());
  for (size_t k = 0; k < L_o.size(); ++k) {
    const RadianceInterval seen =
        setup.pixels.observed.Interval(3 * indices[k / 3] + k % 3);
    const double rendered =
        std::max(L_o[k] + iterate.ambient[k % 3], setup.epsilon);
    L_o[k] = std::log(std::clamp(rendered, seen.low, seen.high) / rendered);
  }
  return L_o;
}

// Neighbours are those in a row. Residuals beyond `largest` count as that.
double CorrelationOf(const std::vector<double>& residuals, double largest,
                     const std::vector<size_t>& indices,
                     const Observation& pixels) {
  double products = 0.0, squares = 0.0;
  for (size_t k = 0; k + 1 < indices.size(); ++k) {
    if (pixels.points[indices[k + 1]].pixel !=
        pixels.points[indices[k]].pixel + 1) {
      continue;
    }
    for (size_t c = 3 * k; c < 3 * k + 3; ++c) {
      const double here = std::clamp(residuals[c], -largest, largest);
      const double next = std::clamp(residuals[c + 3], -largest, largest);
      products += here * next;
      squares += 0.5 * (here * here + next * next);
    }
  }
  return squares > 0.0 ? products / squares : 0.0;
}

}  // namespace

ResidualStatistics ResidualStatisticsOf(const SolveSetup& setup,
                                        const Estimate& estimate) {
  ResidualStatistics out;
  const std::vector<size_t> indices =
      SomeRows(setup.pixels, setup.problem->image.width);
  if (indices.empty()) return out;
  const std::vector<double> residuals = ResidualsOf(estimate, indices, setup);
  for (const double v : residuals) {
    out.misfit += std::abs(v) / static_cast<double>(residuals.size());
  }
  out.correlation = CorrelationOf(residuals, kLargestResidual * out.misfit,
                                  indices, setup.pixels);
  VLOG(1) << setup.problem->model_name << " leaves " << out.misfit
          << " of the log radiance; neighbours correlate by "
          << out.correlation;
  return out;
}

}  // namespace ibrdf
