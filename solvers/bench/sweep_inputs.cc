#include "ibrdf/solvers/bench/sweep_inputs.h"

#include <algorithm>
#include <filesystem>
#include <map>
#include <nlohmann/json.hpp>
#include <utility>

#include "ibrdf/image/rgb8_image.h"
#include "ibrdf/io/atomic_file.h"
#include "ibrdf/io/image_file.h"
#include "ibrdf/io/merl.h"
#include "ibrdf/io/png.h"
#include "ibrdf/render/reference_batch.h"
#include "ibrdf/render/reference_renderer.h"
#include "ibrdf/solvers/bench/sweep_files.h"
#include "ibrdf/solvers/forward/forward_scene.h"
#include "ibrdf/solvers/forward/image_noise.h"
#include "ibrdf/solvers/problem/load_scene.h"

namespace ibrdf {
namespace {

namespace fs = std::filesystem;

// Maps that are taken together: radiance of all their images is in memory.
constexpr size_t kMaxMaps = 16;
// Points between two looks at options.stop: some seconds.
constexpr size_t kPointsPerStep = 1024;

std::string SettingsPath(const SweepOptions& options, const SweepCase& c) {
  return CaseFolder(options, c) + "/input.json";
}

Status WriteInput(const SweepOptions& options, const SweepCase& c,
                  const Mask& mask, Image image) {
  const std::string folder = CaseFolder(options, c);
  std::error_code error;
  fs::create_directories(folder, error);
  if (error) return InvalidInput(folder, error.message());
  fs::remove(SettingsPath(options, c), error);
  AddNoise(options.noise, options.seed, &image);
  IBRDF_RETURN_IF_ERROR(WriteImage(image, folder + "/input.exr"));
  IBRDF_RETURN_IF_ERROR(WriteMask(mask, folder + "/mask.png"));
  return WriteFileAtomically(SettingsPath(options, c),
                             InputSettings(options, c));
}

template <typename T>
int IndexOf(const std::vector<T>& list, const T& value) {
  return static_cast<int>(std::find(list.begin(), list.end(), value) -
                          list.begin());
}

// All of `cases` with one of these materials' tables and maps of one size.
Status RenderTogether(const SweepOptions& options, const ViewPoints& view,
                      const std::vector<std::string>& materials,
                      const MerlTableStack& tables,
                      const std::vector<std::string>& map_names,
                      const std::vector<const Image*>& maps,
                      const std::vector<SweepCase>& cases) {
  ReferenceOptions reference;
  reference.num_threads = options.num_threads;
  const ReferenceBatch batch(tables, maps, reference);
  const size_t images = materials.size() * maps.size();
  const size_t count = view.points.size();
  std::vector<std::vector<double>> L_o(images, std::vector<double>(3 * count));
  std::vector<double> some;
  for (size_t begin = 0; begin < count; begin += kPointsPerStep) {
    if (options.stopped()) {
      return Status(StatusCode::kInterrupted,
                    cases.front().name + ": interrupted");
    }
    const size_t end = std::min(begin + kPointsPerStep, count);
    const std::vector<ShadingPoint> step(view.points.begin() + begin,
                                         view.points.begin() + end);
    some.resize(3 * images * step.size());
    batch.Render(step, some.data());
    for (size_t k = 0; k < images; ++k) {
      std::copy_n(&some[3 * k * step.size()], 3 * step.size(),
                  &L_o[k][3 * begin]);
    }
  }
  for (const SweepCase& c : cases) {
    const size_t k = IndexOf(materials, c.brdf_path) * maps.size() +
                     IndexOf(map_names, c.map_path);
    IBRDF_RETURN_IF_ERROR(
        WriteInput(options, c, view.mask,
                   PixelMeans(view.points, L_o[k].data(), c.size, c.size)));
  }
  return OkStatus();
}

// Cases of at most options.batch materials.
Status RenderBatch(const SweepOptions& options, const ViewPoints& view,
                   const std::vector<SweepCase>& cases) {
  std::vector<std::string> materials;
  std::map<std::string, Image> images;
  for (const SweepCase& c : cases) {
    if (IndexOf(materials, c.brdf_path) == static_cast<int>(materials.size())) {
      materials.push_back(c.brdf_path);
    }
    if (images.count(c.map_path) != 0) continue;
    StatusOr<Image> map =
        LoadKnownIllumination(RenderProblem(options, c).illumination);
    if (!map.ok()) return map.status();
    images[c.map_path] = *std::move(map);
  }
  MerlTableStack tables(static_cast<int>(materials.size()));
  for (size_t m = 0; m < materials.size(); ++m) {
    const StatusOr<MerlTable> table = ReadMerl(materials[m]);
    if (!table.ok()) return table.status();
    tables.Set(static_cast<int>(m), *table);
  }
  while (!images.empty()) {
    const int width = images.begin()->second.width;
    const int height = images.begin()->second.height;
    std::vector<std::string> names;
    std::vector<const Image*> maps;
    for (const auto& [name, image] : images) {
      if (image.width != width || image.height != height) continue;
      if (maps.size() == kMaxMaps) break;
      names.push_back(name);
      maps.push_back(&image);
    }
    std::vector<SweepCase> chosen;
    for (const SweepCase& c : cases) {
      if (IndexOf(names, c.map_path) < static_cast<int>(names.size())) {
        chosen.push_back(c);
      }
    }
    IBRDF_RETURN_IF_ERROR(
        RenderTogether(options, view, materials, tables, names, maps, chosen));
    for (const std::string& name : names) images.erase(name);
  }
  return OkStatus();
}

// Cases of one size.
Status MakeMissing(const SweepOptions& options,
                   const std::vector<SweepCase>& missing) {
  const StatusOr<ViewPoints> view =
      FindViewPoints(RenderProblem(options, missing.front()));
  if (!view.ok()) return view.status();
  std::vector<SweepCase> batch;
  std::vector<std::string> materials;
  for (size_t i = 0; i < missing.size(); ++i) {
    batch.push_back(missing[i]);
    if (IndexOf(materials, missing[i].brdf_path) ==
        static_cast<int>(materials.size())) {
      materials.push_back(missing[i].brdf_path);
    }
    const bool last = i + 1 == missing.size();
    // Cases of one material may lie apart where the user lists it twice.
    const bool full = static_cast<int>(materials.size()) >= options.batch &&
                      !last && missing[i + 1].brdf_path != missing[i].brdf_path;
    if (!last && !full) continue;
    IBRDF_RETURN_IF_ERROR(RenderBatch(options, *view, batch));
    if (options.report) {
      options.report("inputs " + std::to_string(i + 1) + " / " +
                     std::to_string(missing.size()) + "  " + batch.back().name);
    }
    batch.clear();
    materials.clear();
  }
  return OkStatus();
}

}  // namespace

std::string InputSettings(const SweepOptions& options, const SweepCase& c) {
  const nlohmann::ordered_json settings = {
      {"brdf", c.brdf_path},
      {"illumination", c.map_path},
      {"geometry", options.geometry == "sphere"
                       ? options.geometry
                       : fs::absolute(options.geometry).string()},
      {"width", c.size},
      {"height", c.size},
      {"quality", "reference"},
      {"samples_per_side", 2},
      {"noise", options.noise},
      {"seed", options.seed}};
  return settings.dump(2) + "\n";
}

bool HasInput(const SweepOptions& options, const SweepCase& c) {
  const std::string folder = CaseFolder(options, c);
  const std::string path = SettingsPath(options, c);
  for (const std::string& file :
       {path, folder + "/input.exr", folder + "/mask.png"}) {
    if (!fs::is_regular_file(file)) return false;
  }
  const StatusOr<std::string> text = ReadFile(path, kMaxSettingsBytes);
  return text.ok() && *text == InputSettings(options, c);
}

Status MakeInputs(const SweepOptions& options,
                  const std::vector<SweepCase>& cases) {
  std::map<int, std::vector<SweepCase>> missing;  // by size
  for (const SweepCase& c : cases) {
    if (!HasInput(options, c)) missing[c.size].push_back(c);
  }
  for (const auto& [size, of_size] : missing) {
    IBRDF_RETURN_IF_ERROR(MakeMissing(options, of_size));
  }
  return OkStatus();
}

Status RunRenderInputs(const SweepOptions& options) {
  const StatusOr<std::vector<SweepCase>> cases = ListSweepCases(options);
  if (!cases.ok()) return cases.status();
  return MakeInputs(options, *cases);
}

}  // namespace ibrdf
