#include "ibrdf/solvers/baselines/table_fit.h"

#include <glog/logging.h>

#include <algorithm>
#include <cmath>
#include <limits>
#include <utility>
#include <vector>

#include "ibrdf/base/pi.h"
#include "ibrdf/solvers/baselines/table_samples.h"

namespace ibrdf {
namespace {

// Beyond these a parameter no longer changes a table.
constexpr ParameterBounds kLogColour = {-20.0, 10.0};
constexpr ParameterBounds kLogSlope = {-6.5, 1.5};  // 0.0015 to 4.5
constexpr ParameterBounds kLogit = {-9.0, 9.0};
constexpr ParameterBounds kLogitRoughness = {-4.0, 9.0};  // from 0.018

// Starts of Cook-Torrance.
constexpr double kStartSlopes[] = {0.03, 0.1, 0.3, 0.8};
constexpr double kStartLogitF0[] = {-2.5, 1.0};

// log(pi f) of the Lambertian that is best without anything else; for tables on
// the floor the nearest within the bounds.
double LogAlbedo(const std::vector<TableSample>& samples, int channel) {
  double mean = 0.0;
  for (const TableSample& s : samples) mean += s.weight * s.log_raw[channel];
  const double raw = std::exp(mean) - kTableLogFloor;
  return std::clamp(std::log(std::max(raw, 1e-12) * kMerlScale[channel] * kPi),
                    kLogColour.lower, kLogColour.upper);
}

// A few iterations from each start, then all of them from the best.
std::vector<double> BestOf(const std::vector<std::vector<double>>& starts,
                           const std::vector<ParameterBounds>& bounds,
                           const TableSolverOptions& options, TableCost* cost) {
  const TableSolverOptions trial = {std::min(15, options.max_iterations), 1e-3};
  std::vector<double> best;
  double best_cost = std::numeric_limits<double>::infinity();
  for (std::vector<double> p : starts) {
    const double reached = SolveTableFit(cost, bounds, trial, &p);
    if (best.empty() || reached < best_cost) {
      best_cost = reached;
      best = p;
    }
  }
  SolveTableFit(cost, bounds, options, &best);
  return best;
}

}  // namespace

StatusOr<Lambertian> FitLambertian(const MerlTable& table) {
  const StatusOr<std::vector<TableSample>> samples = AverageOverPhi(table);
  if (!samples.ok()) return samples.status();
  Lambertian brdf;
  for (int c = 0; c < 3; ++c) {
    brdf.albedo[c] = std::exp(LogAlbedo(*samples, c));
  }
  return brdf;
}

StatusOr<CookTorrance> FitCookTorranceToTable(const MerlTable& table,
                                              const TableFitOptions& options) {
  const StatusOr<std::vector<TableSample>> samples =
      SampleBins(table, options.seed);
  if (!samples.ok()) return samples.status();
  CookTorrance brdf;
  for (int c = 0; c < 3; ++c) {
    TableCost cost(*samples, {c, c + 1}, 4,
                   [&](const double* p, size_t i, int, double* gradient) {
                     const TableSample& s = (*samples)[i];
                     Eigen::Vector4d slope;
                     const double f = EvaluateCookTorrance(
                         Eigen::Map<const CookTorranceLog>(p), s.theta_h,
                         s.theta_d, s.phi_d,
                         gradient != nullptr ? &slope : nullptr);
                     if (gradient != nullptr)
                       std::copy_n(slope.data(), 4, gradient);
                     return f;
                   });
    const double diffuse = LogAlbedo(*samples, c);
    std::vector<std::vector<double>> starts;
    for (const double slope : kStartSlopes) {
      for (const double logit_f0 : kStartLogitF0) {
        starts.push_back({diffuse - 1.0, diffuse, std::log(slope), logit_f0});
      }
    }
    const std::vector<double> best =
        BestOf(starts, {kLogColour, kLogColour, kLogSlope, kLogit},
               options.solver, &cost);
    FromLogParameters(Eigen::Map<const CookTorranceLog>(best.data()), c, &brdf);
  }
  return brdf;
}

StatusOr<CookTorrance> FitColouredCookTorranceToTable(
    const MerlTable& table, const TableFitOptions& options) {
  const StatusOr<std::vector<TableSample>> samples =
      SampleBins(table, options.seed);
  if (!samples.ok()) return samples.status();
  // Log diffuse and log specular of the channels, log roughness, logit f0.
  constexpr int kParameters = 8;
  const auto channel = [](const double* p, int c) {
    return CookTorranceLog(p[c], p[3 + c], p[6], p[7]);
  };
  TableCost cost(*samples, {0, 3}, kParameters,
                 [&](const double* p, size_t i, int c, double* gradient) {
                   const TableSample& s = (*samples)[i];
                   Eigen::Vector4d slope;
                   const double f = EvaluateCookTorrance(
                       channel(p, c), s.theta_h, s.theta_d, s.phi_d,
                       gradient != nullptr ? &slope : nullptr);
                   if (gradient != nullptr) {
                     std::fill_n(gradient, kParameters, 0.0);
                     gradient[c] = slope[0];
                     gradient[3 + c] = slope[1];
                     gradient[6] = slope[2];
                     gradient[7] = slope[3];
                   }
                   return f;
                 });
  std::vector<std::vector<double>> starts;
  for (const double slope : kStartSlopes) {
    for (const double logit_f0 : kStartLogitF0) {
      std::vector<double> start(kParameters);
      for (int c = 0; c < 3; ++c) {
        start[3 + c] = LogAlbedo(*samples, c);
        start[c] = start[3 + c] - 1.0;
      }
      start[6] = std::log(slope);
      start[7] = logit_f0;
      starts.push_back(start);
    }
  }
  const std::vector<double> best =
      BestOf(starts,
             {kLogColour, kLogColour, kLogColour, kLogColour, kLogColour,
              kLogColour, kLogSlope, kLogit},
             options.solver, &cost);
  CookTorrance brdf;
  for (int c = 0; c < 3; ++c) {
    FromLogParameters(channel(best.data(), c), c, &brdf);
  }
  return brdf;
}

StatusOr<Disney> FitDisney(const MerlTable& table,
                           const TableFitOptions& options) {
  const StatusOr<std::vector<TableSample>> samples =
      SampleBins(table, options.seed);
  if (!samples.ok()) return samples.status();
  std::vector<DisneyGeometry> geometry;
  for (const TableSample& s : *samples) {
    geometry.emplace_back(s.theta_h, s.theta_d, s.phi_d);
  }
  TableCost cost(*samples, {0, 3}, kDisneyParameters,
                 [&](const double* p, size_t i, int c, double* gradient) {
                   DisneyLog slope;
                   const double f = EvaluateDisney(
                       Eigen::Map<const DisneyLog>(p), geometry[i], c,
                       gradient != nullptr ? &slope : nullptr);
                   if (gradient != nullptr) {
                     std::copy_n(slope.data(), kDisneyParameters, gradient);
                   }
                   return f;
                 });
  std::vector<std::vector<double>> starts;
  for (const double logit_roughness : {-2.0, -0.5, 1.0}) {
    for (const double logit_metallic : {-3.0, 2.0}) {
      std::vector<double> start(kDisneyParameters);
      for (int c = 0; c < 3; ++c) start[c] = LogAlbedo(*samples, c);
      start[3] = logit_roughness;
      start[4] = logit_metallic;
      start[5] = -3.0;
      starts.push_back(start);
    }
  }
  const std::vector<double> best = BestOf(
      starts,
      {kLogColour, kLogColour, kLogColour, kLogitRoughness, kLogit, kLogit},
      options.solver, &cost);
  return FromLogParameters(Eigen::Map<const DisneyLog>(best.data()));
}

}  // namespace ibrdf
