#include "ibrdf/solvers/programs/evaluate_files.h"

#include <algorithm>

#include "ibrdf/brdf/void_bins.h"
#include "ibrdf/io/albedo_file.h"
#include "ibrdf/io/image_file.h"
#include "ibrdf/io/map_file.h"
#include "ibrdf/io/merl.h"
#include "ibrdf/io/png.h"
#include "ibrdf/light/convert_map.h"
#include "ibrdf/metrics/albedo_map_metrics.h"
#include "ibrdf/metrics/brdf_metrics.h"
#include "ibrdf/metrics/illumination_metrics.h"
#include "ibrdf/metrics/image_metrics.h"

namespace ibrdf {
namespace {

// Replaces the role at the start of a metric's message by the file's path.
Status NameFile(const Status& status,
                const std::vector<std::pair<std::string, std::string>>& roles) {
  for (const auto& [role, path] : roles) {
    if (status.message().compare(0, role.size(), role) == 0) {
      return Status(status.code(), path + status.message().substr(role.size()));
    }
  }
  return status;
}

int Rows(const StoredMap& map) {
  return RowsForSize(map.frame, {map.image.width, map.image.height});
}

// Empty without a path: all pixels.
StatusOr<Mask> ReadOptionalMask(const std::string& path) {
  if (path.empty()) return Mask();
  return ReadMask(path);
}

struct MaskedPaths {
  const std::string &estimate, &reference, &mask;  // mask: may be empty
};

// Reads and compares what a mask, if any, lets take part.
template <typename Metrics>
StatusOr<Metrics> CompareMasked(
    const MaskedPaths& paths, StatusOr<Image> (*read)(const std::string&),
    StatusOr<Metrics> (*compare)(const Image&, const Image&, const Mask&)) {
  const StatusOr<Image> a = read(paths.estimate);
  if (!a.ok()) return a.status();
  const StatusOr<Image> b = read(paths.reference);
  if (!b.ok()) return b.status();
  const StatusOr<Mask> inside = ReadOptionalMask(paths.mask);
  if (!inside.ok()) return inside.status();
  const StatusOr<Metrics> metrics = compare(*a, *b, *inside);
  if (metrics.ok()) return metrics;
  return NameFile(metrics.status(), {{"estimate", paths.estimate},
                                     {"reference", paths.reference},
                                     {"mask", paths.mask}});
}

}  // namespace

StatusOr<NamedMetrics> EvaluateBrdfFiles(const std::string& estimate,
                                         const std::string& reference,
                                         double void_beyond) {
  const StatusOr<MerlTable> a = ReadMerl(estimate);
  if (!a.ok()) return a.status();
  StatusOr<MerlTable> b = ReadMerl(reference);
  if (!b.ok()) return b.status();
  VoidBeyond(void_beyond, &*b);
  const StatusOr<BrdfMetrics> metrics = CompareBrdfs(*a, *b);
  if (!metrics.ok()) {
    return NameFile(metrics.status(),
                    {{"estimate", estimate}, {"reference", reference}});
  }
  return NamedMetrics{
      {"brdf_log_rmse", metrics->log_rmse},
      {"brdf_log_rmse_aligned", metrics->log_rmse_aligned},
      {"brdf_log_rmse_below80", metrics->log_rmse_below80},
      {"brdf_log_rmse_aligned_below80", metrics->log_rmse_aligned_below80}};
}

StatusOr<IlluminationComparison> EvaluateIlluminationFiles(
    const MapToCompare& estimate, const MapToCompare& reference) {
  const StatusOr<StoredMap> a = ReadStoredMap(estimate.path, estimate.frame);
  if (!a.ok()) return a.status();
  const StatusOr<StoredMap> b = ReadStoredMap(reference.path, reference.frame);
  if (!b.ok()) return b.status();
  IlluminationComparison out;
  out.warnings = a->warnings;
  out.warnings.insert(out.warnings.end(), b->warnings.begin(),
                      b->warnings.end());
  out.compared_at =
      SizeForRows(MapFrame::kCamera, std::min(Rows(*a), Rows(*b)));
  const StatusOr<Image> map_a = ConvertMap(estimate.path, a->image, a->frame,
                                           MapFrame::kCamera, out.compared_at);
  if (!map_a.ok()) return map_a.status();
  const StatusOr<Image> map_b = ConvertMap(reference.path, b->image, b->frame,
                                           MapFrame::kCamera, out.compared_at);
  if (!map_b.ok()) return map_b.status();
  const StatusOr<IlluminationMetrics> metrics =
      CompareIlluminations(*map_a, *map_b);
  if (!metrics.ok()) {
    return NameFile(metrics.status(), {{"estimate", estimate.path},
                                       {"reference", reference.path}});
  }
  out.metrics = {{"illumination_relative_log_rmse", metrics->relative_log_rmse},
                 {"illumination_relative_log_rmse_aligned",
                  metrics->relative_log_rmse_aligned},
                 {"illumination_relative_log_rmse_unweighted",
                  metrics->relative_log_rmse_unweighted}};
  return out;
}

StatusOr<NamedMetrics> EvaluateImageFiles(const std::string& estimate,
                                          const std::string& reference,
                                          const std::string& mask) {
  const StatusOr<ImageMetrics> metrics = CompareMasked<ImageMetrics>(
      {estimate, reference, mask}, &ReadImage, &CompareImages);
  if (!metrics.ok()) return metrics.status();
  return NamedMetrics{{"image_log_rmse", metrics->log_rmse},
                      {"image_mean_abs_log", metrics->mean_abs_log},
                      {"psnr", metrics->psnr},
                      {"dssim", metrics->dssim}};
}

StatusOr<NamedMetrics> EvaluateAlbedoFiles(const std::string& estimate,
                                           const std::string& reference,
                                           const std::string& mask) {
  const StatusOr<AlbedoMapMetrics> metrics = CompareMasked<AlbedoMapMetrics>(
      {estimate, reference, mask}, &ReadAlbedo, &CompareAlbedoMaps);
  if (!metrics.ok()) return metrics.status();
  return NamedMetrics{{"albedo_log_rmse", metrics->log_rmse},
                      {"albedo_log_rmse_aligned", metrics->log_rmse_aligned},
                      {"albedo_psnr", metrics->psnr},
                      {"albedo_dssim", metrics->dssim},
                      {"albedo_lmse", metrics->lmse}};
}

}  // namespace ibrdf
