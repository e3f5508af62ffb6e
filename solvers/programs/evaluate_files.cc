#include "ibrdf/solvers/programs/evaluate_files.h"

#include "ibrdf/io/image_file.h"
#include "ibrdf/io/merl.h"
#include "ibrdf/io/png.h"
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

}  // namespace

StatusOr<NamedMetrics> EvaluateBrdfFiles(const std::string& estimate,
                                         const std::string& reference) {
  const StatusOr<MerlTable> a = ReadMerl(estimate);
  if (!a.ok()) return a.status();
  const StatusOr<MerlTable> b = ReadMerl(reference);
  if (!b.ok()) return b.status();
  const StatusOr<BrdfMetrics> metrics = CompareBrdfs(*a, *b);
  if (!metrics.ok()) {
    return NameFile(metrics.status(),
                    {{"estimate", estimate}, {"reference", reference}});
  }
  return NamedMetrics{{"brdf_log_rmse", metrics->log_rmse},
                      {"brdf_log_rmse_aligned", metrics->log_rmse_aligned},
                      {"brdf_log_rmse_below80", metrics->log_rmse_below80}};
}

StatusOr<NamedMetrics> EvaluateIlluminationFiles(const std::string& estimate,
                                                 const std::string& reference) {
  const StatusOr<Image> a = ReadImage(estimate);
  if (!a.ok()) return a.status();
  const StatusOr<Image> b = ReadImage(reference);
  if (!b.ok()) return b.status();
  const StatusOr<IlluminationMetrics> metrics = CompareIlluminations(*a, *b);
  if (!metrics.ok()) {
    return NameFile(metrics.status(),
                    {{"estimate", estimate}, {"reference", reference}});
  }
  return NamedMetrics{
      {"illumination_relative_log_rmse", metrics->relative_log_rmse},
      {"illumination_relative_log_rmse_aligned",
       metrics->relative_log_rmse_aligned},
      {"illumination_relative_log_rmse_unweighted",
       metrics->relative_log_rmse_unweighted}};
}

StatusOr<NamedMetrics> EvaluateImageFiles(const std::string& estimate,
                                          const std::string& reference,
                                          const std::string& mask) {
  const StatusOr<Image> a = ReadImage(estimate);
  if (!a.ok()) return a.status();
  const StatusOr<Image> b = ReadImage(reference);
  if (!b.ok()) return b.status();
  Mask inside;
  if (!mask.empty()) {
    StatusOr<Mask> read = ReadMask(mask);
    if (!read.ok()) return read.status();
    inside = *std::move(read);
  }
  const StatusOr<ImageMetrics> metrics = CompareImages(*a, *b, inside);
  if (!metrics.ok()) {
    return NameFile(
        metrics.status(),
        {{"estimate", estimate}, {"reference", reference}, {"mask", mask}});
  }
  return NamedMetrics{{"image_log_rmse", metrics->log_rmse},
                      {"image_mean_abs_log", metrics->mean_abs_log},
                      {"psnr", metrics->psnr},
                      {"dssim", metrics->dssim}};
}

}  // namespace ibrdf
