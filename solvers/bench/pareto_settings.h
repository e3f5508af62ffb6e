// What the sweep `pareto` varies.
#pragma once
#include <string>
#include <vector>

namespace ibrdf {

// The solver's side of a joint problem; the defaults are those of problem
// files.
struct ParetoPoint {
  std::string estimator = "marginal", method = "auto";
  double seconds = 120.0;
  int size = 128;       // of the image
  int map_width = 128;  // twice its height
  int lobes = 2;
  std::string prior = "process";
  int unet_channels = 32;  // of prior unet
  std::string quadrature = "standard", search = "auto";
  int turns = 2;
  int models = 2;  // of a pair: both, or 1 that is named `default`
  double tolerance = 1e-4;
  int max_iterations = 1000;

  bool operator==(const ParetoPoint& o) const;
};

// A name and what it changes of the default.
struct ParetoSetting {
  const char* name;
  void (*change)(ParetoPoint* point);
};

// `default` is the first.
const std::vector<ParetoSetting>& ParetoSettings();

}  // namespace ibrdf
