#include "ibrdf/solvers/estimation/material_ranking.h"

#include <algorithm>
#include <cmath>
#include <limits>

namespace ibrdf {

double MaterialRanking::effective_number() const {
  return materials.empty() ? 0.0 : std::exp(entropy);
}

MaterialRanking RankMaterials(
    const std::vector<MaterialCandidate>& candidates) {
  MaterialRanking ranking;
  double least = std::numeric_limits<double>::infinity();
  for (const MaterialCandidate& c : candidates) {
    least = std::min(least, c.screen_cost);
  }
  if (!std::isfinite(least)) return ranking;
  double sum = 0.0;
  for (const MaterialCandidate& c : candidates) {
    const double weight = std::exp(least - c.screen_cost);
    ranking.materials.push_back({c.name, std::isfinite(weight) ? weight : 0.0});
    sum += ranking.materials.back().weight;
  }
  for (MaterialWeight& m : ranking.materials) {
    m.weight /= sum;
    if (m.weight > 0.0) ranking.entropy -= m.weight * std::log(m.weight);
  }
  std::stable_sort(ranking.materials.begin(), ranking.materials.end(),
                   [](const MaterialWeight& a, const MaterialWeight& b) {
                     return a.weight > b.weight;
                   });
  return ranking;
}

}  // namespace ibrdf
