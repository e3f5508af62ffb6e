#include "ibrdf/solvers/estimation/optimum_average.h"

#include <glog/logging.h>

#include <algorithm>
#include <cmath>
#include <memory>
#include <utility>
#include <vector>

#include "ibrdf/brdf/flow_lobes.h"
#include "ibrdf/metrics/log_difference.h"
#include "ibrdf/solvers/estimation/lobe_distance.h"
#include "ibrdf/solvers/table_fit/lobe_table_fit.h"

namespace ibrdf {
namespace {

constexpr double kTemperature = 20.0;  // nats
constexpr double kLeastWeight = 0.01;

// A local optimum with one of the models.
struct Optimum {
  size_t model = 0;
  const MaterialCandidate* candidate = nullptr;
  double weight = 0.0;  // > 0
};

// Those that count; none where no candidate has a finite cost.
std::vector<Optimum> WeightedOptima(const std::vector<ModelOptima>& models) {
  std::vector<Optimum> optima;
  std::vector<double> costs;
  for (size_t m = 0; m < models.size(); ++m) {
    for (const MaterialCandidate& c : models[m].estimate.candidates) {
      if (!std::isfinite(c.cost)) continue;
      optima.push_back({m, &c});
      costs.push_back(c.cost);
    }
  }
  const std::vector<double> weights = OptimumWeights(costs);
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

// The optimum's lobes at their level.
std::vector<double> LobesOf(const Optimum& optimum,
                            const std::vector<ModelOptima>& models) {
  std::vector<double> lobes = optimum.candidate->parameters;
  FixLevel(models[optimum.model], &lobes);
  return lobes;
}

// Root mean square of a - b, [3][bins]; aligned: after each channel's mean.
double LogRmse(const std::vector<float>& a, const std::vector<float>& b,
               bool aligned) {
  const size_t bins = a.size() / 3;
  LogDifferences differences;
  differences.Reserve(bins);
  const auto at = [&](size_t i) { return double{a[i]} - b[i]; };
  for (size_t i = 0; i < bins; ++i) {
    differences.Add({at(i), at(bins + i), at(2 * bins + i)}, 1.0);
  }
  return differences.Rms(aligned);
}

// The optima's logarithms at the bins of a table fit, which are the same of
// every model, and their mean by weight. (Nodes of a grid would not do: at
// theta_d = 90 degrees, where no bin is, lobes of two models are far apart.)
class LogMean {
 public:
  // model: whose lobes are to be near the mean; one of the optima is its.
  LogMean(size_t model, const std::vector<Optimum>& optima,
          const std::vector<ModelOptima>& models);

  double DistanceOf(const std::vector<double>& lobes) const;
  // Root mean square of the optima's distances from lobes, by weight.
  double Spread(const std::vector<double>& lobes, bool aligned) const;
  // The lobes that are nearest to the mean, from the best of starts; no
  // parameters where no fit comes to anything.
  LobeTableFit Nearest(const std::vector<std::vector<double>>& starts) const;

 private:
  static LobeTableFitOptions OptionsOf(const InverseProblem& problem);

  const LobeTableFitOptions options_;
  std::unique_ptr<const LobeTableFitter> fitter_;
  std::vector<double> weights_;             // of the optima
  std::vector<std::vector<float>> values_;  // of each, [3][bins]
  std::vector<float> mean_;
};

LobeTableFitOptions LogMean::OptionsOf(const InverseProblem& problem) {
  LobeTableFitOptions options;
  options.num_threads = problem.num_threads;
  // Without fits of materials it is the prior of the search (LobePrior).
  if (problem.model->fit_lobes == 0) options.prior_sigma = problem.prior_sigma;
  return options;
}

LogMean::LogMean(size_t model, const std::vector<Optimum>& optima,
                 const std::vector<ModelOptima>& models)
    : options_(OptionsOf(*models[model].setup->problem)) {
  std::vector<std::unique_ptr<const LobeTableFitter>> fitters(models.size());
  std::vector<double> sum;
  for (const Optimum& optimum : optima) {
    std::unique_ptr<const LobeTableFitter>& fitter = fitters[optimum.model];
    if (fitter == nullptr) {
      fitter = std::make_unique<const LobeTableFitter>(
          *models[optimum.model].setup->problem->model);
    }
    weights_.push_back(optimum.weight);
    values_.push_back(fitter->LogValues(LobesOf(optimum, models), options_));
    sum.resize(values_.back().size());
    for (size_t i = 0; i < sum.size(); ++i) {
      sum[i] += optimum.weight * values_.back()[i];
    }
  }
  mean_.assign(sum.begin(), sum.end());
  fitter_ = std::move(fitters[model]);
}

double LogMean::DistanceOf(const std::vector<double>& lobes) const {
  return LogRmse(fitter_->LogValues(lobes, options_), mean_, /*aligned=*/false);
}

double LogMean::Spread(const std::vector<double>& lobes, bool aligned) const {
  const std::vector<float> values = fitter_->LogValues(lobes, options_);
  double squares = 0.0;
  for (size_t k = 0; k < values_.size(); ++k) {
    const double distance = LogRmse(values_[k], values, aligned);
    squares += weights_[k] * distance * distance;
  }
  return std::sqrt(squares);
}

LobeTableFit LogMean::Nearest(
    const std::vector<std::vector<double>>& starts) const {
  LobeTableFit best;
  for (const std::vector<double>& start : starts) {
    StatusOr<LobeTableFit> fit = fitter_->FitLogValues(mean_, start, options_);
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
  const ModelOptima& model = models[out->model];
  std::vector<std::vector<double>> starts;
  for (const Optimum& optimum : optima) {
    if (optimum.model == out->model) {
      starts.push_back(optimum.candidate->parameters);
    }
  }
  const LogMean mean(out->model, optima, models);
  LobeTableFit fit = mean.Nearest(starts);
  ReflectanceEstimate& estimate = out->estimate;
  // Lobes that are held, as by a narrow prior, may not come near the mean.
  if (fit.parameters.empty() ||
      !(fit.log_rmse < mean.DistanceOf(estimate.lobes))) {
    return;
  }
  std::vector<double>& lobes = fit.parameters;
  FixLevel(model, &lobes);
  const LobeDistance metric(FlowLobes::Factory(
      *model.setup->problem->model, model.setup->lobes->layout(),
      model.setup->problem->num_threads));
  Dim(metric.MeanDifference(metric.LogValues(lobes),
                            metric.LogValues(estimate.lobes)),
      &estimate.light.mode);
  // Where the light is unknown no image tells the level.
  estimate.between_optima = mean.Spread(lobes, model.gauge != nullptr);
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

OptimumAverage AverageOptima(const std::vector<ModelOptima>& models) {
  CHECK(!models.empty());
  const std::vector<Optimum> optima = WeightedOptima(models);
  OptimumAverage out;
  out.model_weights.assign(models.size(), 0.0);
  if (optima.empty()) {
    out.model_weights.front() = 1.0;
    out.estimate = models.front().estimate;
    return out;
  }
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
