// The light given the reflectance: the map of highest posterior probability.
#pragma once
#include <functional>
#include <optional>
#include <string>
#include <vector>

#include "ibrdf/base/status.h"
#include "ibrdf/light/log_map.h"
#include "ibrdf/solvers/estimation/posterior.h"
#include "ibrdf/solvers/estimation/solve_context.h"
#include "ibrdf/solvers/estimation/solve_setup.h"

namespace ibrdf {

// A reflectance that takes an estimate's place.
struct RevisedReflectance {
  std::vector<double> lobes;  // as LobeModel
  // The estimate's map at the level and hue that go with the lobes.
  LogMap log_map;
  // Where set: what the light's priors are then, and what the estimate has of
  // the light. Else that remains the one it came with.
  std::optional<LightPosterior> light = {};
  // Where not empty: the material that these lobes came from, and its lobes.
  std::string initial_guess = {};
  std::vector<double> initial_lobes = {};
};

// What to make of the reflectance in view of a map that is not yet finished;
// empty: it stays.
using ReviseReflectance =
    std::function<StatusOr<std::optional<RevisedReflectance>>(const Estimate&)>;

// The map by the prior that the problem asks for:
//   process  MAP estimate under the Gaussian process
//   unet     from there, as the network's output, which is kept where it
//            explains the image as well (Ulyanov et al. 2018)
//   none     free texels
// revise, of a reflectance that is unknown: where not null, the MAP estimate
// asks for another reflectance after its first few iterations, and again after
// a few more until there is none, and goes on under it.
StatusOr<Estimate> EstimateLight(const SolveSetup& setup,
                                 ReflectanceEstimate reflectance,
                                 SolveContext* context,
                                 const ReviseReflectance& revise = nullptr);

// The MAP estimate under the Gaussian process from the bins alone, in the few
// iterations that a known reflectance needs; the setup's is known. The map's
// sides are halved, where they can be, until it is no wider than that.
StatusOr<Estimate> EstimateProcessLight(const SolveSetup& setup,
                                        ReflectanceEstimate reflectance,
                                        int most_width, SolveContext* context);

// The reflectance under a constant map that gives the image its level: what
// there is to say of an image that no search explains.
Estimate ConstantLight(const SolveSetup& setup,
                       ReflectanceEstimate reflectance);

}  // namespace ibrdf
