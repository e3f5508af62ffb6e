#include "ibrdf/solvers/estimation/light_gauge.h"

#include <vector>

#include "ibrdf/brdf/lobe_mixture.h"
#include "ibrdf/brdf/merl_table.h"
#include "ibrdf/light/environment_map.h"

namespace ibrdf {

Eigen::Array3d LightGaugeShift(SolverGauge gauge, const Image& map) {
  if (gauge == SolverGauge::kPrior) return Eigen::Array3d::Zero();
  const Eigen::Array3d log_mean = MeanRadiance(map).log();
  if (!log_mean.isFinite().all()) return Eigen::Array3d::Zero();
  if (gauge == SolverGauge::kUnitLight) return log_mean;
  return log_mean - log_mean.mean();
}

void SetGauge(SolverGauge gauge, int num_lobes, Solution* estimate) {
  const Eigen::Array3d shift = LightGaugeShift(gauge, estimate->map);
  const Eigen::Array3d scale = shift.exp();
  std::vector<float>& map = estimate->map.rgb;
  for (size_t i = 0; i < map.size(); ++i) {
    map[i] = static_cast<float>(map[i] / scale[i % 3]);
  }
  std::vector<double>& lobes = estimate->lobe_parameters;
  const int lobe_size = static_cast<int>(lobes.size()) / num_lobes;
  MutableLobeMixture({num_lobes, lobe_size - 3}, lobes.data())
      .ShiftColours(shift);
  std::vector<double>& raw = estimate->brdf.raw;
  for (size_t i = 0; i < raw.size(); ++i) {
    // Negative values mark invalid bins.
    if (raw[i] > 0.0) raw[i] *= scale[i / kMerlBins];
  }
}

}  // namespace ibrdf
