#include "ibrdf/solvers/problem/open_model.h"

#include <utility>

#include "ibrdf/io/model_file.h"

namespace ibrdf {

StatusOr<OpenedModel> OpenModel(const std::string& name) {
  const StatusOr<std::string> path = FindModel(name);
  if (!path.ok()) return path.status();
  StatusOr<NeuralBrdfModel> model = ReadModel(*path);
  if (!model.ok()) return model.status();
  if (model->num_codes() < 3) {
    return InvalidInput(*path + ": names",
                        "expected the codes of at least one material");
  }
  return OpenedModel{*path, *std::move(model)};
}

}  // namespace ibrdf
