#include "ibrdf/solvers/bench/model_materials.h"

#include <algorithm>

namespace ibrdf {

StatusOr<std::vector<ModelMaterial>> ListModelMaterials(
    const NeuralBrdfModel& model, const std::string& path,
    const std::vector<std::string>& names) {
  std::vector<ModelMaterial> all;
  for (int i = 0; i < model.num_codes(); i += 3) {
    const std::string& red = model.names[i];
    const std::string name = red.substr(0, red.rfind('.'));
    if (i + 2 >= model.num_codes() || red != name + ".red" ||
        model.names[i + 1] != name + ".green" ||
        model.names[i + 2] != name + ".blue") {
      return InvalidInput(
          path + ": names",
          "expected red, green and blue of one material from " + red + " on");
    }
    all.push_back({name, i});
  }
  if (names.empty()) return all;
  std::vector<ModelMaterial> chosen;
  for (const std::string& name : names) {
    const auto at =
        std::find_if(all.begin(), all.end(),
                     [&](const ModelMaterial& m) { return m.name == name; });
    if (at == all.end()) {
      return InvalidInput(path + ": names", "holds no material " + name);
    }
    chosen.push_back(*at);
  }
  return chosen;
}

}  // namespace ibrdf
