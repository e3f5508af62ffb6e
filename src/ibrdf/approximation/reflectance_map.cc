#include "ibrdf/approximation/reflectance_map.h"

#include <glog/logging.h>

#include <algorithm>
#include <utility>

#include "ibrdf/approximation/normal_grid.h"

namespace ibrdf {
namespace {

Status CheckViews(const std::vector<ShadingPoint>& points,
                  const Eigen::Vector3f& wo) {
  for (const ShadingPoint& p : points) {
    if (p.wo != wo) {
      return InvalidInput("reflectance map",
                          "expected one view direction for all points (an "
                          "orthographic camera)");
    }
  }
  return OkStatus();
}

Status Interrupted() { return Status(StatusCode::kInterrupted, "interrupted"); }

}  // namespace

StatusOr<ReflectanceMapReport> RenderByNormal(
    const std::vector<ShadingPoint>& points, const RadianceRenderer& renderer,
    const RadianceRenderer::Progress& progress,
    const ReflectanceMapOptions& options, double* L_o) {
  CHECK_GT(options.log_error, 0.0);
  if (points.empty()) return ReflectanceMapReport();
  IBRDF_RETURN_IF_ERROR(CheckViews(points, points[0].wo));
  NormalGrid grid(points, renderer, options);
  if (!grid.Fit(points, progress) ||
      !grid.RenderFitted(points, progress, L_o)) {
    return Interrupted();
  }
  return grid.report();
}

ReflectanceMap::ReflectanceMap(std::unique_ptr<const NormalGrid> grid,
                               const Eigen::Vector3f& wo)
    : grid_(std::move(grid)), wo_(wo) {}
ReflectanceMap::ReflectanceMap(ReflectanceMap&&) noexcept = default;
ReflectanceMap& ReflectanceMap::operator=(ReflectanceMap&&) noexcept = default;
ReflectanceMap::~ReflectanceMap() = default;

StatusOr<ReflectanceMap> ReflectanceMap::Fit(
    const std::vector<ShadingPoint>& points, const RadianceRenderer& renderer,
    const RadianceRenderer::Progress& progress,
    const ReflectanceMapOptions& options) {
  CHECK_GT(options.log_error, 0.0);
  CHECK(!points.empty());
  IBRDF_RETURN_IF_ERROR(CheckViews(points, points[0].wo));
  auto grid = std::make_unique<NormalGrid>(points, renderer, options);
  if (!grid->Fit(points, progress)) return Interrupted();
  return ReflectanceMap(std::move(grid), points[0].wo);
}

bool ReflectanceMap::Render(const std::vector<ShadingPoint>& points,
                            const RadianceRenderer::Progress& progress,
                            double* L_o) const {
  CHECK(CheckViews(points, wo_).ok());
  return grid_->RenderAny(points, progress, L_o);
}

const ReflectanceMapReport& ReflectanceMap::report() const {
  return grid_->report();
}

}  // namespace ibrdf
