#include "ibrdf/solvers/problem/load_scene.h"

#include <algorithm>
#include <cmath>
#include <string>
#include <utility>
#include <vector>

#include "ibrdf/base/format.h"
#include "ibrdf/brdf/sample_merl.h"
#include "ibrdf/io/map_file.h"
#include "ibrdf/io/merl.h"
#include "ibrdf/io/mesh.h"
#include "ibrdf/light/procedural_sky.h"
#include "ibrdf/solvers/problem/load_depth.h"
#include "ibrdf/solvers/problem/load_normals.h"

namespace ibrdf {
namespace {

// What a scene says of itself is said of the file.
StatusOr<Scene> OfFile(const std::string& file, StatusOr<Scene> scene) {
  if (scene.ok()) return scene;
  return InvalidInput(file, scene.status().message());
}

Scene LoadSphere(const Problem& problem, int width, int height) {
  if (!problem.geometry.outline.has_value()) return Scene::UnitSphere();
  const PixelCircle& outline = *problem.geometry.outline;
  const Camera& camera = problem.camera;
  const Eigen::Vector3d center =
      CameraRay(camera, outline.x, outline.y, width, height).origin;
  const Eigen::Vector3d right =
      CameraRay(camera, outline.x + outline.radius, outline.y, width, height)
          .origin;
  return Scene::Sphere(center, (right - center).norm());
}

// Where nobody said how the mesh is placed, and the camera was placed: whether
// the mesh moved from where the camera may have been placed for it.
Status CheckNotMoved(const Problem& problem, const Eigen::Vector3d& centre,
                     double radius, std::vector<std::string>* warnings) {
  if (problem.geometry.fit_stated || !problem.camera_placed) return OkStatus();
  // Of a unit sphere's radius.
  constexpr double kSlightly = 0.02, kFar = 0.5;
  const double moved =
      std::max(centre.norm(), std::abs(std::log(std::max(radius, 1e-30))));
  if (moved < kSlightly) return OkStatus();
  const std::string text =
      "the mesh (centre [" + Format("%.4g", centre.x()) + ", " +
      Format("%.4g", centre.y()) + ", " + Format("%.4g", centre.z()) +
      "], radius " + Format("%.4g", radius) +
      ") is moved and scaled to the unit sphere, camera.from and camera.to are "
      "not. Say geometry.fit: none, where camera and mesh share one frame, or "
      "geometry.fit: unit_sphere";
  if (moved > kFar) {
    return InvalidInput(problem.path + ": geometry.fit", text);
  }
  warnings->push_back(problem.geometry.file + ": " + text);
  return OkStatus();
}

StatusOr<Scene> LoadMesh(const Problem& problem,
                         std::vector<std::string>* warnings) {
  const GeometrySpec& geometry = problem.geometry;
  MeshNotes notes;
  StatusOr<TriangleMesh> mesh = ReadMesh(geometry.file, &notes);
  if (!mesh.ok()) return mesh.status();
  *warnings = std::move(notes.warnings);
  if (geometry.fit == MeshFit::kNone) {
    return OfFile(geometry.file, Scene::FromMesh(*mesh, notes.origin));
  }
  const BoundingSphere bounds = FitUnitSphere(&*mesh);
  IBRDF_RETURN_IF_ERROR(CheckNotMoved(problem, notes.origin + bounds.centre,
                                      bounds.radius, warnings));
  return OfFile(geometry.file, Scene::FromMesh(*mesh));
}

StatusOr<Scene> LoadShape(const Problem& problem, int width, int height,
                          std::vector<std::string>* warnings) {
  const GeometrySpec& geometry = problem.geometry;
  if (geometry.kind == GeometryKind::kSphere) {
    return LoadSphere(problem, width, height);
  }
  if (geometry.kind == GeometryKind::kMesh) {
    return LoadMesh(problem, warnings);
  }
  StatusOr<NormalMap> map = geometry.kind == GeometryKind::kDepth
                                ? LoadDepth(geometry, problem.camera)
                                : LoadNormals(geometry);
  if (!map.ok()) return map.status();
  *warnings = std::move(map->warnings);
  return OfFile(geometry.file, Scene::FromNormalMap(map->normals));
}

}  // namespace

StatusOr<Scene> LoadScene(const Problem& problem, int width, int height,
                          std::vector<std::string>* warnings) {
  std::vector<std::string> told;
  const StatusOr<Scene> scene = LoadShape(problem, width, height, &told);
  if (warnings != nullptr) {
    warnings->insert(warnings->end(), told.begin(), told.end());
  }
  return scene;
}

StatusOr<Image> LoadKnownIllumination(const IlluminationSpec& illumination,
                                      std::vector<std::string>* warnings) {
  if (illumination.sky.has_value()) {
    return RenderSky(*illumination.sky, illumination.height,
                     illumination.width);
  }
  return ReadMap(illumination.known_file, illumination.frame, warnings);
}

StatusOr<MerlTable> LoadKnownReflectance(const ReflectanceSpec& reflectance) {
  if (reflectance.analytic.has_value()) {
    return SampleMerl(reflectance.analytic->Function());
  }
  return ReadMerl(reflectance.known_file);
}

}  // namespace ibrdf
