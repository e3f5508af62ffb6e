#include "ibrdf/solvers/solve/residual_statistics.h"

#include <glog/logging.h>

#include <algorithm>
#include <cmath>
#include <map>
#include <utility>
#include <vector>

#include "ibrdf/light/log_map.h"

namespace ibrdf {
namespace {

// That correlation is taken of, about; and the rows they lie in, at least.
constexpr size_t kSomePixels = 2000;
constexpr size_t kLeastRows = 8;

std::vector<float> RadianceOf(const LogMap& log_map) {
  std::vector<float> radiance;
  log_map.Exp(&radiance);
  return radiance;
}

// Rows of the object, evenly spread, and pairs of neighbours in long ones:
// indices of pixels.
std::vector<size_t> SomeRows(const Observation& pixels, int width) {
  std::map<int, std::vector<size_t>> rows;
  for (size_t i = 0; i < pixels.points.size(); ++i) {
    if (pixels.observed.valid[i]) {
      rows[pixels.points[i].pixel / width].push_back(i);
    }
  }
  const size_t stride = std::clamp<size_t>(
      rows.size() / kLeastRows, 1, pixels.points.size() / kSomePixels + 1);
  const size_t thin = pixels.points.size() / (stride * kSomePixels) + 1;
  std::vector<size_t> out;
  size_t row = 0;
  for (const auto& [y, of_row] : rows) {
    if (row++ % stride != stride / 2) continue;
    for (size_t k = 0; k < of_row.size(); ++k) {
      if (k / 2 % thin == 0) out.push_back(of_row[k]);
    }
  }
  return out;
}

// Neighbours are those in a row.
double CorrelationOf(const ResidualRows& rows,
                     const std::vector<ShadingPoint>& points) {
  const double largest = rows.LargestResidual();
  double products = 0.0, squares = 0.0;
  for (const auto& [first, second] : PairsInRows(points, rows.indices)) {
    for (size_t c = 0; c < 3; ++c) {
      const double here =
          std::clamp(rows.residuals[3 * first + c], -largest, largest);
      const double next =
          std::clamp(rows.residuals[3 * second + c], -largest, largest);
      products += here * next;
      squares += 0.5 * (here * here + next * next);
    }
  }
  return squares > 0.0 ? products / squares : 0.0;
}

// L_o: of the rows' pixels [indices * 3].
void SetResiduals(const SolveSetup& setup, const std::vector<double>& L_o,
                  ResidualRows* rows) {
  for (size_t k = 0; k < L_o.size(); ++k) {
    const RadianceInterval seen =
        setup.pixels.observed.Interval(3 * rows->indices[k / 3] + k % 3);
    const double rendered = std::max(L_o[k], setup.epsilon);
    rows->log_render.push_back(std::log(rendered));
    rows->residuals.push_back(
        std::log(std::clamp(rendered, seen.low, seen.high) / rendered));
  }
}

ResidualStatistics StatisticsOf(const SolveSetup& setup,
                                const ResidualRows& rows) {
  ResidualStatistics out;
  if (rows.indices.empty()) return out;
  out.misfit = rows.Misfit();
  out.correlation = CorrelationOf(rows, setup.pixels.points);
  VLOG(1) << setup.problem->model_name << " leaves " << out.misfit
          << " of the log radiance; neighbours correlate by "
          << out.correlation;
  return out;
}

}  // namespace

double ResidualRows::Misfit() const {
  double sum = 0.0;
  for (const double v : residuals) {
    sum += std::abs(v) / static_cast<double>(residuals.size());
  }
  return sum;
}

std::vector<std::pair<size_t, size_t>> PairsInRows(
    const std::vector<ShadingPoint>& points,
    const std::vector<size_t>& indices) {
  std::vector<std::pair<size_t, size_t>> pairs;
  for (size_t k = 0; k + 1 < indices.size(); ++k) {
    if (points[indices[k + 1]].pixel == points[indices[k]].pixel + 1) {
      pairs.emplace_back(k, k + 1);
    }
  }
  return pairs;
}

ResidualRows ResidualRowsOf(const SolveSetup& setup, const Estimate& estimate) {
  ResidualRows rows;
  rows.indices = SomeRows(setup.pixels, setup.problem->image.width);
  if (rows.indices.empty()) return rows;
  Observation some;
  for (const size_t i : rows.indices) {
    some.points.push_back(setup.pixels.points[i]);
  }
  const Iterate& iterate = estimate.iterate;
  const std::vector<float> map =
      setup.light_unknown() ? RadianceOf(LogMapOf(iterate)) : setup.known_map;
  std::vector<double> L_o(3 * rows.indices.size());
  const std::vector<BrdfGrid> grids = setup.GridsOf(iterate.state.lobes);
  ObservedPixels(setup, std::move(some))
      .TransportFrom(SizeOf(iterate.light, setup))
      .Render(ByMaterial(grids), map.data(), L_o.data());
  for (size_t k = 0; k < L_o.size(); ++k) L_o[k] += iterate.ambient[k % 3];
  SetResiduals(setup, L_o, &rows);
  return rows;
}

ResidualStatistics ResidualStatisticsOf(const SolveSetup& setup,
                                        const Estimate& estimate) {
  return StatisticsOf(setup, ResidualRowsOf(setup, estimate));
}

ResidualStatistics ResidualStatisticsOf(const SolveSetup& setup,
                                        const Image& render) {
  ResidualRows rows;
  rows.indices = SomeRows(setup.pixels, setup.problem->image.width);
  std::vector<double> L_o;
  for (const size_t i : rows.indices) {
    const float* rgb =
        render.rgb.data() + size_t{3} * setup.pixels.points[i].pixel;
    L_o.insert(L_o.end(), rgb, rgb + 3);
  }
  SetResiduals(setup, L_o, &rows);
  return StatisticsOf(setup, rows);
}

}  // namespace ibrdf
