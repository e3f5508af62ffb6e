#include "ibrdf/solvers/problem/load_scene.h"

#include <cmath>
#include <string>

#include "ibrdf/brdf/sample_merl.h"
#include "ibrdf/io/image_file.h"
#include "ibrdf/io/merl.h"
#include "ibrdf/io/mesh.h"
#include "ibrdf/light/procedural_sky.h"

namespace ibrdf {

StatusOr<Scene> LoadScene(const GeometrySpec& geometry) {
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
      const StatusOr<Image> normals = ReadImage(geometry.file);
      if (!normals.ok()) return normals.status();
      StatusOr<Scene> scene = Scene::FromNormalMap(*normals);
      if (!scene.ok()) {
        return InvalidInput(geometry.file, scene.status().message());
      }
      return scene;
    }
  }
  return Scene::UnitSphere();
}

StatusOr<Image> LoadKnownIllumination(const IlluminationSpec& illumination) {
  if (illumination.sky.has_value()) {
    return RenderSky(*illumination.sky, illumination.height,
                     illumination.width);
  }
  StatusOr<Image> map = ReadImage(illumination.known_file);
  if (!map.ok()) return map.status();
  for (size_t k = 0; k < map->rgb.size(); ++k) {
    if (std::isfinite(map->rgb[k]) && map->rgb[k] >= 0.0f) continue;
    const size_t pixel = k / 3;
    return InvalidInput(illumination.known_file,
                        "row " + std::to_string(pixel / map->width) +
                            ", column " + std::to_string(pixel % map->width) +
                            ": expected finite radiance >= 0, found " +
                            std::to_string(map->rgb[k]));
  }
  if (map->width % 2 != 0) {
    return InvalidInput(
        illumination.known_file,
        "width: expected an even number, found " + std::to_string(map->width));
  }
  return map;
}

StatusOr<MerlTable> LoadKnownReflectance(const ReflectanceSpec& reflectance) {
  if (reflectance.analytic.has_value()) {
    return SampleMerl(reflectance.analytic->Function());
  }
  return ReadMerl(reflectance.known_file);
}

}  // namespace ibrdf
