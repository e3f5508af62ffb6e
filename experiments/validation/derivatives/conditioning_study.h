// Condition numbers of a reflectance's normal equations.
#pragma once
#include <string>
#include <vector>

#include "ibrdf/flow/neural_brdf_model.h"

namespace ibrdf {
namespace derivatives {

struct ConditioningRow {
  std::string material, lobes;
  // ScaledCondition of J^T J under known light: of the likelihood alone and
  // with the materials' prior.
  double image = 0.0, with_prior = 0.0;
  // Conditioning of the marginal posterior's Hessian at its minimum, light
  // unknown; NaN: not wanted.
  double marginal = 0.0;
  // Standard deviations of the whitened coordinates by the Gauss-Newton Hessian
  // over those by that Hessian: smallest, median, largest; NaN where that one
  // is not positive definite.
  double smallest_ratio = 0.0, median_ratio = 0.0, largest_ratio = 0.0;
};

// A matte, a glossy and a mirror-like material of the default model on a
// sphere under a smooth map, each as one lobe, as its two and as two that
// coincide.
std::vector<ConditioningRow> StudyConditioning(const NeuralBrdfModel& model,
                                               bool marginal);

}  // namespace derivatives
}  // namespace ibrdf
