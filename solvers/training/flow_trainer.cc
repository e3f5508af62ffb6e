#include "ibrdf/solvers/training/flow_trainer.h"

#include <glog/logging.h>

#include <algorithm>
#include <chrono>
#include <cmath>
#include <numeric>
#include <random>

#include "ibrdf/base/parallel_for.h"
#include "ibrdf/base/pi.h"
#include "ibrdf/flow/brdf_flow.h"
#include "ibrdf/solvers/optim/adam.h"
#include "ibrdf/solvers/training/checkpoint.h"

namespace ibrdf {
namespace {

constexpr int64_t kWarmUpSteps = 200;
constexpr double kFinalRate = 0.01;  // over the first
constexpr double kGradientNorm = 1.0;
constexpr float kCodeStart = 0.3f;  // norm of the first codes
constexpr int kChunks = 8;          // gradient buffers, joined in order

double Seconds() {
  return std::chrono::duration<double>(
             std::chrono::steady_clock::now().time_since_epoch())
      .count();
}

// One code's share of a step: psi of the residuals after the best colour, 0
// where nothing was measured. Returns the sum of squared residuals.
double Residuals(const std::vector<float>& log_density,
                 const std::vector<float>& log_raw, double exponent,
                 double huber, std::vector<float>* psi) {
  const size_t n = log_raw.size();
  std::vector<double> r(n);
  double mean = 0.0, measured = 0.0;
  for (size_t i = 0; i < n; ++i) {
    if (log_raw[i] == kNotMeasured) continue;
    r[i] = exponent * log_density[i] - log_raw[i];
    mean += r[i];
    measured += 1.0;
  }
  mean /= std::max(measured, 1.0);
  double mean_psi = 0.0, sum = 0.0;
  for (size_t i = 0; i < n; ++i) {
    if (log_raw[i] == kNotMeasured) continue;
    r[i] -= mean;
    sum += r[i] * r[i];
    r[i] = std::clamp(r[i], -huber, huber);
    mean_psi += r[i];
  }
  mean_psi /= std::max(measured, 1.0);
  for (size_t i = 0; i < n; ++i) {
    (*psi)[i] =
        log_raw[i] == kNotMeasured ? 0.0f : static_cast<float>(r[i] - mean_psi);
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

// Shrinks the gradient to kGradientNorm where it is longer.
void ClipGradient(std::vector<float>* gradient) {
  double norm = 0.0;
  for (const float g : *gradient) norm += static_cast<double>(g) * g;
  norm = std::sqrt(norm);
  if (norm <= kGradientNorm) return;
  const float shrink = static_cast<float>(kGradientNorm / norm);
  for (float& g : *gradient) g *= shrink;
}

class Trainer {
 public:
  Trainer(const TrainingData& data, const TrainerOptions& options)
      : data_(data), options_(options), code_size_(options.shape.code_size()) {
    state_.weights = InitialFlowWeights(options.shape, options.seed);
    flow_ = BrdfFlow::Create(options.shape, state_.weights);
    state_.weight_adam = Adam(state_.weights.size());
    state_.codes.resize(data.names.size() * code_size_);
    state_.code_adam = Adam(state_.codes.size());
    state_.code_steps.assign(data.names.size(), 0);
    std::mt19937_64 rng(options.seed + 1);
    std::normal_distribution<float> normal;
    const float scale = kCodeStart / std::sqrt(static_cast<float>(code_size_));
    for (float& z : state_.codes) z = scale * normal(rng);
    for (Chunk& chunk : chunks_) {
      chunk.gradient.resize(flow_->GradientSize());
      chunk.pass = flow_->NewTrainingPass();
    }
  }

  TrainingState& state() { return state_; }

  // Call after the state was replaced.
  void StateLoaded() { flow_->SetWeights(state_.weights); }

  // Returns the mean squared residual of the step's points.
  double Step() {
    const Batch batch = DrawBatch();
    Gradients gradients = SumGradients(batch);
    ClipGradient(&gradients.weights);
    Update(batch, gradients);
    return gradients.squares / NumPoints(batch);
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
    std::unique_ptr<BrdfFlow::TrainingPass> pass;
  };
  // The distributions of a step, and a seed for the points of each.
  struct Batch {
    std::vector<int> distributions;
    std::vector<uint64_t> seeds;
    int size() const { return static_cast<int>(distributions.size()); }
  };
  struct Gradients {
    std::vector<float> weights;
    std::vector<float> codes;  // [batch][code_size_]
    double squares = 0.0;      // sum of squared residuals
  };

  double NumPoints(const Batch& batch) const {
    const int n = options_.columns_per_code * options_.points_per_column;
    return static_cast<double>(batch.size()) * n;
  }

  // A step's random numbers depend on seed and step alone: resuming needs no
  // generator state.
  Batch DrawBatch() const {
    std::mt19937_64 rng(options_.seed * 0x9e3779b97f4a7c15ULL + state_.step);
    Batch batch;
    batch.distributions.resize(data_.names.size());
    std::iota(batch.distributions.begin(), batch.distributions.end(), 0);
    std::shuffle(batch.distributions.begin(), batch.distributions.end(), rng);
    batch.distributions.resize(std::min(options_.codes_per_step, batch.size()));
    batch.seeds.resize(batch.distributions.size());
    for (uint64_t& s : batch.seeds) s = rng();
    return batch;
  }

  Gradients SumGradients(const Batch& batch) {
    Gradients out;
    out.codes.resize(static_cast<size_t>(batch.size()) * code_size_);
    std::vector<double> sums(batch.size());
    const double scale = options_.exponent / NumPoints(batch);
    ParallelFor(kChunks, options_.num_threads, [&](int64_t chunk, int) {
      const int begin = static_cast<int>(chunk * batch.size() / kChunks);
      const int end = static_cast<int>((chunk + 1) * batch.size() / kChunks);
      std::fill(chunks_[chunk].gradient.begin(), chunks_[chunk].gradient.end(),
                0.0f);
      if (begin == end) return;
      AddGradient(batch.distributions.data() + begin,
                  batch.seeds.data() + begin, end - begin, scale,
                  &chunks_[chunk], out.codes.data() + begin * code_size_,
                  sums.data() + begin);
    });
    out.weights.assign(state_.weights.size(), 0.0f);
    for (Chunk& c : chunks_) {
      flow_->AddGradient(c.gradient.data(), out.weights.data());
    }
    out.squares = std::accumulate(sums.begin(), sums.end(), 0.0);
    return out;
  }

  // Adam, of the weights and of the codes of the batch.
  void Update(const Batch& batch, const Gradients& gradients) {
    const double rate = Schedule();
    ++state_.step;
    state_.weight_adam.Step(gradients.weights.data(),
                            rate * options_.learning_rate, state_.step, 0,
                            gradients.weights.size(), state_.weights.data());
    for (int b = 0; b < batch.size(); ++b) {
      const int m = batch.distributions[b];
      state_.code_adam.Step(
          gradients.codes.data() + b * code_size_,
          rate * options_.code_learning_rate, ++state_.code_steps[m],
          static_cast<size_t>(m) * code_size_, code_size_, state_.codes.data());
      ProjectToUnitBall(state_.codes.data() + m * code_size_, code_size_);
    }
    flow_->SetWeights(state_.weights);
  }

  double Schedule() const {
    const double t =
        static_cast<double>(state_.step) / static_cast<double>(options_.steps);
    const double warm =
        std::min(1.0, (state_.step + 1.0) / static_cast<double>(kWarmUpSteps));
    return warm *
           (kFinalRate + (1 - kFinalRate) * 0.5 * (1 + std::cos(kPi * t)));
  }

  // The share of `count` distributions of a step; sums: of their squared
  // residuals.
  void AddGradient(const int* distributions, const uint64_t* seeds, int count,
                   double scale, Chunk* chunk, float* code_gradients,
                   double* sums) const {
    const int columns = options_.columns_per_code;
    const int points = options_.points_per_column;
    FlowColumns x(count * columns, points);
    const size_t per_code = static_cast<size_t>(columns) * points;
    std::vector<float> codes(static_cast<size_t>(count) * code_size_);
    std::vector<float> target(per_code * count), value(per_code * count);
    for (int b = 0; b < count; ++b) {
      std::copy_n(state_.codes.data() +
                      static_cast<size_t>(distributions[b]) * code_size_,
                  code_size_, codes.data() + b * code_size_);
      DrawPoints(distributions[b], seeds[b], b * columns, &x, target.data());
    }
    chunk->pass->Forward(x, count, codes.data(), value.data());
    std::vector<float> one_value(per_code), one_target(per_code), psi(per_code);
    for (int b = 0; b < count; ++b) {
      // [points][columns of all codes] <-> [points][columns of this one].
      const auto each = [&](auto f) {
        for (int i = 0; i < points; ++i) {
          for (int c = 0; c < columns; ++c) {
            f(static_cast<size_t>(i) * columns + c,
              static_cast<size_t>(i) * x.columns + b * columns + c);
          }
        }
      };
      each([&](size_t to, size_t from) {
        one_value[to] = value[from];
        one_target[to] = target[from];
      });
      sums[b] = Residuals(one_value, one_target, options_.exponent,
                          options_.huber, &psi);
      each([&](size_t from, size_t to) {
        value[to] = psi[from] * static_cast<float>(scale);
      });
    }
    chunk->pass->Backward(value.data(), chunk->gradient.data(), code_gradients);
  }

  // Random columns and, in each, theta_h from equal strata.
  void DrawPoints(int distribution, uint64_t seed, int first, FlowColumns* x,
                  float* target) const {
    std::mt19937_64 rng(seed);
    std::uniform_int_distribution<int> pick(0, data_.num_columns() - 1);
    std::uniform_real_distribution<float> uniform(0.0f, 1.0f);
    const int points = x->points;
    for (int c = first; c < first + options_.columns_per_code; ++c) {
      const int column = pick(rng);
      x->CopyColumn(c, data_.columns, column);
      const float* log_raw = data_.LogRaw(distribution, column);
      const int count = data_.count[column];
      const float stratum =
          static_cast<float>(count) / static_cast<float>(points);
      for (int i = 0; i < points; ++i) {
        const int at = std::min(
            count - 1,
            static_cast<int>((static_cast<float>(i) + uniform(rng)) * stratum));
        x->x_h[static_cast<size_t>(i) * x->columns + c] =
            data_.columns
                .x_h[static_cast<size_t>(at) * data_.num_columns() + column];
        target[static_cast<size_t>(i) * x->columns + c] = log_raw[at];
      }
    }
  }

  const TrainingData& data_;
  const TrainerOptions& options_;
  const int code_size_;
  std::unique_ptr<BrdfFlow> flow_;
  TrainingState state_;
  Chunk chunks_[kChunks];
};

// Calls f(distribution, log density, log raw) at every bin that was measured.
template <typename F>
void ForEachBin(const NeuralBrdfModel& model, const TrainingData& data,
                int num_threads, F f) {
  const std::unique_ptr<BrdfFlow> flow =
      BrdfFlow::Create(model.shape, model.weights);
  std::vector<float> value(data.columns.num_points());
  const int columns = data.num_columns(), size = model.shape.code_size();
  for (int m = 0; m < model.num_codes(); ++m) {
    flow->LogDensityOnColumns(data.columns, model.codes.data() + m * size,
                              num_threads, value.data(), nullptr);
    for (int c = 0; c < columns; ++c) {
      const float* log_raw = data.LogRaw(m, c);
      for (int i = 0; i < data.count[c]; ++i) {
        if (log_raw[i] == kNotMeasured) continue;
        f(m, value[static_cast<size_t>(i) * columns + c], log_raw[i]);
      }
    }
  }
}

// Residuals' mean per distribution is the log colour (with the sign turned).
void FitColours(const TrainingData& data, int num_threads,
                NeuralBrdfModel* model) {
  std::vector<double> sum(model->num_codes()), count(model->num_codes());
  ForEachBin(*model, data, num_threads, [&](int m, double value, double raw) {
    sum[m] += raw - model->exponent * value;
    count[m] += 1;
  });
  for (int m = 0; m < model->num_codes(); ++m) {
    model->log_colours[m] =
        static_cast<float>(sum[m] / std::max(count[m], 1.0));
  }
}

// Root mean square over a spread of distributions.
double QuickScore(const NeuralBrdfModel& model, const TrainingData& held_out,
                  int num_threads) {
  const int all = static_cast<int>(held_out.names.size());
  const int some = std::min(all, 24), size = model.shape.code_size();
  NeuralBrdfModel few = model;
  few.names.clear();
  few.codes.clear();
  std::vector<int> picked;
  for (int i = 0; i < some; ++i) {
    const int m = static_cast<int>(static_cast<int64_t>(i) * all / some);
    picked.push_back(m);
    few.names.push_back(model.names[m]);
    few.codes.insert(few.codes.end(), model.codes.begin() + m * size,
                     model.codes.begin() + (m + 1) * size);
  }
  few.log_colours.assign(some, 0.0f);
  const TrainingData part =
      held_out.Select(picked).Slice(0, std::min(128, held_out.num_columns()));
  FitColours(part, num_threads, &few);
  double sum = 0.0;
  for (const double s : ScoreModel(few, part, num_threads)) sum += s * s;
  return std::sqrt(sum / some);
}

}  // namespace

std::vector<double> ScoreModel(const NeuralBrdfModel& model,
                               const TrainingData& data, int num_threads) {
  std::vector<double> sum(model.num_codes()), count(model.num_codes());
  ForEachBin(model, data, num_threads, [&](int m, double value, double raw) {
    const double log_fit = model.exponent * value + model.log_colours[m];
    const double r = std::log(std::exp(log_fit) + kLogFloor) - raw;
    sum[m] += r * r;
    count[m] += 1;
  });
  for (int m = 0; m < model.num_codes(); ++m) {
    sum[m] = std::sqrt(sum[m] / count[m]);
  }
  return sum;
}

Status TrainerOptions::Check() const {
  const std::string wrong = shape.Validate();
  if (!wrong.empty()) return InvalidInput("command line", wrong);
  if (columns_per_code % 16 != 0) {
    return InvalidInput("command line: --columns-per-code",
                        "expected a multiple of 16");
  }
  if (points_per_column % 4 != 0) {
    return InvalidInput("command line: --points-per-column",
                        "expected a multiple of 4");
  }
  return OkStatus();
}

StatusOr<NeuralBrdfModel> TrainFlow(
    const TrainingData& train, const TrainingData& held_out,
    const TrainerOptions& options,
    const std::function<void(const TrainerProgress&)>& report,
    const std::atomic<bool>* stop) {
  IBRDF_RETURN_IF_ERROR(options.Check());
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
  FitColours(train.Slice(0, std::min(train.num_columns(), 512)),
             options.num_threads, &model);
  return model;
}

}  // namespace ibrdf
