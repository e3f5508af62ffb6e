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
  problem.quality = RenderQuality::kReference;
  problem.noise = options.noise;
  return problem;
}

std::string ImageYaml(const SweepOptions& options) {
  const std::string geometry =
      IsMesh(options)
          ? "{mesh: " + Quoted(fs::absolute(options.geometry).string()) +
                ", fit: unit_sphere}"
          : "{sphere: {}}";
  return "image: {file: input.exr, mask: mask.png}\ngeometry: " + geometry +
         "\n";
}

StatusOr<std::vector<SweepCase>> ListSweepCases(const SweepOptions& options) {
  const std::vector<std::string> map_extensions = MapExtensions();
  std::vector<std::string> materials = options.materials;
  std::vector<std::string> map_names = options.map_names;
  if (materials.empty()) {
    StatusOr<std::vector<std::string>> all =
        ListNames(options.data, {".binary"});
    if (!all.ok()) return all.status();
    materials = *std::move(all);
  }
  if (map_names.empty()) {
    StatusOr<std::vector<std::string>> all =
        ListNames(options.maps, map_extensions);
    if (!all.ok()) return all.status();
    map_names = *std::move(all);
  }
  if (materials.empty()) {
    return InvalidInput(options.data, "expected .binary tables, found none");
  }
  if (map_names.empty()) {
    return InvalidInput(options.maps, "expected .hdr or .exr maps, found none");
  }
  std::vector<SweepCase> cases;
  int index = 0;
  for (const std::string& material : materials) {
    for (const std::string& map : map_names) {
      SweepCase c;
      c.material = material;
      c.map = map;
      c.size = options.size;
      c.name = material + "_" + map;
      if (IsMesh(options)) c.name += "_" + GeometryName(options);
      IBRDF_RETURN_IF_ERROR(CheckCaseName(c.name));
      c.brdf_path = FindFile(options.data, material, {".binary"});
      c.map_path = FindFile(options.maps, map, map_extensions);
      if (c.brdf_path.empty()) {
        return InvalidInput(options.data,
                            "expected a file " + material + ".binary");
      }
      if (c.map_path.empty()) {
        return InvalidInput(options.maps,
                            "expected a file " + map + ".hdr or .exr");
      }
      if (index++ % options.only_count == options.only_index - 1) {
        cases.push_back(c);
      }
    }
  }
  if (cases.empty()) {
    return InvalidInput("command line", "expected at least one case");
  }
  return cases;
}

}  // namespace ibrdf
