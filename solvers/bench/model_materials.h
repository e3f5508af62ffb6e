// The materials of a model's embedding.
#pragma once
#include <string>
#include <vector>

#include "ibrdf/base/status.h"
#include "ibrdf/flow/neural_brdf_model.h"

namespace ibrdf {

struct ModelMaterial {
  std::string name;
  int first_code = 0;  // of "NAME.red"; green and blue follow
};

// In the order of the codes. `path` names the model in messages. Refuses codes
// that are not in threes of one material's red, green and blue; and, where
// `names` is not empty, names that the model does not hold.
StatusOr<std::vector<ModelMaterial>> ListModelMaterials(
    const NeuralBrdfModel& model, const std::string& path,
    const std::vector<std::string>& names = {});

}  // namespace ibrdf
