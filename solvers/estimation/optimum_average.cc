#include "ibrdf/solvers/estimation/optimum_average.h"

#include <glog/logging.h>

#include <algorithm>
#include <cmath>
#include <memory>
#include <utility>

#include "ibrdf/solvers/estimation/scale_ambiguity.h"
#include "ibrdf/solvers/table_fit/lobe_table_fit.h"

namespace ibrdf {
namespace {

constexpr double kTemperature = 20.0;  // nats
constexpr double kLeastWeight = 0.01;
constexpr double kFloor = 1e-6;  // raw units, as of CompareBrdfs

// A local optimum of one of several searches.
struct Optimum {
  size_t model = 0;
  const MaterialCandidate* candidate = nullptr;
  double weight = 0.0;
};

std::vector<Optimum> WeightedOptima(const std::vector<ModelOptima>& searches) {
  std::vector<Optimum> optima;
  std::vector<double> costs;
  for (size_t m = 0; m < searches.size(); ++m) {
    for (const MaterialCandidate& c : searches[m].estimate.candidates) {
      optima.push_back({m, &c});
      costs.push_back(c.cost);
    }
  }
  const std::vector<double> weights = OptimumWeights(costs);
  for (size_t k = 0; k < optima.size(); ++k) optima[k].weight = weights[k];
  return optima;
}

// The table of an optimum at its model's level.
MerlTable TableOf(const Optimum& optimum, const LevelGauge& gauge,
                  const SolveSetup& setup) {
  std::vector<double> lobes = optimum.candidate->parameters;
  gauge.Fix(lobes.data());
  return setup.lobes->ToMerl(lobes.data());
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

// Root mean square over channels of the deviation of the logarithms' ratio.
double AlignedDistance(const MerlTable& a, const MerlTable& b) {
  double squares = 0.0;
  for (int c = 0; c < 3; ++c) {
    double sum = 0.0, square = 0.0, count = 0.0;
    for (int bin = 0; bin < kMerlBins; ++bin) {
      const double x = a.Raw(c, bin), y = b.Raw(c, bin);
      if (x < 0.0 || y < 0.0) continue;
      const double d = std::log((x + kFloor) / (y + kFloor));
      sum += d;
      square += d * d;
      count += 1.0;
    }
    if (count > 0.0) squares += square / count - sum * sum / (count * count);
  }
  return std::sqrt(std::max(squares, 0.0) / 3.0);
}

// The lobes of a model that are nearest to a table, from the best of starts;
// empty where no fit comes to anything.
std::vector<double> NearestLobes(
    const MerlTable& table, const SolveSetup& setup,
    const std::vector<std::vector<double>>& starts) {
  const InverseProblem& problem = *setup.problem;
  const LobeTableFitter fitter(*problem.model);
  LobeTableFitOptions options;
  options.num_threads = problem.num_threads;
  LobeTableFit best;
  for (const std::vector<double>& start : starts) {
    StatusOr<LobeTableFit> fit = fitter.FitFrom(table, start, options);
    if (!fit.ok()) continue;
    if (best.parameters.empty() || fit->log_rmse < best.log_rmse) {
      best = *std::move(fit);
    }
  }
  VLOG(1) << "lobes nearest to the mean of optima: log-RMSE " << best.log_rmse;
  return std::move(best.parameters);
}

// The light's log radiance falls by what the reflectance's rises.
void Dim(const Eigen::Array3d& level, LogMap* mode) {
  for (int c = 0; c < 3; ++c) {
    mode->Plane(c).array() -= static_cast<float>(level[c]);
  }
}

// Puts the mean of the optima in the place of the best one.
void TakeMean(const std::vector<Optimum>& optima,
              const std::vector<ModelOptima>& searches, OptimumAverage* out) {
  const SolveSetup& setup = *searches[out->model].setup;
  std::vector<std::unique_ptr<LevelGauge>> gauges;
  for (const ModelOptima& search : searches) {
    gauges.push_back(std::make_unique<LevelGauge>(
        *search.setup->problem->model, search.setup->materials,
        search.setup->problem->num_threads));
  }
  LogTableMean mean;
  std::vector<std::vector<double>> starts;
  for (const Optimum& optimum : optima) {
    if (optimum.weight == 0.0) continue;
    mean.Add(TableOf(optimum, *gauges[optimum.model],
                     *searches[optimum.model].setup),
             optimum.weight);
    if (optimum.model == out->model) {
      starts.push_back(optimum.candidate->parameters);
    }
  }
  std::vector<double> lobes = NearestLobes(mean.Mean(), setup, starts);
  if (lobes.empty()) return;
  gauges[out->model]->Fix(lobes.data());
  ReflectanceEstimate& estimate = out->estimate;
  const MerlTable found = setup.lobes->ToMerl(lobes.data());
  Dim(MeanLog(found) - MeanLog(setup.lobes->ToMerl(estimate.lobes.data())),
      &estimate.light.mode);
  double squares = 0.0;
  for (const Optimum& optimum : optima) {
    if (optimum.weight == 0.0) continue;
    const double distance =
        AlignedDistance(TableOf(optimum, *gauges[optimum.model],
                                *searches[optimum.model].setup),
                        found);
    squares += optimum.weight * distance * distance;
  }
  estimate.lobes = std::move(lobes);
  estimate.between_optima = std::sqrt(squares);
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

OptimumAverage AverageOptima(std::vector<ModelOptima> searches) {
  CHECK(!searches.empty());
  const std::vector<Optimum> optima = WeightedOptima(searches);
  CHECK(!optima.empty());
  OptimumAverage out;
  out.model_weights.assign(searches.size(), 0.0);
  size_t averaged = 0;
  const Optimum* best = &optima.front();
  for (const Optimum& optimum : optima) {
    out.model_weights[optimum.model] += optimum.weight;
    averaged += optimum.weight > 0.0 ? 1 : 0;
    if (optimum.candidate->cost < best->candidate->cost) best = &optimum;
  }
  out.model = best->model;
  out.estimate = searches[out.model].estimate;
  if (averaged > 1) TakeMean(optima, searches, &out);
  return out;
}

}  // namespace ibrdf
