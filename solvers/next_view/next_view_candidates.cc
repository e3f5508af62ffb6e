#include "ibrdf/solvers/next_view/next_view_candidates.h"

#include <algorithm>
#include <utility>

#include "ibrdf/io/problem_file.h"

namespace ibrdf {
namespace {

// Pixels along the short side of a candidate's picture: each bin of normals
// then has several.
constexpr int kShortSide = 64;
// Points of a candidate that are kept: some ten for each bin.
constexpr size_t kMostPoints = 1000;

CandidateSetting SettingOf(const Problem& problem,
                           const PhotographedObject& object) {
  CandidateSetting out;
  const BoundingBall ball = object.scene.Bounds();
  out.centre = ball.centre;
  out.radius = ball.radius;
  for (const SheetView& view : object.sheet.views) {
    out.photographs.push_back({view.camera, view.width, view.height});
  }
  if (object.sheet.empty()) {
    out.photographs.push_back(
        {problem.camera, object.radiance.width, object.radiance.height});
  }
  return out;
}

}  // namespace

Status CheckNextViews(const Problem& problem) {
  if (problem.kind != ProblemKind::kJoint) {
    return InvalidInput(problem.path + ": problem",
                        "expected joint with --add, where next views are "
                        "chosen with the light integrated out; "
                        "ibrdf_uncertainty chooses them for problem: textures");
  }
  if (problem.solver.estimator == SolverEstimator::kMaximum) {
    return InvalidInput(problem.path + ": solver.estimator",
                        "expected marginal with --add, as the joint maximum "
                        "has no covariance");
  }
  const ReflectanceVariation variation = problem.reflectance.variation;
  if (variation == ReflectanceVariation::kAlbedo ||
      variation == ReflectanceVariation::kLabels) {
    return InvalidInput(problem.path + ": reflectance.variation",
                        "expected one material with --add: none or auto");
  }
  if (problem.geometry.kind != GeometryKind::kSphere &&
      problem.geometry.kind != GeometryKind::kMesh) {
    return InvalidInput(problem.path + ": geometry",
                        "expected a sphere or a mesh with --add: a map of "
                        "normals or depth shows nothing from elsewhere");
  }
  return OkStatus();
}

StatusOr<NextViewCandidates> LoadNextViewCandidates(
    const Problem& problem, const PhotographedObject& object,
    const std::string& text, int num_threads) {
  IBRDF_RETURN_IF_ERROR(CheckNextViews(problem));
  NextViewCandidates out;
  out.from = text;
  out.scene = object.scene;
  out.setting = SettingOf(problem, object);
  StatusOr<std::vector<CalibratedView>> views =
      LoadCandidates(text, out.setting, problem.geometry.up);
  if (!views.ok()) return views.status();
  out.views = *std::move(views);
  const SizedCamera& first = out.setting.photographs.front();
  const double aspect = static_cast<double>(first.width) / first.height;
  bool any = false;
  for (const CalibratedView& view : out.views) {
    const StatusOr<SizedCamera> camera =
        CandidateCamera(view, aspect, kShortSide);
    if (!camera.ok()) return camera.status();
    StatusOr<std::vector<ShadingPoint>> seen =
        FindShadingPoints(out.scene, camera->camera, camera->width,
                          camera->height, Mask(), 1, num_threads);
    out.points.emplace_back();
    if (!seen.ok()) continue;  // the object is not in the picture
    any = true;
    out.points.back() = SpreadPoints(*seen, kMostPoints);
    for (size_t i = 0; i < out.points.back().size(); ++i) {
      out.points.back()[i].index = static_cast<int>(i);
    }
  }
  if (!any) {
    return InvalidInput("command line: --candidates",
                        "expected a camera that sees the object: none of " +
                            std::to_string(out.views.size()) + " does");
  }
  return out;
}

}  // namespace ibrdf
