#include "ibrdf/solvers/forward/pixel_renderer.h"

#include <utility>

#include "ibrdf/approximation/reflectance_map.h"
#include "ibrdf/render/reference_renderer.h"
#include "ibrdf/scene/pixel_samples.h"
#include "ibrdf/solvers/forward/known_paint.h"
#include "ibrdf/solvers/forward/scene_radiance.h"

namespace ibrdf {
namespace {

// The far rule of the quadrature may make this share of the error of
// interpolation.
constexpr double kFarShare = 1.0 / 3;

}  // namespace

PixelRenderer::PixelRenderer(const Problem& problem, const ForwardScene& scene,
                             const PlannedRender& planned, int num_threads,
                             const RadianceRenderer::Progress& progress)
    : problem_(problem),
      scene_(scene),
      planned_(planned),
      num_threads_(num_threads),
      progress_(progress) {}

StatusOr<Image> PixelRenderer::Render() {
  const bool reference = problem_.quality == RenderQuality::kReference;
  // The second pass has fewer pixels but more points.
  const double first = reference ? 1.0 : 0.5;
  StatusOr<Image> image = RenderPoints(scene_.view.points, {0.0, first});
  if (!image.ok()) return image.status();
  if (!reference) IBRDF_RETURN_IF_ERROR(Refine({first, 1.0}, &*image));
  if (progress_) progress_(1.0);
  return image;
}

StatusOr<Image> PixelRenderer::RenderPoints(
    const std::vector<ShadingPoint>& points, const Span& span) {
  std::vector<double> L_o(3 * points.size());
  if (!scene_.paint) {
    IBRDF_RETURN_IF_ERROR(RenderUnpainted(points, span, L_o.data()));
  } else {
    const double middle = 0.5 * (span.begin + span.end);
    std::vector<double> matte(L_o.size());
    IBRDF_RETURN_IF_ERROR(
        RenderUnpainted(points, {span.begin, middle}, L_o.data()));
    IBRDF_RETURN_IF_ERROR(
        RenderMatte(points, {middle, span.end}, matte.data()));
    AddPaint(*scene_.paint, points, matte, L_o.data());
  }
  return PixelMeans(points, L_o.data(), problem_.image.width,
                    problem_.image.height);
}

bool PixelRenderer::ByNormals() const {
  return planned_.plan.approximation.approximation ==
         Approximation::kReflectanceMap;
}

Status PixelRenderer::RenderUnpainted(const std::vector<ShadingPoint>& points,
                                      const Span& span, double* L_o) {
  counts_.points += points.size();
  if (ByNormals()) {
    return RenderByNormals(scene_.brdf, points, span, &split_, L_o);
  }
  return planned_.renderer().Render(points, Within(span), L_o)
             ? OkStatus()
             : RenderInterrupted(problem_);
}

Status PixelRenderer::RenderMatte(const std::vector<ShadingPoint>& points,
                                  const Span& span, double* L_o) {
  counts_.points += points.size();
  if (ByNormals()) {
    return RenderByNormals(scene_.paint->matte, points, span, &matte_split_,
                           L_o);
  }
  const MatteRadiance matte(*planned_.radiance, *scene_.paint);
  return matte.Render(points, Within(span), L_o) ? OkStatus()
                                                 : RenderInterrupted(problem_);
}

Status PixelRenderer::RenderByNormals(const KnownBrdf& brdf,
                                      const std::vector<ShadingPoint>& points,
                                      const Span& span,
                                      std::unique_ptr<SplitRadiance>* kept,
                                      double* L_o) {
  const auto status_of = [this](const Status& status) {
    return status.code() == StatusCode::kInterrupted
               ? RenderInterrupted(problem_)
               : status;
  };
  const double log_error = RenderTolerances::Of(problem_.quality).approximation;
  if (*kept == nullptr) {
    *kept = std::make_unique<SplitRadiance>(*planned_.radiance, brdf);
    const Status fit =
        (*kept)->Fit(points, Within(span), kFarShare * log_error);
    if (!fit.ok()) return status_of(fit);
  }
  ReflectanceMapOptions options;
  options.log_error = (1.0 - kFarShare) * log_error;
  const StatusOr<ReflectanceMapReport> report =
      RenderByNormal(points, **kept, Within(span), options, L_o);
  if (!report.ok()) return status_of(report.status());
  counts_.interpolated += report->interpolated;
  return OkStatus();
}

RadianceRenderer::Progress PixelRenderer::Within(const Span& span) const {
  if (!progress_) return nullptr;
  return [this, span](double share) {
    return progress_(span.begin + (span.end - span.begin) * share);
  };
}

Status PixelRenderer::Refine(const Span& span, Image* image) {
  // What a mirror shows of its own object has detail that the differences
  // between pixels do not tell of: all of its pixels are sampled anew.
  const double log_error = planned_.plan.lobe_rays > 0
                               ? 0.0
                               : RenderTolerances::Of(problem_.quality).pixel;
  const Mask unclear = PixelsToSample(*image, scene_.view.mask, log_error);
  if (unclear.empty()) return OkStatus();
  StatusOr<std::vector<ShadingPoint>> points = FindShadingPoints(
      scene_.view.scene, problem_.camera, image->width, image->height, unclear,
      kMostSamplesPerSide, num_threads_);
  if (!points.ok()) return points.status();
  SortByAngle(&*points);
  const StatusOr<Image> finer = RenderPoints(*points, span);
  if (!finer.ok()) return finer.status();
  // All samples of a pixel may pass by what its centre meets.
  std::vector<char> met(image->num_pixels(), 0);
  for (const ShadingPoint& p : *points) met[p.pixel] = 1;
  for (size_t k = 0; k < image->rgb.size(); ++k) {
    if (met[k / 3] != 0) image->rgb[k] = finer->rgb[k];
  }
  counts_.refined = unclear.CountInside();
  return OkStatus();
}

}  // namespace ibrdf
