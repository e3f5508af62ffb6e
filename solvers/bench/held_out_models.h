// Which trained model a sweep solves a material with.
#pragma once
#include <string>
#include <vector>

#include "ibrdf/base/status.h"

namespace ibrdf {

struct ModelOptions {
  std::string model = "default";  // or a model file; for every material
  // A folder of models, each trained without some materials (its .ibrdf files
  // and those of its subfolders, as experiments/reflectance_model/held_out.sh
  // makes them), in place of `model`; empty: none. A subfolder with
  // default.ibrdf and broad.ibrdf is a pair, which solves use together.
  std::string models;
};

struct ChosenModel {
  // "default", or the absolute path of a file or of a pair's folder.
  std::string path;
  // For tables: "default", the name of the file, or the path below `models`.
  std::string label;
  // For names of folders: empty for the default model, else "_" and the label
  // without slashes.
  std::string folder_suffix() const;
};

// "{...}\n", the value of `reflectance` in a problem file. alone: of a pair the
// first only.
std::string ReflectanceYaml(const ChosenModel& model, int lobes,
                            bool alone = false);

// Immutable.
class HeldOutModels {
 public:
  // Reads what each model of a folder was trained on. Fails where that cannot
  // be done, on a folder without models and on both options at once.
  static StatusOr<HeldOutModels> Open(const ModelOptions& options);

  // With a folder: a model that has not seen the material, of those the one of
  // most materials, then the first by path. Fails where all have seen it.
  StatusOr<ChosenModel> For(const std::string& material) const;

 private:
  struct Entry {
    ChosenModel model;
    std::vector<std::string> names;  // of its codes
  };
  std::string folder_;
  std::vector<Entry> entries_;  // by path; one that serves all has no names
};

}  // namespace ibrdf
