#include "ibrdf/solvers/problem/load_views.h"

#include <string>
#include <utility>

#include "ibrdf/io/calibrated_views.h"

namespace ibrdf {

StatusOr<std::vector<CalibratedView>> ReadCalibratedViews(
    const std::string& transforms, const std::string& colmap, UpAxis up) {
  StatusOr<std::vector<CalibratedView>> views =
      transforms.empty() ? ReadColmap(colmap) : ReadTransforms(transforms);
  if (!views.ok()) return views.status();
  for (CalibratedView& view : *views) {
    view.world_from_camera = Turned(view.world_from_camera, YUpFrom(up));
  }
  return views;
}

StatusOr<std::vector<ViewSpec>> LoadViews(const Problem& problem, int width,
                                          int height) {
  const ViewsSpec& views = problem.views;
  if (!views.given() || !views.list.empty()) return views.list;
  const StatusOr<std::vector<CalibratedView>> calibrated =
      ReadCalibratedViews(views.transforms, views.colmap, problem.geometry.up);
  if (!calibrated.ok()) return calibrated.status();
  std::vector<ViewSpec> out;
  for (const CalibratedView& view : *calibrated) {
    const StatusOr<Camera> camera = CameraOf(view, width, height);
    if (!camera.ok()) {
      return InvalidInput(problem.path, camera.status().message());
    }
    ViewSpec spec;
    spec.name = view.name;
    spec.camera = *camera;
    out.push_back(std::move(spec));
  }
  return out;
}

}  // namespace ibrdf
