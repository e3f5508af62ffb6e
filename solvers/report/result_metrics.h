// How good a solution is: against the image, and against the truth where the
// problem names it.
#pragma once
#include <limits>
#include <optional>
#include <string>
#include <vector>

#include "ibrdf/base/status.h"
#include "ibrdf/metrics/brdf_metrics.h"
#include "ibrdf/metrics/illumination_metrics.h"
#include "ibrdf/metrics/image_metrics.h"
#include "ibrdf/solvers/estimation/solution.h"
#include "ibrdf/solvers/problem/inverse_problem.h"
#include "ibrdf/solvers/problem/truth.h"

namespace ibrdf {

struct ViewMisfit {
  std::string name;
  size_t pixels = 0;  // that took part
  // Mean |log render - log input| of them; NaN where there is none.
  double misfit = std::numeric_limits<double>::quiet_NaN();
};

struct ResultMetrics {
  double seconds = std::numeric_limits<double>::quiet_NaN();
  double misfit = std::numeric_limits<double>::quiet_NaN();
  // Against the truth of what was estimated.
  std::optional<BrdfMetrics> brdf;
  std::optional<IlluminationMetrics> illumination;
  std::optional<ImageMetrics> image;  // unset: no pixel compares
  // By view, in the sheet's order; empty: one photograph.
  std::vector<ViewMisfit> views;
};

// Fails where the truth cannot be compared with; LoadTruth refuses such files.
StatusOr<ResultMetrics> MeasureResult(const InverseProblem& inverse,
                                      const Truth& truth,
                                      const Solution& solution);

// What the image tells of the light, over the sphere and all channels.
struct DeterminedLight {
  double share = 0.0;          // of solid angle with less than kDetermined left
  double variance_left = 0.0;  // its mean
};

// variance_left: a map as Solution::map_variance_left, not empty.
DeterminedLight MeasureDetermined(const Image& variance_left);

// The standard deviation of log albedo over an object's pixels.
struct AlbedoDeviation {
  double median = 0.0;
  double most = 0.0;  // nine of ten pixels have less
};

// log_std: as Solution::albedo_log_std, not empty; points: at least one.
AlbedoDeviation MeasureAlbedoDeviation(const Image& log_std,
                                       const std::vector<ShadingPoint>& points);

struct NamedMetric {
  const char* name;  // as in result.json
  double value;      // may be infinite or NaN
};

// Those that are set, in the order of result.json.
std::vector<NamedMetric> ListMetrics(const ResultMetrics& metrics);

// "name value" of those that are finite.
std::vector<std::string> MetricLines(const ResultMetrics& metrics);

}  // namespace ibrdf
