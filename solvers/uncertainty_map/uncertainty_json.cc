#include "ibrdf/solvers/uncertainty_map/uncertainty_json.h"

#include <algorithm>
#include <cmath>
#include <nlohmann/json.hpp>

#include "ibrdf/base/version.h"
#include "ibrdf/io/problem_json.h"
#include "ibrdf/uncertainty/band_limit.h"

namespace ibrdf {
namespace {
using Json = nlohmann::json;

Json ViewsTold(const UncertaintyResult& result) {
  Json out = Json::array();
  for (size_t k = 0; k < result.inputs.views.size(); ++k) {
    const PhotographedView& view = result.inputs.views[k];
    out.push_back({{"name", view.name},
                   {"file", view.file},
                   {"texels", result.texels.texels_of_view[k]}});
  }
  return out;
}

Json MetricsTold(const TexelEntropy& texels) {
  const auto count = static_cast<double>(texels.observed_views.size());
  const auto below = std::count(texels.below_band_limit.begin(),
                                texels.below_band_limit.end(), uint8_t{1});
  return {{"texels", texels.observed_views.size()},
          {"texels_observed", texels.CountObserved()},
          {"share_of_texels_observed", texels.CountObserved() / count},
          {"mean_entropy", texels.MeanEntropy(false)},
          {"mean_entropy_of_observed", texels.MeanEntropy(true)},
          {"texels_below_band_limit", below}};
}

Json BandLimitTold(const UncertaintyInputs& inputs) {
  const double alpha = LeastAlpha(static_cast<int>(inputs.views.size()));
  return {{"prefilter_alpha", inputs.prefilter_alpha},
          {"least_alpha", alpha},
          {"least_roughness", std::sqrt(alpha)}};
}

Json NamesOf(const NextViews& next, const std::vector<int>& candidates) {
  Json out = Json::array();
  for (const int i : candidates) out.push_back(next.candidates[i].name);
  return out;
}

Json NextViewsTold(const NextViews& next) {
  Json chosen = Json::array();
  for (size_t i = 0; i < next.chosen.size(); ++i) {
    chosen.push_back({{"candidate", next.candidates[next.chosen[i]].name},
                      {"expected_entropy", next.expected_entropy[i + 1]}});
  }
  return {{"candidates", next.candidates.size()},
          {"texels", next.texels},
          {"entropy_before", next.expected_entropy[0]},
          {"chosen", std::move(chosen)},
          {"farthest_points", NamesOf(next, next.farthest)}};
}

}  // namespace

std::string UncertaintyJsonText(const Problem& problem,
                                const UncertaintyOptions& options,
                                const UncertaintyResult& result) {
  Json seconds = Json::object();
  for (const StageSeconds& stage : result.stages) {
    seconds[stage.stage] = stage.seconds;
  }
  Json out = {{"version", kVersion},
              {"problem", ProblemToJson(problem)},
              {"views", ViewsTold(result)},
              {"metrics", MetricsTold(result.texels)},
              {"band_limit", BandLimitTold(result.inputs)},
              {"seconds", std::move(seconds)},
              {"warnings", result.inputs.warnings}};
  if (result.next) {
    out["next_views"] = NextViewsTold(*result.next);
    out["next_views"]["add"] = options.add;
    out["next_views"]["from"] = options.candidates;
  }
  // Paths need not be UTF-8.
  return out.dump(2, ' ', false, Json::error_handler_t::replace) + "\n";
}

}  // namespace ibrdf
