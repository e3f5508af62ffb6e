#include "ibrdf/solvers/solve/reflectance_band.h"

#include <algorithm>
#include <cmath>
#include <utility>

#include "ibrdf/base/pi.h"
#include "ibrdf/base/quantile.h"
#include "ibrdf/solvers/solve/reflectance_samples.h"

namespace ibrdf {
namespace {

// theta_d every 7.5 degrees; phi_d of 0 and 90.
constexpr BrdfGridShape kSliceGrid = {40, 13, 2};
constexpr int kRightAngle = 1;  // of phi_d
constexpr double kLowShare = 0.05, kHighShare = 0.95;

// Nodes along a slice, and its angles there.
struct SliceNodes {
  BrdfSlice slice;
  std::vector<int> nodes;
};

void AddNode(int ih, int id, int angle, SliceNodes* to) {
  const int node = kSliceGrid.Node(ih, id, kRightAngle);
  to->nodes.push_back(node);
  to->slice.degrees.push_back(kSliceGrid.NodeAngles(node)[angle] * 180.0 / kPi);
}

std::vector<SliceNodes> Slices() {
  std::vector<SliceNodes> out;
  for (const auto& [name, id] :
       {std::pair("light and view alike (theta_d = 0)", 0),
        std::pair("light and view a right angle apart (theta_d = 45 degrees)",
                  (kSliceGrid.d - 1) / 2)}) {
    SliceNodes along;
    along.slice.name = name;
    along.slice.angle = "normal to half-vector, theta_h (degrees)";
    for (int ih = 0; ih < kSliceGrid.h; ++ih) AddNode(ih, id, 0, &along);
    out.push_back(std::move(along));
  }
  SliceNodes mirror;
  mirror.slice.name = "in the direction of the mirror (theta_h = 0)";
  mirror.slice.angle = "half-vector to light, theta_d (degrees)";
  for (int id = 0; id < kSliceGrid.d; ++id) AddNode(0, id, 1, &mirror);
  out.push_back(std::move(mirror));
  return out;
}

// Multiplies a sample's channels by the scale that brings them nearest to the
// estimate.
void Align(const LobeDistance& level, const std::vector<double>& estimate,
           const std::vector<double>& sample, BrdfGrid* grid) {
  const Eigen::Array3d scale =
      level.MeanDifference(estimate, level.LogValues(sample)).exp();
  const size_t nodes = grid->values.size() / 3;
  for (size_t i = 0; i < grid->values.size(); ++i) {
    grid->values[i] *= static_cast<float>(scale[static_cast<int>(i / nodes)]);
  }
}

}  // namespace

std::vector<BrdfSlice> ReflectanceBand(const LobeFactory& lobes,
                                       const std::vector<double>& parameters,
                                       const std::vector<double>& covariance,
                                       int count, uint64_t seed,
                                       const LobeDistance* level) {
  const std::unique_ptr<const LobeModel> model = lobes(kSliceGrid);
  const std::vector<double> found =
      level != nullptr ? level->LogValues(parameters) : std::vector<double>();
  std::vector<BrdfGrid> grids;
  for (const std::vector<double>& sample :
       SampleReflectances(*model, parameters, covariance, count, seed)) {
    BrdfGrid grid = model->Grid(sample.data());
    if (level != nullptr) Align(*level, found, sample, &grid);
    if (std::all_of(grid.values.begin(), grid.values.end(),
                    [](float f) { return std::isfinite(f); })) {
      grids.push_back(std::move(grid));
    }
  }
  if (grids.empty()) return {};
  const BrdfGrid estimate = model->Grid(parameters.data());
  std::vector<BrdfSlice> out;
  for (SliceNodes& along : Slices()) {
    for (int c = 0; c < 3; ++c) {
      for (const int node : along.nodes) {
        std::vector<double> values;
        for (const BrdfGrid& grid : grids) {
          values.push_back(grid.Channel(c)[node]);
        }
        along.slice.value[c].push_back(estimate.Channel(c)[node]);
        along.slice.low[c].push_back(Quantile(values, kLowShare));
        along.slice.high[c].push_back(Quantile(values, kHighShare));
      }
    }
    out.push_back(std::move(along.slice));
  }
  return out;
}

}  // namespace ibrdf
