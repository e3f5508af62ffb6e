// The methods of the sweep `merl-fit` that are flows.
#pragma once
#include <memory>
#include <string>

#include "ibrdf/flow/neural_brdf_model.h"
#include "ibrdf/solvers/bench/table_fitter.h"
#include "ibrdf/solvers/table_fit/lobe_table_fit.h"

namespace ibrdf {

// `flow`: codes and colours of `lobes` lobes fitted to a table; the flow's
// weights and its embedding are fixed. model_name: for the results.
std::shared_ptr<const TableFitter> FlowFitter(
    std::shared_ptr<const LobeTableFitter> fitter,
    const std::string& model_name, const LobeTableFitOptions& options);

// `flow_free`: a flow of its own for every table, whose three channels are told
// apart by codes (Chen et al. 2020, Fig. 2: unconditional).
struct FreeFlowOptions {
  int64_t steps = 5000;
  FlowShape shape;
};
std::shared_ptr<const TableFitter> FreeFlowFitter(
    const FreeFlowOptions& options);

}  // namespace ibrdf
