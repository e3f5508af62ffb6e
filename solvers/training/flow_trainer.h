// Training of the conditional flow and its embedding (Chen et al. 2020,
// Sec. 4.3, with another objective: see TrainFlow).
#pragma once
#include <atomic>
#include <cstdint>
#include <functional>
#include <string>
#include <vector>

#include "ibrdf/base/status.h"
#include "ibrdf/flow/neural_brdf_model.h"
#include "ibrdf/solvers/table_fit/table_columns.h"

namespace ibrdf {

// docs/notes (reflectance_model) has the measurements.
struct TrainerOptions {
  FlowShape shape;
  // Reflectance is colour * density ^ exponent. Beyond 1 it brings what scaled
  // heights of the spline bring (0.129 and 0.131 for 0.147 in sample).
  double exponent = 1.0;
  // More steps fit better and do not generalise better: without analytic
  // materials 24 000 score 0.127 held out, 12 000 score 0.120.
  int64_t steps = 14000;
  // A step takes so many distributions, columns of each, and theta_h of each
  // column. 48 columns with 8 theta_h cost more and gained nothing per step.
  int codes_per_step = 32;
  int columns_per_code = 16;   // a multiple of BrdfFlow::TrainingColumns()
  int points_per_column = 32;  // coupling stack: a multiple of 4
  double learning_rate = 5e-3;
  double code_learning_rate = 2e-2;
  // Residuals (log) beyond this count linearly: tables that sit on their floor
  // in part would otherwise rule the gradient.
  double huber = 1.0;
  uint64_t seed = 1;
  int num_threads = 0;
  double report_seconds = 10.0;
  std::string checkpoint;  // path; empty: none
  double checkpoint_seconds = 60.0;

  // Names the first option that is out of range as ibrdf_train's flag.
  Status Check() const;
};

struct TrainerProgress {
  int64_t step = 0;
  double seconds = 0.0;
  double training_rmse = 0.0;  // log, running mean over the last reports' steps
  double held_out_rmse = 0.0;  // log, points never trained on, 24 distributions
};

// Minimises, over weights and codes, the mean over distributions m and points j
// of huber(exponent log q(x_j | z_m) + log c_m - log raw_mj), with c_m the best
// colour of each distribution. This is the log-RMSE that models are judged by;
// q stays a normalised density. Codes are projected to the unit ball after each
// step. Adam with cosine decay. The same seed gives the same bits for any
// number of threads, with or without a stop and resume at a checkpoint (an
// existing checkpoint of other options or data is refused).
//
// train: points to learn from. held_out: other points of the same
// distributions, for the score. report: called about every report_seconds.
// stop: set by the caller to end early; a checkpoint is written and
// kInterrupted returned.
StatusOr<NeuralBrdfModel> TrainFlow(
    const TrainingData& train, const TrainingData& held_out,
    const TrainerOptions& options,
    const std::function<void(const TrainerProgress&)>& report,
    const std::atomic<bool>* stop);

// log-RMSE of each distribution on `data`, with the model's codes and colours.
std::vector<double> ScoreModel(const NeuralBrdfModel& model,
                               const TrainingData& data, int num_threads);

}  // namespace ibrdf
