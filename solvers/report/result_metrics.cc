#include "ibrdf/solvers/report/result_metrics.h"

#include <cmath>

#include "ibrdf/base/format.h"
#include "ibrdf/base/quantile.h"
#include "ibrdf/light/environment_map.h"
#include "ibrdf/solvers/priors/determined_directions.h"
#include "ibrdf/solvers/report/result_images.h"

namespace ibrdf {

namespace {

std::vector<ViewMisfit> MisfitOfViews(const InverseProblem& inverse,
                                      const Solution& solution) {
  std::vector<ViewMisfit> views;
  if (inverse.sheet.empty()) return views;
  for (const SheetView& view : inverse.sheet.views) {
    views.push_back({view.name, 0});
  }
  const Image residual = LogResidual(inverse, solution);
  const Mask used = UsedMask(inverse);
  std::vector<double> sums(views.size(), 0.0);
  for (const ShadingPoint& point : inverse.points) {
    if (used.inside[point.pixel] == 0) continue;
    const auto v = static_cast<size_t>(point.view);
    ++views[v].pixels;
    for (int c = 0; c < 3; ++c) {
      sums[v] += std::abs(residual.rgb[size_t{3} * point.pixel + c]) / 3.0;
    }
  }
  for (size_t v = 0; v < views.size(); ++v) {
    if (views[v].pixels == 0) continue;
    views[v].misfit = sums[v] / static_cast<double>(views[v].pixels);
  }
  return views;
}

}  // namespace

StatusOr<ResultMetrics> MeasureResult(const InverseProblem& inverse,
                                      const Truth& truth,
                                      const Solution& solution) {
  ResultMetrics metrics;
  metrics.seconds = solution.seconds;
  metrics.misfit = solution.misfit;
  if (!truth.brdf.raw.empty() && !solution.brdf.raw.empty()) {
    const StatusOr<BrdfMetrics> brdf = CompareBrdfs(solution.brdf, truth.brdf);
    if (!brdf.ok()) return brdf.status();
    metrics.brdf = *brdf;
  }
  if (!truth.illumination.empty() && !inverse.known_map.has_value()) {
    const StatusOr<IlluminationMetrics> illumination =
        CompareIlluminations(solution.map, truth.illumination);
    if (!illumination.ok()) return illumination.status();
    metrics.illumination = *illumination;
  }
  const StatusOr<ImageMetrics> image = CompareImages(
      solution.render, NearestObserved(inverse, solution), UsedMask(inverse));
  if (image.ok()) metrics.image = *image;
  metrics.views = MisfitOfViews(inverse, solution);
  return metrics;
}

DeterminedLight MeasureDetermined(const Image& variance_left) {
  DeterminedLight out;
  double all = 0.0;
  for (size_t k = 0; k < variance_left.rgb.size(); ++k) {
    const int row = static_cast<int>(k / 3) / variance_left.width;
    const double area =
        TexelSolidAngle(row, variance_left.height, variance_left.width);
    all += area;
    out.variance_left += area * variance_left.rgb[k];
    if (variance_left.rgb[k] < kDetermined) out.share += area;
  }
  out.share /= all;
  out.variance_left /= all;
  return out;
}

AlbedoDeviation MeasureAlbedoDeviation(
    const Image& log_std, const std::vector<ShadingPoint>& points) {
  std::vector<double> values;
  for (const ShadingPoint& point : points) {
    values.push_back(log_std.rgb[size_t{3} * point.pixel]);
  }
  return {Quantile(values, 0.5), Quantile(values, 0.9)};
}

std::vector<NamedMetric> ListMetrics(const ResultMetrics& metrics) {
  std::vector<NamedMetric> list = {{"seconds", metrics.seconds},
                                   {"misfit", metrics.misfit}};
  if (const auto& brdf = metrics.brdf) {
    list.push_back({"brdf_log_rmse", brdf->log_rmse});
    list.push_back({"brdf_log_rmse_aligned", brdf->log_rmse_aligned});
    list.push_back({"brdf_log_rmse_below80", brdf->log_rmse_below80});
    list.push_back(
        {"brdf_log_rmse_aligned_below80", brdf->log_rmse_aligned_below80});
  }
  if (const auto& map = metrics.illumination) {
    list.push_back({"illumination_relative_log_rmse", map->relative_log_rmse});
    list.push_back({"illumination_relative_log_rmse_aligned",
                    map->relative_log_rmse_aligned});
    list.push_back({"illumination_relative_log_rmse_unweighted",
                    map->relative_log_rmse_unweighted});
  }
  if (const auto& image = metrics.image) {
    list.push_back({"image_log_rmse", image->log_rmse});
    list.push_back({"psnr", image->psnr});
    list.push_back({"dssim", image->dssim});
  }
  return list;
}

std::vector<std::string> MetricLines(const ResultMetrics& metrics) {
  std::vector<std::string> lines;
  for (const NamedMetric& metric : ListMetrics(metrics)) {
    if (!std::isfinite(metric.value)) continue;
    lines.push_back(Format("%s %.4g", metric.name, metric.value));
  }
  return lines;
}

}  // namespace ibrdf
