#include "ibrdf/solvers/estimation/optimum_average.h"

#include <glog/logging.h>

#include <algorithm>
#include <cmath>
#include <utility>

#include "ibrdf/metrics/brdf_metrics.h"
#include "ibrdf/solvers/table_fit/lobe_table_fit.h"

namespace ibrdf {
namespace {

constexpr double kTemperature = 20.0;  // nats
constexpr double kLeastWeight = 0.01;
constexpr double kFloor = 1e-6;  // raw units, as of CompareBrdfs

// A local optimum with one of the models.
struct Optimum {
  size_t model = 0;
  const MaterialCandidate* candidate = nullptr;
  double weight = 0.0;  // > 0
};

// Those that count, at least one.
std::vector<Optimum> WeightedOptima(const std::vector<ModelOptima>& models) {
  std::vector<Optimum> optima;
  std::vector<double> costs;
  for (size_t m = 0; m < models.size(); ++m) {
    for (const MaterialCandidate& c : models[m].estimate.candidates) {
      optima.push_back({m, &c});
      costs.push_back(c.cost);
    }
  }
  const std::vector<double> weights = OptimumWeights(costs);
  CHECK(!optima.empty());
  for (size_t k = 0; k < optima.size(); ++k) optima[k].weight = weights[k];
  optima.erase(std::remove_if(optima.begin(), optima.end(),
                              [](const Optimum& o) { return o.weight == 0.0; }),
               optima.end());
  return optima;
}

// At the level of the model's materials where no image tells it.
void FixLevel(const ModelOptima& of, std::vector<double>* lobes) {
  if (of.gauge != nullptr) of.gauge->Fix(lobes->data());
}

// The optimum's table at its level.
MerlTable TableOf(const Optimum& optimum,
                  const std::vector<ModelOptima>& models) {
  const ModelOptima& of = models[optimum.model];
  std::vector<double> lobes = optimum.candidate->parameters;
  FixLevel(of, &lobes);
  return of.setup->lobes->ToMerl(lobes.data());
}

// Root mean square of the optima's distances from a table, by weight.
double DistanceFrom(const MerlTable& table, const std::vector<Optimum>& optima,
                    const std::vector<ModelOptima>& models) {
  double squares = 0.0;
  for (const Optimum& optimum : optima) {
    const StatusOr<BrdfMetrics> metrics =
        CompareBrdfs(TableOf(optimum, models), table);
    if (!metrics.ok()) continue;  // the table is black
    const double distance = models[optimum.model].gauge != nullptr
                                ? metrics->log_rmse_aligned
                                : metrics->log_rmse;
    squares += optimum.weight * distance * distance;
  }
  return std::sqrt(squares);
}

// Mean of log(raw + floor) over the bins above the horizon, by channel.
Eigen::Array3d MeanLog(const MerlTable& table) {
  Eigen::Array3d sum = Eigen::Array3d::Zero(), count = sum;
  for (int c = 0; c < 3; ++c) {
    for (int bin = 0; bin < kMerlBins; ++bin) {
      const double raw = table.Raw(c, bin);
      if (raw < 0.0) continue;
      sum[c] += std::log(raw + kFloor);
      count[c] += 1.0;
    }
  }
  return sum / count.max(1.0);
}

// The lobes of a model that are nearest to a table, from the best of starts; no
// parameters where no fit comes to anything.
LobeTableFit NearestLobes(const MerlTable& table, const SolveSetup& setup,
                          const std::vector<std::vector<double>>& starts) {
  const InverseProblem& problem = *setup.problem;
  const LobeTableFitter fitter(*problem.model);
  LobeTableFitOptions options;
  options.num_threads = problem.num_threads;
  // Without fits of materials it is the prior of the search (LobePrior).
  if (problem.model->fit_lobes == 0) options.prior_sigma = problem.prior_sigma;
  LobeTableFit best;
  for (const std::vector<double>& start : starts) {
    StatusOr<LobeTableFit> fit = fitter.FitFrom(table, start, options);
    if (!fit.ok()) continue;
    if (best.parameters.empty() || fit->log_rmse < best.log_rmse) {
      best = *std::move(fit);
    }
  }
  VLOG(1) << "lobes nearest to the mean of optima: log-RMSE " << best.log_rmse;
  return best;
}

// The light's log radiance falls by what the reflectance's rises.
void Dim(const Eigen::Array3d& level, LogMap* mode) {
  for (int c = 0; c < 3; ++c) {
    mode->Plane(c).array() -= static_cast<float>(level[c]);
  }
}

// Puts the mean of the optima in the place of the best one.
void TakeMean(const std::vector<Optimum>& optima,
              const std::vector<ModelOptima>& models, OptimumAverage* out) {
  const SolveSetup& setup = *models[out->model].setup;
  LogTableMean mean;
  std::vector<std::vector<double>> starts;
  for (const Optimum& optimum : optima) {
    mean.Add(TableOf(optimum, models), optimum.weight);
    if (optimum.model == out->model) {
      starts.push_back(optimum.candidate->parameters);
    }
  }
  const MerlTable middle = mean.Mean();
  LobeTableFit fit = NearestLobes(middle, setup, starts);
  const MerlTable before = setup.lobes->ToMerl(out->estimate.lobes.data());
  const StatusOr<BrdfMetrics> of_best = CompareBrdfs(before, middle);
  // Lobes that are held, as by a narrow prior, may not come near the mean.
  if (fit.parameters.empty() || !of_best.ok() ||
      !(fit.log_rmse < of_best->log_rmse)) {
    return;
  }
  std::vector<double>& lobes = fit.parameters;
  FixLevel(models[out->model], &lobes);
  ReflectanceEstimate& estimate = out->estimate;
  const MerlTable found = setup.lobes->ToMerl(lobes.data());
  Dim(MeanLog(found) - MeanLog(before), &estimate.light.mode);
  estimate.between_optima = DistanceFrom(found, optima, models);
  estimate.lobes = std::move(lobes);
}

}  // namespace

std::vector<double> OptimumWeights(const std::vector<double>& costs) {
  std::vector<double> weights;
  if (costs.empty()) return weights;
  const double least = *std::min_element(costs.begin(), costs.end());
  const auto normalise = [&weights] {
    double sum = 0.0;
    for (const double w : weights) sum += w;
    for (double& w : weights) w /= sum;
  };
  for (const double cost : costs) {
    CHECK(std::isfinite(cost));
    weights.push_back(std::exp(-(cost - least) / kTemperature));
  }
  normalise();
  for (double& w : weights) {
    if (w < kLeastWeight) w = 0.0;
  }
  normalise();
  return weights;
}

void LogTableMean::Add(const MerlTable& table, double weight) {
  CHECK_GT(weight, 0.0);
  // A bin without a value has none in the mean.
  if (sum_.empty()) sum_.assign(table.raw.size(), 0.0);
  CHECK_EQ(sum_.size(), table.raw.size());
  for (size_t i = 0; i < sum_.size(); ++i) {
    sum_[i] += weight * std::log(table.raw[i] + kFloor);
  }
  weight_ += weight;
}

MerlTable LogTableMean::Mean() const {
  CHECK_GT(weight_, 0.0);
  MerlTable mean;
  mean.raw.reserve(sum_.size());
  for (const double sum : sum_) {
    const double raw = std::exp(sum / weight_) - kFloor;
    mean.raw.push_back(std::isfinite(sum) ? std::max(raw, 0.0) : -1.0);
  }
  return mean;
}

OptimumAverage AverageOptima(const std::vector<ModelOptima>& models) {
  CHECK(!models.empty());
  const std::vector<Optimum> optima = WeightedOptima(models);
  OptimumAverage out;
  out.model_weights.assign(models.size(), 0.0);
  const Optimum* best = &optima.front();
  for (const Optimum& optimum : optima) {
    out.model_weights[optimum.model] += optimum.weight;
    if (optimum.candidate->cost < best->candidate->cost) best = &optimum;
  }
  out.model = best->model;
  out.estimate = models[out.model].estimate;
  if (optima.size() > 1) TakeMean(optima, models, &out);
  return out;
}

}  // namespace ibrdf
