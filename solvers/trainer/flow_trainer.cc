#include "solvers/trainer/flow_trainer.h"

#include <glog/logging.h>

#include <algorithm>
#include <chrono>
#include <cmath>
#include <numeric>
#include <random>

#include "ibrdf/base/parallel_for.h"
#include "ibrdf/flow/coupling_flow.h"
#include "solvers/trainer/adam.h"
#include "solvers/trainer/checkpoint.h"

namespace ibrdf {
namespace {

constexpr int64_t kWarmUpSteps = 200;
constexpr double kFinalRate = 0.01;  // of the first
constexpr double kGradientNorm = 1.0;
constexpr float kCodeStart = 0.3f;  // norm of the first codes
constexpr int kChunks = 8;          // gradient buffers, joined in order

double Seconds() {
  return std::chrono::duration<double>(
             std::chrono::steady_clock::now().time_since_epoch())
      .count();
}

// One code's share of a step: psi of the residuals after the best colour.
// Returns the sum of squared residuals.
double Residuals(const std::vector<float>& log_density,
                 const std::vector<float>& log_raw, double exponent,
                 double huber, std::vector<float>* psi) {
  const size_t n = log_raw.size();
  std::vector<double> r(n);
  double mean = 0.0;
  for (size_t i = 0; i < n; ++i) {
    r[i] = exponent * log_density[i] - log_raw[i];
    mean += r[i];
  }
  mean /= static_cast<double>(n);
  double mean_psi = 0.0, sum = 0.0;
  for (size_t i = 0; i < n; ++i) {
    r[i] -= mean;
    sum += r[i] * r[i];
    r[i] = std::clamp(r[i], -huber, huber);
    mean_psi += r[i];
  }
  mean_psi /= static_cast<double>(n);
  for (size_t i = 0; i < n; ++i) {
    (*psi)[i] = static_cast<float>(r[i] - mean_psi);
  }
  return sum;
}

void ProjectToUnitBall(float* code, int size) {
  double sum = 0.0;
  for (int k = 0; k < size; ++k) sum += static_cast<double>(code[k]) * code[k];
  if (sum <= 1.0) return;
  const float scale = static_cast<float>(1.0 / std::sqrt(sum));
  for (int k = 0; k < size; ++k) code[k] *= scale;
}

class Trainer {
 public:
  Trainer(const TrainingData& data, const TrainerOptions& options)
      : data_(data),
        options_(options),
        code_size_(options.shape.code_size),
        flow_(options.shape, InitialFlowWeights(options.shape, options.seed)) {
    state_.weights = flow_.weights();
    state_.weight_adam = Adam(state_.weights.size());
    state_.codes.resize(data.names.size() * code_size_);
    state_.code_adam = Adam(state_.codes.size());
    state_.code_steps.assign(data.names.size(), 0);
    std::mt19937_64 rng(options.seed + 1);
    std::normal_distribution<float> normal;
    const float scale = kCodeStart / std::sqrt(static_cast<float>(code_size_));
    for (float& z : state_.codes) z = scale * normal(rng);
    for (Chunk& chunk : chunks_) {
      chunk.gradient.resize(flow_.PaddedGradientSize());
    }
  }

  TrainingState& state() { return state_; }

  // Call after the state was replaced.
  void StateLoaded() { flow_.SetWeights(state_.weights); }

  // Returns the mean squared residual of the step's points.
  double Step() {
    // A step's random numbers depend on seed and step alone: resuming needs no
    // generator state.
    std::mt19937_64 rng(options_.seed * 0x9e3779b97f4a7c15ULL + state_.step);
    const int distributions = static_cast<int>(data_.names.size());
    std::vector<int> order(distributions);
    std::iota(order.begin(), order.end(), 0);
    std::shuffle(order.begin(), order.end(), rng);
    const int batch = std::min(options_.codes_per_step, distributions);
    const int n = options_.points_per_code;
    std::vector<uint64_t> seeds(batch);
    for (uint64_t& s : seeds) s = rng();

    std::vector<float> code_gradients(static_cast<size_t>(batch) * code_size_);
    std::vector<double> sums(batch);
    const double scale = options_.exponent / (static_cast<double>(batch) * n);
    ParallelFor(kChunks, options_.num_threads, [&](int64_t chunk, int) {
      Chunk& c = chunks_[chunk];
      std::fill(c.gradient.begin(), c.gradient.end(), 0.0f);
      for (int b = static_cast<int>(chunk); b < batch; b += kChunks) {
        sums[b] = AddGradient(order[b], seeds[b], scale, &c,
                              code_gradients.data() + b * code_size_);
      }
    });

    std::vector<float> gradient(state_.weights.size(), 0.0f);
    for (Chunk& c : chunks_) {
      flow_.UnpadGradient(c.gradient.data(), gradient.data());
    }
    double norm = 0.0;
    for (const float g : gradient) norm += static_cast<double>(g) * g;
    norm = std::sqrt(norm);
    if (norm > kGradientNorm) {
      const float shrink = static_cast<float>(kGradientNorm / norm);
      for (float& g : gradient) g *= shrink;
    }
    const double rate = Schedule();
    ++state_.step;
    state_.weight_adam.Step(gradient.data(), rate * options_.learning_rate,
                            state_.step, 0, gradient.size(),
                            state_.weights.data());
    for (int b = 0; b < batch; ++b) {
      const int m = order[b];
      state_.code_adam.Step(
          code_gradients.data() + b * code_size_,
          rate * options_.code_learning_rate, ++state_.code_steps[m],
          static_cast<size_t>(m) * code_size_, code_size_, state_.codes.data());
      ProjectToUnitBall(state_.codes.data() + m * code_size_, code_size_);
    }
    flow_.SetWeights(state_.weights);
    return std::accumulate(sums.begin(), sums.end(), 0.0) /
           (static_cast<double>(batch) * n);
  }

  NeuralBrdfModel Model() const {
    NeuralBrdfModel model;
    model.shape = options_.shape;
    model.exponent = options_.exponent;
    model.weights = state_.weights;
    model.names = data_.names;
    model.codes = state_.codes;
    model.log_colours.assign(data_.names.size(), 0.0f);
    return model;
  }

 private:
  struct Chunk {
    std::vector<float> gradient;
    std::vector<CouplingFlow::TrainingPass> passes;  // room, reused
  };

  double Schedule() const {
    const double t =
        static_cast<double>(state_.step) / static_cast<double>(options_.steps);
    const double warm =
        std::min(1.0, (state_.step + 1.0) / static_cast<double>(kWarmUpSteps));
    return warm *
           (kFinalRate + (1 - kFinalRate) * 0.5 * (1 + std::cos(M_PI * t)));
  }

  double AddGradient(int distribution, uint64_t seed, double scale,
                     Chunk* chunk, float* code_gradient) const {
    const int n = options_.points_per_code;
    const float* code =
        state_.codes.data() + static_cast<size_t>(distribution) * code_size_;
    const float* log_raw = data_.LogRaw(distribution);
    std::mt19937_64 rng(seed);
    std::uniform_int_distribution<int> pick(0, data_.num_points - 1);
    std::vector<float> x(3 * static_cast<size_t>(n)), target(n), value(n),
        psi(n);
    for (int p = 0; p < n; ++p) {
      const int at = pick(rng);
      const int block = p / kFlowBlock, lane = p % kFlowBlock;
      for (int i = 0; i < 3; ++i) {
        x[(block * 3 + i) * kFlowBlock + lane] =
            data_.x[static_cast<size_t>(i) * data_.num_points + at];
      }
      target[p] = log_raw[at];
    }
    const int blocks = n / kFlowBlock;
    std::vector<CouplingFlow::TrainingPass>& passes = chunk->passes;
    while (static_cast<int>(passes.size()) < blocks) passes.emplace_back(flow_);
    for (int b = 0; b < blocks; ++b) {
      passes[b].Forward(x.data() + b * 3 * kFlowBlock, code,
                        value.data() + b * kFlowBlock);
    }
    const double sum =
        Residuals(value, target, options_.exponent, options_.huber, &psi);
    for (float& v : psi) v *= static_cast<float>(scale);
    for (int b = 0; b < blocks; ++b) {
      passes[b].Backward(psi.data() + b * kFlowBlock, chunk->gradient.data(),
                         code_gradient);
    }
    return sum;
  }

  const TrainingData& data_;
  const TrainerOptions& options_;
  const int code_size_;
  CouplingFlow flow_;
  TrainingState state_;
  Chunk chunks_[kChunks];
};

// Residuals' mean per distribution is the log colour (with the sign turned).
void FitColours(const TrainingData& data, int num_threads,
                NeuralBrdfModel* model) {
  const CouplingFlow flow(model->shape, model->weights);
  std::vector<float> value(data.num_points);
  for (int m = 0; m < model->num_codes(); ++m) {
    flow.LogDensity(data.x.data(), data.num_points,
                    model->codes.data() + m * model->shape.code_size,
                    num_threads, value.data(), nullptr);
    double mean = 0.0;
    for (int p = 0; p < data.num_points; ++p) {
      mean += data.LogRaw(m)[p] - model->exponent * value[p];
    }
    model->log_colours[m] = static_cast<float>(mean / data.num_points);
  }
}

// Root mean square over a spread of distributions.
double QuickScore(NeuralBrdfModel model, const TrainingData& held_out,
                  int num_threads) {
  const int all = static_cast<int>(held_out.names.size());
  const int some = std::min(all, 24),
            points = std::min(2048, held_out.num_points);
  TrainingData part = held_out.Slice(0, points);
  NeuralBrdfModel few = model;
  few.names.clear();
  few.codes.clear();
  TrainingData picked;
  picked.num_points = points;
  picked.x = part.x;
  for (int i = 0; i < some; ++i) {
    const int m = static_cast<int>(static_cast<int64_t>(i) * all / some);
    few.names.push_back(model.names[m]);
    picked.names.push_back(model.names[m]);
    few.codes.insert(few.codes.end(),
                     model.codes.begin() + m * model.shape.code_size,
                     model.codes.begin() + (m + 1) * model.shape.code_size);
    picked.log_raw.insert(picked.log_raw.end(), part.LogRaw(m),
                          part.LogRaw(m) + points);
  }
  few.log_colours.assign(some, 0.0f);
  FitColours(picked, num_threads, &few);
  double sum = 0.0;
  for (const double s : ScoreModel(few, picked, num_threads)) sum += s * s;
  return std::sqrt(sum / some);
}

}  // namespace

std::vector<double> ScoreModel(const NeuralBrdfModel& model,
                               const TrainingData& data, int num_threads) {
  const CouplingFlow flow(model.shape, model.weights);
  std::vector<float> value(data.num_points);
  std::vector<double> scores;
  for (int m = 0; m < model.num_codes(); ++m) {
    flow.LogDensity(data.x.data(), data.num_points,
                    model.codes.data() + m * model.shape.code_size, num_threads,
                    value.data(), nullptr);
    double sum = 0.0;
    for (int p = 0; p < data.num_points; ++p) {
      const double log_fit = model.exponent * value[p] + model.log_colours[m];
      const double r =
          std::log(std::exp(log_fit) + kLogFloor) - data.LogRaw(m)[p];
      sum += r * r;
    }
    scores.push_back(std::sqrt(sum / data.num_points));
  }
  return scores;
}

StatusOr<NeuralBrdfModel> TrainFlow(
    const TrainingData& train, const TrainingData& held_out,
    const TrainerOptions& options,
    const std::function<void(const TrainerProgress&)>& report,
    const std::atomic<bool>* stop) {
  CHECK_EQ(0, options.points_per_code % kFlowBlock);
  Trainer trainer(train, options);
  const std::string identity = DescribeTraining(options, train);
  if (!options.checkpoint.empty()) {
    StatusOr<bool> found =
        LoadCheckpoint(options.checkpoint, identity, &trainer.state());
    if (!found.ok()) return found.status();
    if (*found) trainer.StateLoaded();
  }
  const double before = trainer.state().seconds, start = Seconds();
  double last_report = start, last_checkpoint = start, sum = 0.0;
  int64_t summed = 0;
  while (trainer.state().step < options.steps) {
    sum += trainer.Step();
    ++summed;
    const double now = Seconds();
    trainer.state().seconds = before + now - start;
    const bool last = trainer.state().step == options.steps;
    const bool stopped = stop != nullptr && stop->load();
    if (!options.checkpoint.empty() &&
        (last || stopped ||
         now - last_checkpoint > options.checkpoint_seconds)) {
      IBRDF_RETURN_IF_ERROR(
          SaveCheckpoint(options.checkpoint, identity, trainer.state()));
      last_checkpoint = now;
    }
    if (stopped) {
      return Status(
          StatusCode::kInterrupted,
          "training stopped at step " + std::to_string(trainer.state().step));
    }
    if (report && (last || now - last_report > options.report_seconds)) {
      report({trainer.state().step, trainer.state().seconds,
              std::sqrt(sum / static_cast<double>(summed)),
              QuickScore(trainer.Model(), held_out, options.num_threads)});
      last_report = now;
      sum = 0.0;
      summed = 0;
    }
  }
  NeuralBrdfModel model = trainer.Model();
  FitColours(train.Slice(0, std::min(train.num_points, 16384)),
             options.num_threads, &model);
  return model;
}

}  // namespace ibrdf
