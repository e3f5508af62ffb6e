#include "ibrdf/solvers/problem/load_object.h"

#include <optional>
#include <utility>

#include "ibrdf/io/problem_file.h"
#include "ibrdf/solvers/photograph_check/check_words.h"
#include "ibrdf/solvers/problem/load_photograph.h"
#include "ibrdf/solvers/problem/load_scene.h"
#include "ibrdf/solvers/problem/silhouette.h"
#include "ibrdf/solvers/problem/sphere_outline.h"

namespace ibrdf {
namespace {

std::shared_ptr<const ObjectLook> Look(const Problem& problem,
                                       const Photograph& observed,
                                       const PhotographedObject& object,
                                       Silhouette silhouette) {
  ObjectLook look;
  look.radiance = KnownRadiance(observed);
  const LookInput input{look.radiance,
                        observed.mask,
                        object.points,
                        object.scene.normal_map(),
                        observed.codes,
                        observed.curve,
                        problem.image.exposure,
                        observed.missing,
                        problem.image.mask.empty()
                            ? std::nullopt
                            : std::optional<double>(silhouette.overlap)};
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
      problem.geometry.outline.has_value() ||
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

// Sets the points' materials; those of labels that are left out go.
Status TakeLabels(const Problem& problem, const Image& radiance,
                  PhotographedObject* object) {
  if (problem.reflectance.labels.empty()) return OkStatus();
  StatusOr<MaterialLabels> labels =
      LoadLabels(problem.reflectance.labels, radiance, &object->points);
  if (!labels.ok()) return labels.status();
  object->materials = std::move(labels->labels);
  for (std::string& warning : labels->warnings) {
    object->warnings.push_back(std::move(warning));
  }
  return OkStatus();
}

}  // namespace

StatusOr<PhotographedObject> LoadPhotographedObject(const Problem& problem,
                                                    int num_threads) {
  IBRDF_RETURN_IF_ERROR(CheckSolvable(problem));
  StatusOr<Photograph> observed = LoadPhotograph(problem.image);
  if (!observed.ok()) return observed.status();
  const int width = observed->radiance.width;
  const int height = observed->radiance.height;
  PhotographedObject object;
  object.warnings = std::move(observed->warnings);
  const StatusOr<Problem> placed =
      WithSphereOutline(problem, observed->mask, &object.warnings);
  if (!placed.ok()) return placed.status();
  StatusOr<Scene> scene = LoadScene(*placed, width, height, &object.warnings);
  if (!scene.ok()) return scene.status();
  object.scene = *std::move(scene);
  StatusOr<std::vector<ShadingPoint>> points =
      FindShadingPoints(object.scene, problem.camera, width, height,
                        observed->mask, 1, num_threads);
  if (!points.ok()) {
    return InvalidInput(problem.path, points.status().message() +
                                          "; check the camera and geometry" +
                                          FitAdvice(problem));
  }
  object.points = *std::move(points);
  Silhouette silhouette =
      FindSilhouette(object.scene, problem.camera, width, height,
                     observed->mask, object.points, num_threads);
  IBRDF_RETURN_IF_ERROR(CheckSilhouette(problem, silhouette, &object.warnings));
  IBRDF_RETURN_IF_ERROR(TakeLabels(problem, observed->radiance, &object));
  object.look = Look(problem, *observed, object, std::move(silhouette));
  for (std::string& warning : CheckWarnings(
           object.look->check, problem.image.file, problem.geometry.file,
           SoughtIn(ChosenVariation(problem, object.look->check)))) {
    object.warnings.push_back(std::move(warning));
  }
  object.radiance = std::move(observed->radiance);
  object.bounds = std::move(observed->bounds);
  object.unknown_curve = std::move(observed->unknown_curve);
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
  return check.MayBePainted() ? ReflectanceVariation::kAuto
                              : ReflectanceVariation::kNone;
}

}  // namespace ibrdf
