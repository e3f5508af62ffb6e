// The metrics between two files, as ibrdf_eval prints them.
#pragma once
#include <string>
#include <utility>
#include <vector>

#include "ibrdf/base/status.h"

namespace ibrdf {

// Name, as in result.json and results.csv, and value.
using NamedMetrics = std::vector<std::pair<std::string, double>>;

// Each compares the file of an estimate with that of a reference; the message
// of a failure starts with the path of the file at fault.

// MERL tables: brdf_log_rmse, brdf_log_rmse_aligned, brdf_log_rmse_below80.
StatusOr<NamedMetrics> EvaluateBrdfFiles(const std::string& estimate,
                                         const std::string& reference);

// Equirectangular .exr or .hdr maps of one size:
// illumination_relative_log_rmse and the same with _aligned and _unweighted.
StatusOr<NamedMetrics> EvaluateIlluminationFiles(const std::string& estimate,
                                                 const std::string& reference);

// .exr or .hdr images of one size: image_log_rmse, psnr, dssim. `mask`: PNG, or
// empty for all pixels.
StatusOr<NamedMetrics> EvaluateImageFiles(const std::string& estimate,
                                          const std::string& reference,
                                          const std::string& mask);

}  // namespace ibrdf
