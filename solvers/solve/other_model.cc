#include "ibrdf/solvers/solve/other_model.h"

#include <utility>

namespace ibrdf {

InverseProblem WithModel(NamedModel model, InverseProblem problem) {
  problem.model = std::move(model.model);
  problem.model_name = std::move(model.name);
  problem.other_models.clear();
  return problem;
}

StatusOr<OtherModel> SetUpWith(const NamedModel& model,
                               const InverseProblem& problem) {
  OtherModel other;
  other.problem =
      std::make_unique<const InverseProblem>(WithModel(model, problem));
  StatusOr<SolveSetup> setup = SetUp(*other.problem);
  if (!setup.ok()) return setup.status();
  other.setup = std::make_unique<const SolveSetup>(*std::move(setup));
  return other;
}

}  // namespace ibrdf
