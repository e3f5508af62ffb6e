#include "ibrdf/solvers/baselines/dsbrdf_fit.h"

#include <algorithm>
#include <cmath>
#include <limits>
#include <utility>
#include <vector>

#include "ibrdf/solvers/baselines/table_samples.h"

namespace ibrdf {
namespace {

constexpr ParameterBounds kLogKappa = {-25.0, 3.5};  // exponent up to 33
constexpr ParameterBounds kLogGamma = {-9.0, 13.0};
constexpr ParameterBounds kLogUnit = {-18.0, 9.0};  // 1/sr

// One channel of a table and the geometry of its samples.
struct ChannelFit {
  ChannelFit(const DsbrdfShape& s, int c, std::vector<TableSample> of)
      : shape(s), channel(c), samples(std::move(of)) {
    for (const TableSample& sample : samples) {
      geometry.emplace_back(shape, sample.theta_h, sample.theta_d);
    }
  }

  double Solve(const std::vector<ParameterBounds>& bounds,
               const TableSolverOptions& options,
               std::vector<double>* parameters) const {
    TableCost cost(samples, {channel, channel + 1}, shape.num_parameters(),
                   [this](const double* p, size_t i, int, double* gradient) {
                     return EvaluateDsbrdf(shape, p, geometry[i], gradient);
                   });
    return SolveTableFit(&cost, bounds, options, parameters);
  }

  const DsbrdfShape shape;
  const int channel;
  const std::vector<TableSample> samples;
  std::vector<DsbrdfGeometry> geometry;
};

// Alternating in both angles, so that no row or column is left out.
std::vector<TableSample> Thin(const std::vector<TableSample>& samples,
                              size_t step) {
  std::vector<TableSample> thin;
  double weight = 0.0;
  for (size_t i = 0; i < samples.size(); i += step) {
    thin.push_back(samples[i]);
    weight += samples[i].weight;
  }
  for (TableSample& s : thin) s.weight /= weight;
  return thin;
}

// Lobes of constant shape in theta_d: the first almost flat, at the low values
// of the table, the last at its high values, powers spread geometrically.
std::vector<double> Start(const DsbrdfShape& shape, int channel,
                          const std::vector<TableSample>& samples,
                          double log_unit, double narrowest) {
  std::vector<double> sorted;
  for (const TableSample& s : samples) {
    sorted.push_back(s.log_raw[channel] + std::log(kMerlScale[channel]));
  }
  std::sort(sorted.begin(), sorted.end());
  const double low = sorted[sorted.size() / 4];
  const double high = sorted[sorted.size() * 49 / 50];
  std::vector<double> p(shape.num_parameters());
  for (int r = 0; r < shape.lobes; ++r) {
    const double t = shape.lobes > 1 ? r / (shape.lobes - 1.0) : 0.0;
    const double log_height = low + t * (high - low) - log_unit;
    // exp(kappa) - 1 is the height; the exponential of 50 needs no 1.
    const double kappa =
        log_height > 50.0 ? log_height : std::log1p(std::exp(log_height));
    for (int k = 0; k < shape.coefficients; ++k) {
      p[shape.LogKappa(r) + k] = std::log(std::max(kappa, 1e-10));
      p[shape.LogGamma(r) + k] =
          std::log(0.3) + t * (std::log(narrowest) - std::log(0.3));
    }
  }
  p[shape.LogUnit()] = log_unit;
  return p;
}

}  // namespace

StatusOr<Dsbrdf> FitDsbrdf(const MerlTable& table,
                           const DsbrdfFitOptions& options) {
  const StatusOr<std::vector<TableSample>> samples = AverageOverPhi(table);
  if (!samples.ok()) return samples.status();
  const DsbrdfShape& shape = options.shape;
  std::vector<ParameterBounds> bounds(shape.num_parameters(), kLogUnit);
  for (int r = 0; r < shape.lobes; ++r) {
    for (int k = 0; k < shape.coefficients; ++k) {
      bounds[shape.LogKappa(r) + k] = kLogKappa;
      bounds[shape.LogGamma(r) + k] = kLogGamma;
    }
  }
  Dsbrdf brdf;
  brdf.shape = shape;
  for (int c = 0; c < 3; ++c) {
    const ChannelFit all(shape, c, *samples);
    const ChannelFit coarse(shape, c, Thin(*samples, 7));
    std::vector<double> best;
    double best_cost = std::numeric_limits<double>::infinity();
    for (const double log_unit : {-7.0, -4.0, 0.0}) {
      for (const double narrowest : {20.0, 300.0}) {
        std::vector<double> p = Start(shape, c, *samples, log_unit, narrowest);
        const double cost = coarse.Solve(bounds, options.coarse, &p);
        if (best.empty() || cost < best_cost) {
          best_cost = cost;
          best = p;
        }
      }
    }
    all.Solve(bounds, options.solver, &best);
    brdf.parameters[c] =
        Eigen::Map<const Eigen::VectorXd>(best.data(), shape.num_parameters());
  }
  return brdf;
}

}  // namespace ibrdf
