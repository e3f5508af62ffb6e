#include "ibrdf/solvers/problem/load_views.h"

#include <string>
#include <utility>

#include "ibrdf/io/calibrated_views.h"

namespace ibrdf {

StatusOr<std::vector<ViewSpec>> LoadViews(const Problem& problem, int width,
                                          int height) {
  const ViewsSpec& views = problem.views;
  if (!views.given() || !views.list.empty()) return views.list;
  const StatusOr<std::vector<CalibratedView>> calibrated =
      views.transforms.empty() ? ReadColmap(views.colmap)
                               : ReadTransforms(views.transforms);
  if (!calibrated.ok()) return calibrated.status();
  std::vector<ViewSpec> out;
  for (const CalibratedView& view : *calibrated) {
    const StatusOr<Camera> camera = CameraOf(view, width, height);
    if (!camera.ok()) {
      return InvalidInput(problem.path, camera.status().message());
    }
    ViewSpec spec;
    spec.name = view.name;
    spec.camera = Turned(*camera, YUpFrom(problem.geometry.up));
    out.push_back(std::move(spec));
  }
  return out;
}

}  // namespace ibrdf
