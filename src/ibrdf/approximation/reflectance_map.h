// Images of distant light through an orthographic camera: without shadows
// radiance depends on the normal alone (a reflectance map, Horn and Sjoberg
// 1979), so that it is rendered at some normals and interpolated at the rest.
//
// The visible normals, by their angle to the view and around it, are cut into
// cells of 3 x 3 nodes, between which log radiance is quadratic. A cell whose
// error is too large is cut in four; one whose points cost no more than its
// nodes is rendered point by point. No angle is singular: at the limb nothing
// lies beyond the last nodes, and around the view the cells are only narrower
// than they need be.
#pragma once
#include <Eigen/Core>
#include <memory>
#include <vector>

#include "ibrdf/base/status.h"
#include "ibrdf/scene/scene.h"
#include "ibrdf/transport/radiance_renderer.h"

namespace ibrdf {

struct ReflectanceMapOptions {
  // Mean |log L_o - log L_o rendered| over the points and channels, in nats,
  // that interpolation may bring in. A channel's radiance below 1e-3 of its
  // geometric mean counts as not much more than that: log stands for
  // log(L_o + 1e-3 mean).
  double log_error = 1e-3;
  // Points of the image, evenly spread over the list, that are rendered in any
  // case: the error is measured there.
  int held_out = 256;
};

struct ReflectanceMapReport {
  // Points given to the renderer: nodes, held-out ones and those of cells that
  // are rendered point by point. num_points and more: it did not pay.
  int rendered = 0;
  int nodes = 0;
  int interpolated = 0;  // points that were not rendered
  // Mean over held-out points, and its standard error. At most the requested
  // one, less two standard errors, unless nothing is interpolated.
  double log_error = 0.0;
  double standard_error = 0.0;
};

// L_o [points, 3]. Fails where two points differ in wo (a perspective camera),
// and with kInterrupted where `progress`, which every call of the renderer is
// given, stops it. The caller knows that no point is shadowed and that the
// renderer's radiance depends on normal and wo alone.
StatusOr<ReflectanceMapReport> RenderByNormal(
    const std::vector<ShadingPoint>& points, const RadianceRenderer& renderer,
    const RadianceRenderer::Progress& progress,
    const ReflectanceMapOptions& options, double* L_o);

class NormalGrid;

// The same, kept: the nodes that the points of an image ask for serve other
// points of the same view.
class ReflectanceMap {
 public:
  // As RenderByNormal of these points, one at least, but for the last step: no
  // point is rendered that is not held out. The renderer must outlive the map.
  static StatusOr<ReflectanceMap> Fit(
      const std::vector<ShadingPoint>& points, const RadianceRenderer& renderer,
      const RadianceRenderer::Progress& progress,
      const ReflectanceMapOptions& options);
  ReflectanceMap(ReflectanceMap&&) noexcept;
  ReflectanceMap& operator=(ReflectanceMap&&) noexcept;
  ~ReflectanceMap();

  // L_o [points, 3] of points with the wo of those; the renderer renders where
  // no interpolation is within the error. False: `progress` stopped it.
  bool Render(const std::vector<ShadingPoint>& points,
              const RadianceRenderer::Progress& progress, double* L_o) const;
  // It is that of Fit: nothing is interpolated yet.
  const ReflectanceMapReport& report() const;

 private:
  ReflectanceMap(std::unique_ptr<const NormalGrid> grid,
                 const Eigen::Vector3f& wo);

  std::unique_ptr<const NormalGrid> grid_;
  Eigen::Vector3f wo_;
};

}  // namespace ibrdf
