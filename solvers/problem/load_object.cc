#include "ibrdf/solvers/problem/load_object.h"

#include <algorithm>
#include <cmath>
#include <optional>
#include <utility>

#include "ibrdf/io/problem_file.h"
#include "ibrdf/solvers/photograph_check/check_words.h"
#include "ibrdf/solvers/problem/load_photograph.h"
#include "ibrdf/solvers/problem/load_scene.h"
#include "ibrdf/solvers/problem/load_sheet.h"
#include "ibrdf/solvers/problem/silhouette.h"
#include "ibrdf/solvers/problem/sphere_outline.h"

namespace ibrdf {
namespace {

// The object's pixels, and where they are to the mask.
struct SeenObject {
  std::vector<ShadingPoint> points;
  Silhouette silhouette;
  bool has_mask = false;
};

std::shared_ptr<const ObjectLook> Look(const Problem& problem,
                                       const Photograph& observed,
                                       const PhotographedObject& object,
                                       bool has_mask, Silhouette silhouette) {
  ObjectLook look;
  look.radiance = KnownRadiance(observed);
  const LookInput input{
      look.radiance,
      observed.mask,
      object.points,
      object.scene.normal_map(),
      observed.codes,
      observed.curve,
      problem.image.exposure,
      observed.missing,
      has_mask ? std::optional<double>(silhouette.overlap) : std::nullopt};
  look.check = CheckPhotograph(input);
  look.mask = observed.mask;
  look.silhouette = std::move(silhouette.object);
  look.normal_map = object.scene.normal_map();
  return std::make_shared<const ObjectLook>(std::move(look));
}

// With the outline that the mask gives a sphere which nobody placed.
StatusOr<Problem> WithSphereOutline(const Problem& problem, const Mask& mask,
                                    std::vector<std::string>* warnings) {
  Problem placed = problem;
  if (problem.geometry.kind != GeometryKind::kSphere ||
      problem.geometry.outline.has_value() || problem.SeveralViews() ||
      problem.camera.type != CameraType::kOrthographic) {
    return placed;
  }
  const StatusOr<std::optional<PixelCircle>> outline = FindSphereOutline(
      mask,
      problem.image.mask.empty() ? problem.image.file : problem.image.mask,
      warnings);
  if (!outline.ok()) return outline.status();
  placed.geometry.outline = *outline;
  return placed;
}

MaterialsSought SoughtIn(ReflectanceVariation variation) {
  switch (variation) {
    case ReflectanceVariation::kAlbedo:
      return MaterialsSought::kPainted;
    case ReflectanceVariation::kLabels:
      return MaterialsSought::kLabelled;
    case ReflectanceVariation::kAuto:
    case ReflectanceVariation::kNone:
      break;
  }
  return MaterialsSought::kOne;
}

StatusOr<MaterialLabels> LoadLabelsOf(const Problem& problem,
                                      const Image& radiance,
                                      PhotographedObject* object) {
  if (object->sheet.empty()) {
    return LoadLabels(problem.reflectance.labels, radiance, &object->points);
  }
  const StatusOr<Image> labels = LoadLabelSheet(problem, object->sheet);
  if (!labels.ok()) return labels.status();
  return LabelPoints(problem.path, *labels, radiance, &object->points);
}

// Sets the points' materials; those of labels that are left out go.
Status TakeLabels(const Problem& problem, const Image& radiance,
                  PhotographedObject* object) {
  if (problem.reflectance.variation != ReflectanceVariation::kLabels ||
      problem.reflectance.finds_labels()) {
    return OkStatus();
  }
  StatusOr<MaterialLabels> labels = LoadLabelsOf(problem, radiance, object);
  if (!labels.ok()) return labels.status();
  object->materials = std::move(labels->labels);
  for (std::string& warning : labels->warnings) {
    object->warnings.push_back(std::move(warning));
  }
  return OkStatus();
}

// What one photograph of this size shows of the object.
StatusOr<SeenObject> SeeObject(const Problem& problem, const Scene& scene,
                               int width, int height, const Mask& mask,
                               int num_threads,
                               std::vector<std::string>* warnings) {
  SeenObject seen;
  StatusOr<std::vector<ShadingPoint>> points = FindShadingPoints(
      scene, problem.camera, width, height, mask, 1, num_threads);
  if (!points.ok()) {
    return InvalidInput(problem.path, points.status().message() +
                                          "; check the camera and geometry" +
                                          FitAdvice(problem));
  }
  seen.points = *std::move(points);
  seen.has_mask = !problem.image.mask.empty();
  seen.silhouette = FindSilhouette(scene, problem.camera, width, height, mask,
                                   seen.points, num_threads);
  IBRDF_RETURN_IF_ERROR(CheckSilhouette(problem, seen.silhouette, warnings));
  return seen;
}

// One view's problem, of all that the view alone decides.
Problem OfView(const Problem& problem, const SheetView& view) {
  Problem one = problem;
  one.camera = view.camera;
  one.image.file = view.file;
  one.image.mask = view.mask;
  return one;
}

// Photographers hold cameras upright: where the upper sides of all point along
// z, so does the world's up axis, most probably.
void WarnOfUpAxis(const Problem& problem, const ViewSheet& sheet,
                  std::vector<std::string>* warnings) {
  Eigen::Vector3d up = Eigen::Vector3d::Zero();
  for (const SheetView& view : sheet.views) {
    up += AxesOf(view.camera).world_from_camera.col(1);
  }
  up /= static_cast<double>(sheet.views.size());
  constexpr double kClear = 0.3;
  if (problem.geometry.up != UpAxis::kY || up.z() < kClear ||
      up.z() < 2.0 * std::abs(up.y())) {
    return;
  }
  warnings->push_back(
      PhotographsName(problem) +
      ": the cameras' upper sides point along z, and y is taken for up, which "
      "the estimate of the light depends on: in a world of Blender's say "
      "geometry.up: z");
}

// What all views show, as points of the sheet. Views that see nothing are told
// of; at least one sees the object. The overlap is the worst view's.
StatusOr<SeenObject> SeeOnSheet(const Problem& problem, const Scene& scene,
                                const PhotographSheet& photographs,
                                int num_threads,
                                std::vector<std::string>* warnings) {
  const ViewSheet& sheet = photographs.sheet;
  WarnOfUpAxis(problem, sheet, warnings);
  SeenObject all;
  all.silhouette.object = Mask(sheet.width, sheet.height, 0);
  std::string blind;
  for (size_t v = 0; v < sheet.views.size(); ++v) {
    const SheetView& place = sheet.views[v];
    StatusOr<SeenObject> seen = SeeObject(
        OfView(problem, place), scene, place.width, place.height,
        CutOut(photographs.photograph.mask, place), num_threads, warnings);
    if (!seen.ok()) {
      blind = seen.status().message();
      warnings->push_back(place.file + ": view " + place.name +
                          " takes no part: " + blind);
      continue;
    }
    MoveToSheet(sheet, static_cast<int>(v), &seen->points);
    all.points.insert(all.points.end(), seen->points.begin(),
                      seen->points.end());
    Place(seen->silhouette.object, place, &all.silhouette.object);
    all.silhouette.covered += seen->silhouette.covered;
    all.silhouette.of_mask += seen->silhouette.of_mask;
    all.silhouette.overlap =
        std::min(all.silhouette.overlap, seen->silhouette.overlap);
    all.has_mask |= seen->has_mask;
  }
  if (all.points.empty()) {
    return InvalidInput(problem.path + ": views",
                        "no view sees the object: " + blind);
  }
  for (size_t i = 0; i < all.points.size(); ++i) {
    all.points[i].index = static_cast<int>(i);
  }
  return all;
}

// One photograph, or the sheet of several.
StatusOr<PhotographSheet> LoadPhotographs(const Problem& problem) {
  if (problem.SeveralViews()) return LoadPhotographSheet(problem);
  StatusOr<Photograph> photograph = LoadPhotograph(problem.image);
  if (!photograph.ok()) return photograph.status();
  PhotographSheet one;
  one.photograph = *std::move(photograph);
  return one;
}

// The geometry, and what the photographs show of it.
StatusOr<SeenObject> LoadAndSeeObject(const Problem& problem,
                                      const PhotographSheet& photographs,
                                      int num_threads,
                                      PhotographedObject* object) {
  const Photograph& observed = photographs.photograph;
  const int width = observed.radiance.width;
  const int height = observed.radiance.height;
  const StatusOr<Problem> placed =
      WithSphereOutline(problem, observed.mask, &object->warnings);
  if (!placed.ok()) return placed.status();
  StatusOr<Scene> scene = LoadScene(*placed, width, height, &object->warnings);
  if (!scene.ok()) return scene.status();
  object->scene = *std::move(scene);
  if (!photographs.sheet.empty()) {
    return SeeOnSheet(problem, object->scene, photographs, num_threads,
                      &object->warnings);
  }
  return SeeObject(problem, object->scene, width, height, observed.mask,
                   num_threads, &object->warnings);
}

}  // namespace

StatusOr<PhotographedObject> LoadPhotographedObject(const Problem& problem,
                                                    int num_threads) {
  IBRDF_RETURN_IF_ERROR(CheckSolvable(problem));
  StatusOr<PhotographSheet> photographs = LoadPhotographs(problem);
  if (!photographs.ok()) return photographs.status();
  Photograph& observed = photographs->photograph;
  PhotographedObject object;
  object.warnings = std::move(observed.warnings);
  StatusOr<SeenObject> seen =
      LoadAndSeeObject(problem, *photographs, num_threads, &object);
  if (!seen.ok()) return seen.status();
  object.sheet = std::move(photographs->sheet);
  object.points = std::move(seen->points);
  IBRDF_RETURN_IF_ERROR(TakeLabels(problem, observed.radiance, &object));
  object.look = Look(problem, observed, object, seen->has_mask,
                     std::move(seen->silhouette));
  for (std::string& warning : CheckWarnings(
           object.look->check, PhotographsName(problem), problem.geometry.file,
           SoughtIn(ChosenVariation(problem, object.look->check)))) {
    object.warnings.push_back(std::move(warning));
  }
  object.radiance = std::move(observed.radiance);
  object.bounds = std::move(observed.bounds);
  object.unknown_curve = std::move(observed.unknown_curve);
  return object;
}

ReflectanceVariation ChosenVariation(const Problem& problem,
                                     const PhotographCheck& check) {
  if (problem.kind == ProblemKind::kIllumination) {
    return ReflectanceVariation::kNone;
  }
  if (problem.reflectance.variation != ReflectanceVariation::kAuto) {
    return problem.reflectance.variation;
  }
  if (check.SeveralMaterials()) return ReflectanceVariation::kAlbedo;
  // Under known light what one material leaves tells of paint without edges.
  const bool by_misfit =
      problem.kind == ProblemKind::kReflectance && !check.colours.observable;
  return by_misfit || check.MayBePainted() ? ReflectanceVariation::kAuto
                                           : ReflectanceVariation::kNone;
}

}  // namespace ibrdf
