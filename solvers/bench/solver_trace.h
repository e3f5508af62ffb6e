// The trace that ibrdf_solve leaves in result.json.
#pragma once
#include <cstdint>
#include <optional>
#include <string>
#include <vector>

#include "ibrdf/base/status.h"

namespace ibrdf {

struct TraceLine {
  std::string stage;
  double seconds = 0.0;
  double misfit = 0.0;
  int64_t pixels = 0;  // that took part
  // False in the search for the reflectance with the light integrated out:
  // its misfit is of normal-binned pixels and of no map.
  bool has_map = false;
};

// The trace in the text of the file `path`. Fails, naming the file, where it
// holds no whole trace.
StatusOr<std::vector<TraceLine>> DecodeTrace(const std::string& path,
                                             const std::string& text);
StatusOr<std::vector<TraceLine>> ReadTrace(const std::string& result_json);

// Steps of the optimiser of the map, or of both unknowns, that lowered the
// cost: lines "STAGE iteration N". With Adam each is one alternation of
// its schedule.
int CountIterations(const std::vector<TraceLine>& trace);

// The last line with a map before the end, whose misfit is of all pixels; null:
// there is none.
const TraceLine* LastIteration(const std::vector<TraceLine>& trace);

// Seconds until a map and a reflectance had at most the misfit of a line on as
// many pixels: binned ones have less noise. None: never.
std::optional<double> SecondsToMisfit(const std::vector<TraceLine>& trace,
                                      const TraceLine& of);

}  // namespace ibrdf
