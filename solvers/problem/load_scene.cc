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
#include "ibrdf/surface/charts.h"
#include "ibrdf/surface/surface_atlas.h"

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
  // Shares of a unit sphere's radius.
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

// One texel that lies at several places cannot tell them apart.
void WarnOfOverlaps(const std::string& file, const TriangleMesh& mesh,
                    std::vector<std::string>* warnings) {
  constexpr int kSize = 256;
  const StatusOr<SurfaceAtlas> atlas =
      SurfaceAtlas::OfMesh(mesh, Eigen::Vector3d::Zero(), kSize, kSize);
  if (!atlas.ok() || atlas->overlapped == 0) return;
  warnings->push_back(
      file +
      ": texture coordinates overlap: " + std::to_string(atlas->overlapped) +
      " of " + std::to_string(atlas->texels.size()) +
      " texels of a picture of 256x256 are on several places of the surface");
}

// Charts of our own where the file has none.
Status SetTexture(const Problem& problem, const MeshNotes& notes,
                  TriangleMesh* mesh, std::vector<std::string>* warnings) {
  const std::optional<PrincipledSpec>& values = problem.reflectance.principled;
  if (problem.kind != ProblemKind::kTextures &&
      (!values.has_value() || !values->textured())) {
    return OkStatus();
  }
  const std::string& file = problem.geometry.file;
  if (!notes.texture_fault.empty()) {
    return InvalidInput(file, notes.texture_fault);
  }
  if (mesh->texture.empty()) {
    AddCharts(mesh);
    // The gaps between charts are a texel of such a picture (AddCharts).
    constexpr int kApart = 256;
    const TextureSpec& size = problem.texture;
    if (problem.kind == ProblemKind::kTextures &&
        std::min(size.width, size.height) < kApart) {
      warnings->push_back(
          file + ": a texture of " + SizeName(size.width, size.height) +
          " texels is too coarse to keep its charts apart: texels at their "
          "borders are of two places; say texture.width and height of " +
          std::to_string(kApart) + " or more");
    }
    return OkStatus();
  }
  const std::string fault = TextureFault(*mesh);
  if (!fault.empty()) return InvalidInput(file, fault);
  WarnOfOverlaps(file, *mesh, warnings);
  return OkStatus();
}

// Vertices are relative to the origin.
struct PlacedMesh {
  TriangleMesh mesh;
  Eigen::Vector3d origin = Eigen::Vector3d::Zero();
};

void Turn(const Eigen::Matrix3f& rotation, TriangleMesh* mesh) {
  for (Eigen::Vector3f& vertex : mesh->vertices) vertex = rotation * vertex;
  for (Eigen::Vector3f& normal : mesh->normals) normal = rotation * normal;
}

StatusOr<PlacedMesh> LoadMesh(const Problem& problem,
                              std::vector<std::string>* warnings) {
  const GeometrySpec& geometry = problem.geometry;
  MeshNotes notes;
  StatusOr<TriangleMesh> mesh = ReadMesh(geometry.file, &notes);
  if (!mesh.ok()) return mesh.status();
  *warnings = notes.warnings;
  if (geometry.up != UpAxis::kY) {
    const Eigen::Matrix3d rotation = YUpFrom(geometry.up);
    Turn(rotation.cast<float>(), &*mesh);
    notes.origin = rotation * notes.origin;
  }
  IBRDF_RETURN_IF_ERROR(SetTexture(problem, notes, &*mesh, warnings));
  PlacedMesh placed;
  if (geometry.fit == MeshFit::kNone) {
    placed.mesh = *std::move(mesh);
    placed.origin = notes.origin;
    return placed;
  }
  const BoundingSphere bounds = FitUnitSphere(&*mesh);
  IBRDF_RETURN_IF_ERROR(CheckNotMoved(problem, notes.origin + bounds.centre,
                                      bounds.radius, warnings));
  placed.mesh = *std::move(mesh);
  return placed;
}

StatusOr<Scene> LoadShape(const Problem& problem, int width, int height,
                          std::vector<std::string>* warnings) {
  const GeometrySpec& geometry = problem.geometry;
  if (geometry.kind == GeometryKind::kSphere) {
    return LoadSphere(problem, width, height);
  }
  if (geometry.kind == GeometryKind::kMesh) {
    const StatusOr<PlacedMesh> placed = LoadMesh(problem, warnings);
    if (!placed.ok()) return placed.status();
    return OfFile(geometry.file, Scene::FromMesh(placed->mesh, placed->origin));
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

StatusOr<TexturedSurface> LoadTexturedSurface(
    const Problem& problem, std::vector<std::string>* warnings) {
  const GeometrySpec& geometry = problem.geometry;
  const TextureSpec& size = problem.texture;
  TexturedSurface out;
  if (geometry.kind == GeometryKind::kSphere) {
    out.atlas = SurfaceAtlas::OfSphere(Eigen::Vector3d::Zero(), 1.0, size.width,
                                       size.height);
    return out;
  }
  const StatusOr<PlacedMesh> placed = LoadMesh(problem, warnings);
  if (!placed.ok()) return placed.status();
  StatusOr<Scene> scene =
      OfFile(geometry.file, Scene::FromMesh(placed->mesh, placed->origin));
  if (!scene.ok()) return scene.status();
  StatusOr<SurfaceAtlas> atlas = SurfaceAtlas::OfMesh(
      placed->mesh, placed->origin, size.width, size.height);
  if (!atlas.ok()) return InvalidInput(geometry.file, atlas.status().message());
  if (atlas->texels.empty()) {
    return InvalidInput(geometry.file,
                        "expected texture coordinates that enclose an area");
  }
  out.scene = *std::move(scene);
  out.atlas = *std::move(atlas);
  return out;
}

StatusOr<Image> LoadKnownIllumination(const IlluminationSpec& illumination,
                                      std::vector<std::string>* warnings,
                                      MapFrame* frame) {
  if (illumination.sky.has_value()) {
    return RenderSky(*illumination.sky, illumination.height,
                     illumination.width);
  }
  return ReadMap(illumination.known_file, illumination.frame, warnings, frame);
}

Disney PrincipledBrdf(const PrincipledSpec& spec) {
  Disney brdf;
  brdf.base = spec.base.value;
  brdf.roughness = std::max(spec.roughness.value[0], kMinRoughness);
  brdf.metallic = spec.metallic.value[0];
  brdf.specular = spec.specular.value[0];
  return brdf;
}

StatusOr<MerlTable> LoadKnownReflectance(const ReflectanceSpec& reflectance) {
  if (reflectance.principled.has_value()) {
    return SampleMerl(PrincipledBrdf(*reflectance.principled).Function());
  }
  if (reflectance.analytic.has_value()) {
    return SampleMerl(reflectance.analytic->Function());
  }
  return ReadMerl(reflectance.known_file);
}

}  // namespace ibrdf
