// A trained model by the name that options and problem files give it.
#pragma once
#include <string>

#include "ibrdf/base/status.h"
#include "ibrdf/flow/neural_brdf_model.h"

namespace ibrdf {

struct OpenedModel {
  std::string path;  // for messages
  NeuralBrdfModel model;
};

// `name`: as FindModel has it. Refuses a model without the codes of one
// material at least.
StatusOr<OpenedModel> OpenModel(const std::string& name);

}  // namespace ibrdf
