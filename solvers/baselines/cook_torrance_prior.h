// What the training materials say about Cook-Torrance lobes.
#pragma once
#include "ibrdf/base/status.h"
#include "ibrdf/flow/neural_brdf_model.h"
#include "ibrdf/solvers/priors/material_prior.h"

namespace ibrdf {

// JointMaterialPrior of CookTorranceLobes: GaussianPrior of the models fitted
// to the tables of the materials' lobes, and the materials to start from. No
// wall; the code of the Lambertian lobe, which does nothing, is N(0, I).
// kInvalidInput where the model has no fits or fewer than three materials.
StatusOr<MaterialPrior> CookTorrancePrior(const NeuralBrdfModel& model,
                                          int num_threads);

}  // namespace ibrdf
