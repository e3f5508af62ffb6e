// How the materials of the prior share the posterior.
#pragma once
#include <string>
#include <vector>

#include "ibrdf/solvers/marginal/reflectance_search.h"

namespace ibrdf {

struct MaterialWeight {
  std::string name;
  double weight = 0.0;  // sums to 1 over all
};

// What Laplace's approximation at one optimum cannot see: how the ranked
// materials share the posterior, each as it is at the first, coarsest
// resolution, before any is refined.
struct MaterialRanking {
  std::vector<MaterialWeight> materials;  // by weight
  double entropy = 0.0;                   // nats
  // exp(entropy): as many of equal weight are as uncertain.
  double effective_number() const;
};

// From costs in nats. Empty where no cost is finite.
MaterialRanking RankMaterials(const std::vector<MaterialCandidate>& candidates);

}  // namespace ibrdf
