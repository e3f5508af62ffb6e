#include "ibrdf/solvers/problem/load_scene.h"

#include <string>
#include <vector>

#include "ibrdf/brdf/sample_merl.h"
#include "ibrdf/io/map_file.h"
#include "ibrdf/io/merl.h"
#include "ibrdf/io/mesh.h"
#include "ibrdf/light/procedural_sky.h"
#include "ibrdf/solvers/problem/load_normals.h"

namespace ibrdf {

StatusOr<Scene> LoadScene(const GeometrySpec& geometry,
                          std::vector<std::string>* warnings) {
  switch (geometry.kind) {
    case GeometryKind::kSphere:
      break;
    case GeometryKind::kMesh: {
      StatusOr<TriangleMesh> mesh = ReadMesh(geometry.file);
      if (!mesh.ok()) return mesh.status();
      if (geometry.fit == MeshFit::kUnitSphere) FitUnitSphere(&*mesh);
      StatusOr<Scene> scene = Scene::FromMesh(*mesh);
      if (!scene.ok()) {
        return InvalidInput(geometry.file, scene.status().message());
      }
      return scene;
    }
    case GeometryKind::kNormals: {
      const StatusOr<NormalMap> map = LoadNormals(geometry);
      if (!map.ok()) return map.status();
      if (warnings != nullptr) {
        warnings->insert(warnings->end(), map->warnings.begin(),
                         map->warnings.end());
      }
      StatusOr<Scene> scene = Scene::FromNormalMap(map->normals);
      if (!scene.ok()) {
        return InvalidInput(geometry.file, scene.status().message());
      }
      return scene;
    }
  }
  return Scene::UnitSphere();
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
