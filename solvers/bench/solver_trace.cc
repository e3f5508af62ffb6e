#include "ibrdf/solvers/bench/solver_trace.h"

#include <algorithm>
#include <nlohmann/json.hpp>

#include "ibrdf/io/atomic_file.h"
#include "ibrdf/solvers/bench/sweep_files.h"

namespace ibrdf {
namespace {

bool IsNumber(const nlohmann::json& line, const char* key) {
  const auto at = line.find(key);
  return at != line.end() && at->is_number();
}

}  // namespace

StatusOr<std::vector<TraceLine>> DecodeTrace(const std::string& path,
                                             const std::string& text) {
  const nlohmann::json json = nlohmann::json::parse(text, nullptr, false);
  if (!json.is_object() || !json.contains("trace") ||
      !json["trace"].is_array() || json["trace"].empty()) {
    return InvalidInput(path + ": trace", "expected a list of steps");
  }
  std::vector<TraceLine> trace;
  for (const nlohmann::json& line : json["trace"]) {
    if (!line.is_object() || !line.contains("stage") ||
        !line["stage"].is_string() || !IsNumber(line, "seconds") ||
        !IsNumber(line, "misfit") || !IsNumber(line, "scale") ||
        !IsNumber(line, "pixels")) {
      return InvalidInput(
          path + ": trace[" + std::to_string(trace.size()) + "]",
          "expected stage, seconds, scale, pixels and misfit");
    }
    // The search for the reflectance knows no scale.
    trace.push_back(
        {line["stage"].get<std::string>(), line["seconds"].get<double>(),
         line["misfit"].get<double>(), line["pixels"].get<int64_t>(),
         line["scale"].get<double>() > 0.0});
  }
  return trace;
}

StatusOr<std::vector<TraceLine>> ReadTrace(const std::string& result_json) {
  const StatusOr<std::string> text = ReadFile(result_json, kMaxResultBytes);
  if (!text.ok()) return text.status();
  return DecodeTrace(result_json, *text);
}

int CountIterations(const std::vector<TraceLine>& trace) {
  return static_cast<int>(
      std::count_if(trace.begin(), trace.end(), [](const TraceLine& line) {
        return line.stage.find(" iteration ") != std::string::npos;
      }));
}

const TraceLine* LastIteration(const std::vector<TraceLine>& trace) {
  const TraceLine* last = nullptr;
  for (const TraceLine& line : trace) {
    if (line.has_map && line.stage != "end") last = &line;
  }
  return last;
}

std::optional<double> SecondsToMisfit(const std::vector<TraceLine>& trace,
                                      const TraceLine& of) {
  for (const TraceLine& line : trace) {
    if (line.has_map && line.pixels == of.pixels && line.misfit <= of.misfit) {
      return line.seconds;
    }
  }
  return std::nullopt;
}

}  // namespace ibrdf
