// The metrics between two files, as ibrdf_eval prints them.
#pragma once
#include <optional>
#include <string>
#include <utility>
#include <vector>

#include "ibrdf/base/status.h"
#include "ibrdf/light/map_frame.h"

namespace ibrdf {

// Name, as in result.json and results.csv, and value.
using NamedMetrics = std::vector<std::pair<std::string, double>>;

// Each compares the file of an estimate with that of a reference; the message
// of a failure starts with the path of the file at fault.

// MERL tables: brdf_log_rmse, brdf_log_rmse_aligned, brdf_log_rmse_below80,
// brdf_log_rmse_aligned_below80. Bins with a direction further from the normal
// than `void_beyond`, degrees in (0, 90], play no part.
StatusOr<NamedMetrics> EvaluateBrdfFiles(const std::string& estimate,
                                         const std::string& reference,
                                         double void_beyond = 90.0);

// A file of a map and its frame; unset: as ReadStoredMap finds it.
struct MapToCompare {
  std::string path;
  std::optional<MapFrame> frame;
};

struct IlluminationComparison {
  // illumination_relative_log_rmse, the same with _aligned and _unweighted.
  NamedMetrics metrics;
  MapSize compared_at;
  std::vector<std::string> warnings;  // of the files: sentences for the user
};

// Both maps are brought to the frame camera, and the finer one to the size of
// the coarser by means over solid angles.
StatusOr<IlluminationComparison> EvaluateIlluminationFiles(
    const MapToCompare& estimate, const MapToCompare& reference);

// .exr or .hdr images of one size: image_log_rmse, psnr, dssim. `mask`: PNG, or
// empty for all pixels.
StatusOr<NamedMetrics> EvaluateImageFiles(const std::string& estimate,
                                          const std::string& reference,
                                          const std::string& mask);

// Albedo at an object's pixels: .exr, or any file that ReadPhoto reads, whose
// whole numbers are linear and 1 at the largest. albedo_log_rmse, the same with
// _aligned, albedo_psnr, albedo_dssim, albedo_lmse (AlbedoMapMetrics).
StatusOr<NamedMetrics> EvaluateAlbedoFiles(const std::string& estimate,
                                           const std::string& reference,
                                           const std::string& mask);

}  // namespace ibrdf
