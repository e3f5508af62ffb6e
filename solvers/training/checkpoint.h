// State of an unfinished training on disk.
#pragma once
#include <cstdint>
#include <string>
#include <vector>

#include "ibrdf/base/status.h"
#include "ibrdf/solvers/optim/adam.h"

namespace ibrdf {

struct TrainerOptions;
struct TrainingData;

struct TrainingState {
  int64_t step = 0;
  double seconds = 0.0;
  std::vector<float> weights, codes;
  Adam weight_adam, code_adam;
  std::vector<int64_t> code_steps;  // Adam steps that each code has seen
};

// All that must agree between a checkpoint and the run that resumes it.
std::string DescribeTraining(const TrainerOptions& options,
                             const TrainingData& data);

Status SaveCheckpoint(const std::string& path, const std::string& identity,
                      const TrainingState& state);

// Reads the bytes of the file `path`. The sizes of `state` say what is
// expected; bytes of another identity, truncated or damaged are refused and
// leave `state` as it was.
Status DecodeCheckpoint(const std::string& path, const std::string& bytes,
                        const std::string& identity, TrainingState* state);

// False if there is no file.
StatusOr<bool> LoadCheckpoint(const std::string& path,
                              const std::string& identity,
                              TrainingState* state);

}  // namespace ibrdf
