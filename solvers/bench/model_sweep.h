// What the sweeps share that estimate reflectance with a trained model.
#pragma once
#include <functional>
#include <string>
#include <vector>

#include "ibrdf/base/status.h"
#include "ibrdf/solvers/bench/held_out_models.h"
#include "ibrdf/solvers/bench/solver_sweep.h"

namespace ibrdf {

struct ModelSweepOptions : SolverSweepOptions, ModelOptions {
  int lobes = 2;
};

// material, map, geometry, lobes, method and model, which name a run, then
// `rest`.
std::vector<std::string> ModelSweepColumns(
    const std::vector<std::string>& rest);
inline constexpr int kModelSweepKeys = 6;

// Calls `add` for the cases that options select, by material, then map, with
// the model of each. Fails on a material, map or model that is not there.
Status ForEachModelCase(
    const ModelSweepOptions& options,
    const std::function<void(const SweepCase& c, const ChosenModel& model)>&
        add);

// A run of such a case, for a sweep whose columns are of ModelSweepColumns: the
// problem file NAME.yaml with the text `problem`, results in the folder
// ESTIMATE_LOBES_METHOD[_MODEL].
SolverRun ModelRun(const ModelSweepOptions& options, const SweepCase& c,
                   const ChosenModel& model, const std::string& name,
                   const std::string& problem, const std::string& estimate,
                   const std::vector<std::string>& columns);

}  // namespace ibrdf
