#include "ibrdf/solvers/bench/held_out_models.h"

#include <algorithm>
#include <filesystem>
#include <map>
#include <utility>

#include "ibrdf/io/model_file.h"
#include "ibrdf/solvers/bench/sweep_cases.h"

namespace ibrdf {
namespace {

namespace fs = std::filesystem;

constexpr char kDefaultModel[] = "default";
constexpr char kExtension[] = ".ibrdf";
// Deep enough for FOLDER/fold0/NAME.ibrdf.
constexpr int kDepth = 1;

StatusOr<std::vector<fs::path>> FindModels(const std::string& folder) {
  std::vector<fs::path> paths;
  std::error_code error;
  fs::recursive_directory_iterator at(folder, error), end;
  for (; !error && at != end; at.increment(error)) {
    if (at.depth() >= kDepth) at.disable_recursion_pending();
    if (at->path().extension() == kExtension && at->is_regular_file(error)) {
      paths.push_back(at->path());
    }
  }
  if (error) return InvalidInput(folder, error.message());
  if (paths.empty()) {
    return InvalidInput(folder,
                        "expected models (.ibrdf) in it or in its "
                        "subfolders");
  }
  std::sort(paths.begin(), paths.end());
  return paths;
}

// Whether a model is one of the two that `reflectance.model` takes of a folder.
bool InPair(const fs::path& model) {
  const auto [first, second] = ModelsOfFolder(model.parent_path().string());
  return (model == first || model == second) && fs::is_regular_file(first) &&
         fs::is_regular_file(second);
}

}  // namespace

std::string ChosenModel::folder_suffix() const {
  if (path == kDefaultModel) return "";
  std::string name = "_" + label;
  std::replace(name.begin(), name.end(), '/', '-');
  return name;
}

std::string ReflectanceYaml(const ChosenModel& model, int lobes, bool alone) {
  std::string path = model.path;
  if (path == kDefaultModel) {
    // A problem that names none has the pair.
    if (!alone) path.clear();
  } else if (alone && fs::is_directory(path)) {
    path = ModelsOfFolder(path)[0];
  }
  return (path.empty() ? "{" : "{model: " + Quoted(path) + ", ") +
         "lobes: " + std::to_string(lobes) + "}\n";
}

StatusOr<HeldOutModels> HeldOutModels::Open(const ModelOptions& options) {
  HeldOutModels out;
  out.folder_ = options.models;
  const auto add = [&](const std::string& path, const std::string& label,
                       std::vector<std::string> names) -> Status {
    if (label.find_first_of(",\"\r\n|") != std::string::npos) {
      return InvalidInput(path, "expected a name without comma, quote and bar");
    }
    out.entries_.push_back({{path, label}, std::move(names)});
    return OkStatus();
  };
  if (options.models.empty()) {
    const bool shipped = options.model == kDefaultModel;
    const fs::path path(options.model);
    if (!shipped && !fs::is_regular_file(path)) {
      return InvalidInput(options.model, "expected a model file or default");
    }
    IBRDF_RETURN_IF_ERROR(
        add(shipped ? options.model : fs::absolute(path).string(),
            shipped ? options.model : path.filename().string(), {}));
    return out;
  }
  if (options.model != kDefaultModel) {
    return InvalidInput("command line", "expected --model or --models");
  }
  const StatusOr<std::vector<fs::path>> paths = FindModels(options.models);
  if (!paths.ok()) return paths.status();
  std::map<fs::path, std::vector<std::string>> seen;  // of a file or a pair
  for (const fs::path& path : *paths) {
    StatusOr<NeuralBrdfModel> model = ReadModel(path.string());
    if (!model.ok()) return model.status();
    if (model->names.empty()) {
      return InvalidInput(path.string() + ": names", "expected an embedding");
    }
    std::vector<std::string>& names =
        seen[InPair(path) ? path.parent_path() : path];
    names.insert(names.end(), model->names.begin(), model->names.end());
  }
  for (auto& [path, names] : seen) {
    IBRDF_RETURN_IF_ERROR(add(
        fs::absolute(path).string(),
        fs::relative(path, options.models).generic_string(), std::move(names)));
  }
  return out;
}

StatusOr<ChosenModel> HeldOutModels::For(const std::string& material) const {
  const Entry* best = nullptr;
  for (const Entry& entry : entries_) {
    const bool seen = std::any_of(
        entry.names.begin(), entry.names.end(), [&](const std::string& name) {
          return name.substr(0, name.rfind('.')) == material;
        });
    if (seen) continue;
    if (best == nullptr || entry.names.size() > best->names.size()) {
      best = &entry;
    }
  }
  if (best != nullptr) return best->model;
  return InvalidInput(folder_, "expected a model that was not trained on " +
                                   material + ", all of " +
                                   std::to_string(entries_.size()) + " were");
}

}  // namespace ibrdf
