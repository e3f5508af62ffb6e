#include "ibrdf/solvers/marginal/best_of_searches.h"

#include <algorithm>
#include <utility>

namespace ibrdf {
namespace {

using Results = std::vector<ReflectanceSearchResult>;
using Candidates = std::vector<MaterialCandidate>;

int FinestWidth(const Results& results) {
  int width = 0;
  for (const ReflectanceSearchResult& r : results) {
    width = std::max(width, r.map_width);
  }
  return width;
}

// The materials in the order that SearchReflectances has them.
Candidates LeastOf(Candidates first, const Candidates& second) {
  for (const MaterialCandidate& other : second) {
    const auto same = std::find_if(
        first.begin(), first.end(),
        [&](const MaterialCandidate& c) { return c.name == other.name; });
    if (same == first.end() || !(other.cost < same->cost)) continue;
    same->cost = other.cost;
    same->parameters = other.parameters;
    same->light_level = other.light_level;
  }
  SortByCost(&first);
  return first;
}

// The better of two optima of one model, with the candidates of both.
ReflectanceSearchResult BetterOf(ReflectanceSearchResult first,
                                 ReflectanceSearchResult second) {
  Candidates candidates =
      LeastOf(std::move(first.candidates), second.candidates);
  ReflectanceSearchResult& better = second.cost < first.cost ? second : first;
  better.candidates = std::move(candidates);
  return std::move(better);
}

}  // namespace

Results BestOfSearches(Results first, Results second) {
  if (FinestWidth(second) < FinestWidth(first)) return first;
  if (FinestWidth(first) < FinestWidth(second)) return second;
  for (ReflectanceSearchResult& other : second) {
    const auto same = std::find_if(first.begin(), first.end(),
                                   [&](const ReflectanceSearchResult& r) {
                                     return r.model == other.model;
                                   });
    if (same == first.end()) {
      first.push_back(std::move(other));
    } else {
      *same = BetterOf(std::move(*same), std::move(other));
    }
  }
  std::sort(first.begin(), first.end(),
            [](const auto& a, const auto& b) { return a.model < b.model; });
  return first;
}

}  // namespace ibrdf
