// The files that a problem names.
#include <algorithm>
#include <array>
#include <string>
#include <vector>

#include "ibrdf/io/problem_file.h"

namespace ibrdf {

std::vector<NamedFile> NamedFiles(const Problem& problem) {
  constexpr std::array<const char*, 4> kShapes = {
      "geometry.sphere", "geometry.mesh", "geometry.normals", "geometry.depth"};
  std::vector<NamedFile> files = {
      {"problem", problem.path},
      {"image.file", problem.image.file},
      {"image.mask", problem.image.mask},
      {"reflectance.labels", problem.reflectance.labels},
      {kShapes[static_cast<size_t>(problem.geometry.kind)],
       problem.geometry.file},
      {"reflectance.model", problem.reflectance.model},
      {"reflectance.known", problem.reflectance.known_file},
      {"reflectance.known.albedo", problem.reflectance.paint.has_value()
                                       ? problem.reflectance.paint->albedo
                                       : ""},
      {"illumination.known", problem.illumination.known_file},
      {"views.transforms", problem.views.transforms},
      {"views.colmap", problem.views.colmap},
      {"truth.brdf", problem.truth.brdf},
      {"truth.illumination", problem.truth.illumination}};
  if (problem.reflectance.principled.has_value()) {
    const PrincipledSpec& values = *problem.reflectance.principled;
    const std::string key = "reflectance.known.principled.";
    files.push_back({key + "base", values.base.texture});
    files.push_back({key + "roughness", values.roughness.texture});
    files.push_back({key + "metallic", values.metallic.texture});
    files.push_back({key + "specular", values.specular.texture});
  }
  for (const std::string& bracket : problem.image.brackets) {
    files.push_back({"image.brackets", bracket});
  }
  for (const std::string& file : problem.image.other_lights) {
    files.push_back({"images", file});
  }
  const std::vector<ViewSpec>& list = problem.views.list;
  for (size_t i = 0; i < list.size(); ++i) {
    const std::string key = "views[" + std::to_string(i) + "].";
    files.push_back({key + "file", list[i].file});
    files.push_back({key + "mask", list[i].mask});
    files.push_back({key + "labels", list[i].labels});
  }
  files.erase(std::remove_if(files.begin(), files.end(),
                             [](const NamedFile& f) { return f.path.empty(); }),
              files.end());
  return files;
}

}  // namespace ibrdf
