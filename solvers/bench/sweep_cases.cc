#include "ibrdf/solvers/bench/sweep_cases.h"

#include <filesystem>
#include <nlohmann/json.hpp>
#include <utility>

#include "ibrdf/solvers/bench/sweep_files.h"

namespace ibrdf {
namespace {

namespace fs = std::filesystem;

bool IsMesh(const SweepOptions& options) {
  return options.geometry != "sphere";
}

// These names, or all of the folder's.
StatusOr<std::vector<std::string>> NamesOr(
    const std::vector<std::string>& names, const std::string& folder,
    const std::vector<std::string>& extensions) {
  if (!names.empty()) return names;
  return ListNames(folder, extensions);
}

StatusOr<SweepCase> FindCase(const SweepOptions& options,
                             const std::string& material,
                             const std::string& map) {
  SweepCase c;
  c.material = material;
  c.map = map;
  c.size = options.size;
  c.name = material + "_" + map;
  if (IsMesh(options)) c.name += "_" + GeometryName(options);
  IBRDF_RETURN_IF_ERROR(CheckCaseName(c.name));
  c.brdf_path = FindFile(options.data, material, {".binary"});
  c.map_path = FindFile(options.maps, map, MapExtensions());
  if (c.brdf_path.empty()) {
    return InvalidInput(options.data,
                        "expected a file " + material + ".binary");
  }
  if (c.map_path.empty()) {
    return InvalidInput(options.maps,
                        "expected a file " + map + ".hdr or .exr");
  }
  return c;
}

}  // namespace

std::string GeometryName(const SweepOptions& options) {
  return IsMesh(options) ? fs::path(options.geometry).stem().string()
                         : options.geometry;
}

std::string Quoted(const std::string& text) {
  return nlohmann::json(text).dump();
}

SweepCase CaseOfSize(SweepCase c, int size) {
  c.name += "_" + std::to_string(size) + "px";
  c.size = size;
  return c;
}

std::string CaseFolder(const SweepOptions& options, const SweepCase& c) {
  return fs::absolute(fs::path(options.out) / "cases" / c.name).string();
}

Problem RenderProblem(const SweepOptions& options, const SweepCase& c) {
  Problem problem;
  problem.path = c.name;
  problem.image.width = problem.image.height = c.size;
  if (IsMesh(options)) {
    problem.geometry.kind = GeometryKind::kMesh;
    problem.geometry.file = options.geometry;
  }
  problem.reflectance.known_file = c.brdf_path;
  problem.illumination.known_file = c.map_path;
  problem.illumination.frame = kSweepMapFrame;
  problem.quality = RenderQuality::kReference;
  problem.noise = options.noise;
  return problem;
}

std::string ImageYaml(const SweepOptions& options, const std::string& image) {
  const std::string geometry =
      IsMesh(options)
          ? "{mesh: " + Quoted(fs::absolute(options.geometry).string()) +
                ", fit: unit_sphere}"
          : "{sphere: {}}";
  return "image: {" + image + "}\ngeometry: " + geometry + "\n";
}

std::string MapAndFrame(const SweepCase& c) {
  return Quoted(c.map_path) + ", frame: " + MapFrameName(kSweepMapFrame);
}

StatusOr<std::vector<SweepCase>> ListSweepCases(const SweepOptions& options) {
  const StatusOr<std::vector<std::string>> materials =
      NamesOr(options.materials, options.data, {".binary"});
  if (!materials.ok()) return materials.status();
  const StatusOr<std::vector<std::string>> maps =
      NamesOr(options.map_names, options.maps, MapExtensions());
  if (!maps.ok()) return maps.status();
  if (materials->empty()) {
    return InvalidInput(options.data, "expected .binary tables, found none");
  }
  if (maps->empty()) {
    return InvalidInput(options.maps, "expected .hdr or .exr maps, found none");
  }
  std::vector<SweepCase> cases;
  int index = 0;
  for (const std::string& material : *materials) {
    for (const std::string& map : *maps) {
      const StatusOr<SweepCase> found = FindCase(options, material, map);
      if (!found.ok()) return found.status();
      if (index++ % options.only_count == options.only_index - 1) {
        cases.push_back(*found);
      }
    }
  }
  if (cases.empty()) {
    return InvalidInput("command line", "expected at least one case");
  }
  return cases;
}

}  // namespace ibrdf
