#include "ibrdf/solvers/entropy_study/study_cases.h"

#include <algorithm>
#include <cstdlib>
#include <filesystem>
#include <utility>

#include "ibrdf/io/map_file.h"
#include "ibrdf/io/output_paths.h"
#include "ibrdf/light/environment_map.h"
#include "ibrdf/solvers/bench/sweep_cases.h"
#include "ibrdf/solvers/bench/sweep_files.h"

namespace ibrdf {
namespace {

constexpr double kBrightest = 0.01;  // share of the sphere
constexpr int kKeyColumns = 3;

struct RankedMap {
  std::string name, path;
  double share = 0.0;
};

// By their share, those of equal ones by name.
StatusOr<std::vector<RankedMap>> RankMaps(const StudyOptions& options) {
  std::vector<std::string> names = options.map_names;
  if (names.empty()) {
    StatusOr<std::vector<std::string>> found =
        ListNames(options.maps, MapExtensions());
    if (!found.ok()) return found.status();
    names = *std::move(found);
  }
  if (names.empty()) {
    return InvalidInput(options.maps, "expected a folder of .hdr or .exr maps");
  }
  std::vector<RankedMap> out;
  for (const std::string& name : names) {
    IBRDF_RETURN_IF_ERROR(CheckCaseName(name));
    const std::string path = FindFile(options.maps, name, MapExtensions());
    if (path.empty()) {
      return InvalidInput("command line: --map-names",
                          "no map " + name + " in " + options.maps);
    }
    const StatusOr<Image> map = ReadMap(path, kSweepMapFrame);
    if (!map.ok()) return map.status();
    if (!(MeanRadiance(*map).mean() > 0.0)) {
      return InvalidInput(path, "expected a map that is not black");
    }
    out.push_back({name, path, BrightestShare(*map)});
  }
  std::sort(out.begin(), out.end(), [](const auto& a, const auto& b) {
    return a.share != b.share ? a.share < b.share : a.name < b.name;
  });
  return out;
}

}  // namespace

const char* MapKindName(MapKind kind) {
  switch (kind) {
    case MapKind::kSoft:
      return "soft";
    case MapKind::kMedium:
      return "medium";
    case MapKind::kHard:
      return "hard";
  }
  return "";
}

double BrightestShare(const Image& map) {
  struct Texel {
    double radiance, solid_angle;
  };
  std::vector<Texel> texels;
  double power = 0.0, sphere = 0.0;
  for (int r = 0; r < map.height; ++r) {
    const double solid_angle = TexelSolidAngle(r, map.height, map.width);
    for (int c = 0; c < map.width; ++c) {
      const float* const L = map.At(c, r);
      texels.push_back({(double{L[0]} + L[1] + L[2]) / 3.0, solid_angle});
      power += texels.back().radiance * solid_angle;
      sphere += solid_angle;
    }
  }
  std::sort(texels.begin(), texels.end(), [](const Texel& a, const Texel& b) {
    return a.radiance > b.radiance;
  });
  double left = kBrightest * sphere, brightest = 0.0;
  for (const Texel& t : texels) {
    const double taken = std::min(left, t.solid_angle);
    brightest += t.radiance * taken;
    left -= taken;
    if (left <= 0.0) break;
  }
  return brightest / power;
}

StatusOr<std::vector<StudyCase>> ListStudyCases(const StudyOptions& options) {
  if (options.shapes.empty()) {
    return InvalidInput("command line: --shapes", "expected one or more");
  }
  for (const std::string& shape : options.shapes) {
    IBRDF_RETURN_IF_ERROR(CheckCaseName(shape));
  }
  const StatusOr<std::vector<RankedMap>> maps = RankMaps(options);
  if (!maps.ok()) return maps.status();
  const int count = static_cast<int>(maps->size());
  const int shapes = static_cast<int>(options.shapes.size());
  std::vector<StudyCase> out;
  for (int k = 0; k < count * options.rounds; ++k) {
    if (k % options.only_count != options.only_index - 1) continue;
    const RankedMap& map = (*maps)[k % count];
    StudyCase c;
    c.shape = options.shapes[(k % count + k / count) % shapes];
    c.map = map.name;
    c.name = c.shape + "_" + c.map;
    c.kind = static_cast<MapKind>(3 * (k % count) / count);
    c.map_path = map.path;
    c.seed = options.seed + static_cast<unsigned>(k);
    out.push_back(std::move(c));
  }
  return out;
}

StatusOr<StudyScene> MakeStudyScene(const StudyOptions& options,
                                    const StudyCase& c) {
  const StatusOr<Image> map = ReadMap(c.map_path, kSweepMapFrame);
  if (!map.ok()) return map.status();
  const StatusOr<StudySurface> surface =
      MakeStudySurface(options.data, c.shape, options.num_texels, c.seed);
  if (!surface.ok()) return surface.status();
  SceneOptions scene;
  scene.one_material = options.one_material;
  scene.num_threads = options.num_threads;
  scene.seed = c.seed;
  return MakeStudyScene(*surface, *map, scene);
}

Status RunStudy(const StudyOptions& options,
                const std::vector<std::string>& columns,
                const std::string& last,
                const std::function<Status(const StudyCase&, const StudyScene&,
                                           const AppendStudyRow&)>& run) {
  const StatusOr<std::vector<StudyCase>> cases = ListStudyCases(options);
  if (!cases.ok()) return cases.status();
  IBRDF_RETURN_IF_ERROR(PrepareFolder(options.out));
  const std::string path =
      (std::filesystem::path(options.out) / "results.csv").string();
  const auto present = ReadResults(path, columns);
  if (!present.ok()) return present.status();
  const AppendStudyRow append = [&](const ResultsRow& row) {
    return HoldsCase(*present, row, kKeyColumns)
               ? OkStatus()
               : AppendResult(path, columns, row);
  };
  for (size_t i = 0; i < cases->size(); ++i) {
    const StudyCase& c = (*cases)[i];
    if (options.stopped()) {
      return Status(StatusCode::kInterrupted, c.name + ": interrupted");
    }
    if (HoldsCase(*present, {c.name, std::to_string(c.seed), last},
                  kKeyColumns)) {
      continue;
    }
    if (options.report) {
      options.report("scene " + std::to_string(i + 1) + " / " +
                     std::to_string(cases->size()) + "  " + c.name);
    }
    const StatusOr<StudyScene> scene = MakeStudyScene(options, c);
    if (!scene.ok()) return scene.status();
    IBRDF_RETURN_IF_ERROR(run(c, *scene, append));
  }
  return OkStatus();
}

void SetStudyCase(const StudyCase& c, NamedRow* row) {
  row->Set("scene", c.name);
  row->Set("seed", std::to_string(c.seed));
  row->Set("shape", c.shape);
  row->Set("map", c.map);
  row->Set("light", MapKindName(c.kind));
}

ColumnByName ValuesByName(const std::vector<std::string>& columns,
                          const std::vector<ResultsRow>& rows,
                          const std::string& column) {
  const size_t at =
      std::find(columns.begin(), columns.end(), column) - columns.begin();
  ColumnByName out;
  for (const ResultsRow& row : rows) {
    const std::string& name = row[kKeyColumns - 1];
    auto found = std::find_if(out.begin(), out.end(), [&](const auto& entry) {
      return entry.first == name;
    });
    if (found == out.end()) {
      found = out.insert(out.end(), {name, {}});
    }
    found->second.push_back(std::strtod(row[at].c_str(), nullptr));
  }
  return out;
}

}  // namespace ibrdf
