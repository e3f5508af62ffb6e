#include "ibrdf/solvers/training/checkpoint.h"

#include <sys/stat.h>

#include <cmath>
#include <cstring>
#include <sstream>

#include "ibrdf/io/atomic_file.h"
#include "ibrdf/io/checksum.h"
#include "ibrdf/solvers/training/flow_trainer.h"

namespace ibrdf {
namespace {

constexpr char kMagic[] = "ibrdf-checkpoint 3\n";
constexpr size_t kMaxBytes = size_t{1} << 30;

template <typename T>
void Append(const std::vector<T>& values, std::string* bytes) {
  bytes->append(reinterpret_cast<const char*>(values.data()),
                values.size() * sizeof(T));
}

template <typename T>
void Take(const std::string& bytes, size_t* at, std::vector<T>* values) {
  std::memcpy(values->data(), bytes.data() + *at, values->size() * sizeof(T));
  *at += values->size() * sizeof(T);
}

}  // namespace

std::string DescribeTraining(const TrainerOptions& options,
                             const TrainingData& data) {
  std::ostringstream text;
  text.precision(17);
  const FlowShape& shape = options.shape;
  if (shape.architecture == FlowArchitecture::kTriangular) {
    text << "triangular bins";
    for (const int n : shape.triangular.bins) text << ' ' << n;
    text << " widths";
    for (const int w : shape.triangular.widths) text << ' ' << w;
    text << " marginal";
    for (const int w : shape.triangular.marginal_widths) text << ' ' << w;
  } else {
    text << "coupling layers " << shape.coupling.layers << " bins "
         << shape.coupling.bins << " widths";
    for (const int w : shape.coupling.widths) text << ' ' << w;
  }
  text << " code " << shape.code_size() << " exponent " << options.exponent
       << " steps " << options.steps << " batch " << options.codes_per_step
       << 'x' << options.columns_per_code << 'x' << options.points_per_column
       << " rates " << options.learning_rate << ' '
       << options.code_learning_rate << " huber " << options.huber << " seed "
       << options.seed << " columns " << data.num_columns();
  // The data themselves: their names and a sum that any change moves.
  double sum = 0.0;
  for (size_t i = 0; i < data.log_raw.size(); ++i) {
    sum += data.log_raw[i] * (1.0 + static_cast<double>(i % 1009));
  }
  for (const std::string& name : data.names) text << ' ' << name;
  text << " sum " << sum;
  return text.str();
}

Status SaveCheckpoint(const std::string& path, const std::string& identity,
                      const TrainingState& state) {
  std::string bytes = kMagic + identity + "\n";
  bytes.append(reinterpret_cast<const char*>(&state.step), sizeof(state.step));
  bytes.append(reinterpret_cast<const char*>(&state.seconds),
               sizeof(state.seconds));
  Append(state.weights, &bytes);
  Append(state.codes, &bytes);
  Append(state.weight_adam.mean, &bytes);
  Append(state.weight_adam.square, &bytes);
  Append(state.code_adam.mean, &bytes);
  Append(state.code_adam.square, &bytes);
  Append(state.code_steps, &bytes);
  const uint64_t checksum = Fnv1a(bytes.data(), bytes.size());
  bytes.append(reinterpret_cast<const char*>(&checksum), sizeof(checksum));
  return WriteFileAtomically(path, bytes);
}

Status DecodeCheckpoint(const std::string& path, const std::string& bytes,
                        const std::string& identity, TrainingState* state) {
  const std::string head = kMagic + identity + "\n";
  if (bytes.compare(0, head.size(), head) != 0) {
    return InvalidInput(path,
                        "checkpoint of another training (options or data "
                        "differ); remove it to start afresh");
  }
  size_t at = head.size();
  const size_t floats = 3 * (state->weights.size() + state->codes.size());
  const size_t expected = at + sizeof(state->step) + sizeof(state->seconds) +
                          floats * sizeof(float) +
                          state->code_steps.size() * sizeof(int64_t) +
                          sizeof(uint64_t);
  if (bytes.size() != expected) {
    return InvalidInput(path, "truncated checkpoint, expected " +
                                  std::to_string(expected) + " bytes");
  }
  uint64_t checksum = 0;
  std::memcpy(&checksum, bytes.data() + expected - sizeof(checksum),
              sizeof(checksum));
  if (checksum != Fnv1a(bytes.data(), expected - sizeof(checksum))) {
    return InvalidInput(path + ": checksum",
                        "does not match, the file is damaged; remove it to "
                        "start afresh");
  }
  std::memcpy(&state->step, bytes.data() + at, sizeof(state->step));
  at += sizeof(state->step);
  std::memcpy(&state->seconds, bytes.data() + at, sizeof(state->seconds));
  at += sizeof(state->seconds);
  Take(bytes, &at, &state->weights);
  Take(bytes, &at, &state->codes);
  Take(bytes, &at, &state->weight_adam.mean);
  Take(bytes, &at, &state->weight_adam.square);
  Take(bytes, &at, &state->code_adam.mean);
  Take(bytes, &at, &state->code_adam.square);
  Take(bytes, &at, &state->code_steps);
  return OkStatus();
}

StatusOr<bool> LoadCheckpoint(const std::string& path,
                              const std::string& identity,
                              TrainingState* state) {
  struct stat info = {};
  if (::stat(path.c_str(), &info) != 0) return false;
  const StatusOr<std::string> bytes = ReadFile(path, kMaxBytes);
  if (!bytes.ok()) return bytes.status();
  IBRDF_RETURN_IF_ERROR(DecodeCheckpoint(path, *bytes, identity, state));
  return true;
}

}  // namespace ibrdf
