// What the training materials say before any image is seen: starts spread over
// the embedding, and the level of their colours.
#pragma once
#include <string>
#include <vector>

#include "ibrdf/flow/neural_brdf_model.h"
#include "ibrdf/solvers/priors/prior_costs.h"

namespace ibrdf {

// A training material: mean code of its channels.
struct MaterialCode {
  std::string name;
  std::vector<double> code;  // [code_size], in the unit ball
};
std::vector<MaterialCode> MaterialCodes(const NeuralBrdfModel& model);

// `count` of them, spread out: the one nearest to the mean of all codes first,
// then each time the one farthest from those taken.
std::vector<MaterialCode> SpreadMaterials(const NeuralBrdfModel& model,
                                          int count);

// Mean and standard deviation of log colours over the embedding, for two or
// more lobes that share the reflectance.
LobePrior EmbeddingPrior(const NeuralBrdfModel& model, double prior_sigma);

}  // namespace ibrdf
