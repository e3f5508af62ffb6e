// The experiment `material-parameters`: measured materials as points of the
// parameters that entropy is over.
#pragma once
#include <atomic>
#include <functional>
#include <string>
#include <vector>

#include "ibrdf/base/status.h"
#include "ibrdf/brdf/disney.h"

namespace ibrdf {

struct MaterialParametersOptions {
  std::string data;  // folder of MERL .binary tables
  std::string out;   // folder of results
  const std::atomic<bool>* stop = nullptr;
  // A line per event; may be empty.
  std::function<void(const std::string&)> report;
};

// Columns of its results.csv, in order; the first names the row.
const std::vector<std::string>& MaterialParametersColumns();

// Parameters of the angular model that stand for a material: in [0, 1].
struct GlossParameters {
  double roughness;
  Eigen::Array3d Ks, Kd;
};
// Roughness and Kd are those of the fit. Fits to logarithms see little of a
// narrow peak's energy, so Ks is what the table reflects beyond Kd to 15
// degrees, and not below the fit's F_0. albedo: of the table, directional, >=
// 0.
GlossParameters GlossOf(const Disney& fit, const Eigen::Array3d& albedo);

// Fits the principled BRDF to every table (FitDisney), a row each. Rows that
// out/results.csv holds are not made again.
Status RunMaterialParameters(const MaterialParametersOptions& options);

}  // namespace ibrdf
