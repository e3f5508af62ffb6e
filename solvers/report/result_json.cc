#include "ibrdf/solvers/report/result_json.h"

#include <glog/logging.h>

#include <cmath>
#include <nlohmann/json.hpp>

#include "ibrdf/base/version.h"
#include "ibrdf/io/problem_json.h"
#include "ibrdf/solvers/effects/describe_plan.h"
#include "ibrdf/solvers/optim/conditioning.h"
#include "ibrdf/solvers/report/check_json.h"
#include "ibrdf/solvers/report/gauge_words.h"
#include "ibrdf/solvers/report/light_results.h"
#include "ibrdf/solvers/report/lobe_summary.h"
#include "ibrdf/solvers/report/material_labels.h"
#include "ibrdf/solvers/report/report_warnings.h"
#include "ibrdf/solvers/report/verdict.h"
#include "ibrdf/solvers/solve/reflectance_spread.h"

namespace ibrdf {
namespace {

using Json = nlohmann::ordered_json;

Json Finite(double value) {
  return std::isfinite(value) ? Json(value) : Json();
}

const char* StatusName(const Status& status) {
  switch (status.code()) {
    case StatusCode::kOk:
      return "ok";
    case StatusCode::kNoImprovement:
      return "no_improvement";
    case StatusCode::kInterrupted:
      return "interrupted";
    default:
      return "error";
  }
}

Json VerdictJson(const Verdict& verdict) {
  const TrustRatings& ratings = verdict.ratings;
  Json rated = {{"light_directions", NameOf(ratings.light)},
                {"hue", NameOf(ratings.hue)},
                {"gloss", NameOf(ratings.gloss)},
                {"level", NameOf(ratings.level)}};
  if (ratings.paint) rated["paint"] = NameOf(*ratings.paint);
  return {{"trust", verdict.trust},
          {"doubt", verdict.doubt},
          {"next", verdict.next},
          {"ratings", std::move(rated)}};
}

Json VisibilityJson(const InverseProblem& inverse) {
  const EffectsPlan& plan = inverse.effects;
  Json out = {{"simulated", plan.visibility},
              {"points_probed", plan.probe.points},
              {"hidden_mean", plan.probe.hidden_mean},
              {"hidden_90", plan.probe.hidden_90},
              {"hidden_max", plan.probe.hidden_max},
              {"shadowed_share", plan.probe.shadowed_share},
              {"log_radiance_error_without", plan.omission.unshadowed},
              {"log_radiance_error_threshold", plan.threshold},
              {"seconds_predicted", plan.omission.shadow_seconds}};
  if (const Visibility* rays = inverse.transport.visibility.get()) {
    out["rays"] = rays->num_rays();
    out["bytes"] = rays->MemoryBytes();
  }
  return out;
}

Json InterreflectionJson(const InverseProblem& inverse) {
  const EffectsPlan& plan = inverse.effects;
  Json out = {{"simulated", plan.bounces > 0},
              {"bounces", plan.bounces},
              {"log_radiance_error_by_bounces", plan.omission.bounces},
              {"log_radiance_error_threshold", plan.threshold},
              {"seconds_predicted", plan.omission.bounce_seconds}};
  if (const RadiosityPatches* patches = inverse.transport.patches.get()) {
    out["emitters"] = patches->count();
    out["bytes"] = patches->MemoryBytes();
  }
  return out;
}

// What was decided, and the predictions that it follows from.
Json EffectsJson(const InverseProblem& inverse) {
  return {{"visibility", VisibilityJson(inverse)},
          {"interreflection", InterreflectionJson(inverse)},
          {"log_radiance_error_left_out", inverse.effects.error}};
}

Json MetricsJson(const ResultMetrics& metrics) {
  Json out = Json::object();
  for (const NamedMetric& metric : ListMetrics(metrics)) {
    out[metric.name] = Finite(metric.value);
  }
  return out;
}

Json TraceJson(const std::vector<TraceEntry>& trace) {
  Json out = Json::array();
  for (const TraceEntry& t : trace) {
    out.push_back({{"stage", t.stage},
                   {"seconds", t.seconds},
                   {"scale", t.scale},
                   {"pixels", t.pixels},
                   {"cost", Finite(t.cost)},
                   {"likelihood", Finite(t.likelihood)},
                   {"reflectance_prior", Finite(t.reflectance_prior)},
                   {"illumination_prior", Finite(t.illumination_prior)},
                   {"misfit", Finite(t.misfit)}});
  }
  return out;
}

// What the known light leaves dark; empty where no light is known or no
// reflectance sought.
Json DarkPixelsJson(const SolvedProblem& solved) {
  if (solved.inverse.kind != ProblemKind::kReflectance) return Json::object();
  const DarkPixels& dark = solved.inverse.dark;
  const Eigen::Array3d& ambient = solved.solution.ambient;
  return {{"unlit", dark.num_unlit},
          {"below_floor", dark.num_below_floor},
          {"ambient", {ambient[0], ambient[1], ambient[2]}},
          {"ambient_estimated", (dark.ambient_deviation > 0.0).any()}};
}

// The curves that explain the image's codes; empty where it was known.
Json CurvesJson(const std::vector<CurveEstimate>& curves) {
  Json out = Json::array();
  for (const CurveEstimate& c : curves) {
    Json curve = {{"response", NameOf(c.curve.kind)},
                  {"cost_above_best", Finite(c.cost)}};
    if (c.curve.parameter) {
      curve["response_parameter"] = *c.curve.parameter;
      curve["log_parameter_std"] = Finite(c.log_parameter_std);
    }
    out.push_back(curve);
  }
  return out;
}

Json DeviationsJson(const std::vector<LobeSummary>& lobes) {
  Json out = Json::array();
  for (const LobeSummary& lobe : lobes) {
    out.push_back({{"code_std", lobe.deviation->code},
                   {"log_colour_std", lobe.deviation->log_colour}});
  }
  return out;
}

Json AlternativesJson(const std::vector<Alternative>& alternatives) {
  Json out = Json::array();
  for (const Alternative& a : alternatives) {
    out.push_back({{"start", a.start},
                   {"cost_above_best", Finite(a.cost)},
                   {"brdf_log_difference", Finite(a.brdf_log_difference)}});
  }
  return out;
}

Json MaterialJson(const MaterialSummary& material) {
  Json nearest = Json::array();
  for (const NearMaterial& near : material.nearest) {
    nearest.push_back({{"name", near.name},
                       {"brdf_log_difference", near.brdf_log_difference}});
  }
  Json out = {{"nearest", nearest}};
  // A known reflectance is not summarised.
  if (std::isfinite(material.shares.diffuse)) {
    out["diffuse_share"] = material.shares.diffuse;
    out["specular_share"] = material.shares.specular;
  }
  return out;
}

// Condition number of the posterior's correlations.
double CovarianceCondition(const Solution& solution) {
  const auto side = static_cast<Eigen::Index>(solution.lobe_parameters.size());
  const double condition = ScaledCondition(Eigen::Map<const Eigen::MatrixXd>(
      solution.lobe_covariance.data(), side, side));
  VLOG(1) << "condition of the posterior's correlations " << condition;
  return condition;
}

// What the image adds to the prior; the ranked materials; the models.
void AddInformation(const Solution& solution, Json* out) {
  for (size_t m = 0; m < solution.models.size(); ++m) {
    (*out)["models"][solution.models[m].name] = solution.model_weights[m];
  }
  if (const auto& determined = solution.determined) {
    (*out)["directions"] = {
        {"of", determined->variance_left.size()},
        {"determined", determined->num_determined()},
        {"degrees_of_freedom", determined->degrees_of_freedom()},
        {"nats", determined->information()},
        {"variance_left", determined->variance_left}};
  }
  if (!solution.map_variance_left.empty()) {
    const DeterminedLight light = MeasureDetermined(solution.map_variance_left);
    (*out)["light"] = {
        {"determined_share", light.share},
        {"variance_left", light.variance_left},
        {"variance_left_by_degree", solution.map_variance_left_by_degree}};
  }
  if (solution.ranking.materials.empty()) return;
  constexpr size_t kShown = 5;
  Json most = Json::array();
  for (const MaterialWeight& m : solution.ranking.materials) {
    if (most.size() == kShown) break;
    most.push_back({{"name", m.name}, {"weight", m.weight}});
  }
  (*out)["ranking"] = {
      {"materials", solution.ranking.materials.size()},
      {"entropy_nats", solution.ranking.entropy},
      {"effective_number", solution.ranking.effective_number()},
      {"most_probable", most}};
}

// Lines through the BRDF, 1/sr, with the ends of their bands.
Json SlicesJson(const std::vector<BrdfSlice>& slices) {
  const char* const channels[] = {"red", "green", "blue"};
  Json out = Json::array();
  for (const BrdfSlice& slice : slices) {
    Json one = {{"name", slice.name},
                {"angle", slice.angle},
                {"degrees", slice.degrees}};
    for (int c = 0; c < 3; ++c) {
      one[channels[c]] = {{"brdf", slice.value[c]},
                          {"low", slice.low[c]},
                          {"high", slice.high[c]}};
    }
    out.push_back(std::move(one));
  }
  return out;
}

// How well the reflectance is known.
Json PosteriorJson(const InverseProblem& inverse, const Solution& solution) {
  Json out = Json::object();
  if (!solution.lobe_covariance.empty()) {
    out["lobes"] = DeviationsJson(SummariseLobes(inverse, solution));
    out["covariance"] = solution.lobe_covariance;
    out["condition_number"] = Finite(CovarianceCondition(solution));
  }
  AddInformation(solution, &out);
  if (!solution.slices.empty()) out["slices"] = SlicesJson(solution.slices);
  if (std::isfinite(solution.spread)) {
    out["brdf_spread"] = solution.spread;
    const ErrorToExpect error =
        ExpectError(solution, !inverse.known_map.has_value());
    out["brdf_log_rmse_expected"] = error.median;
    out["brdf_log_rmse_90"] = error.most;
    if (std::isfinite(solution.structured_misfit)) {
      out["structured_misfit"] = solution.structured_misfit;
    }
  }
  if (solution.has_paint()) {
    const AlbedoDeviation albedo =
        MeasureAlbedoDeviation(solution.albedo_log_std, inverse.points);
    out["albedo_log_std_median"] = albedo.median;
    out["albedo_log_std_90"] = albedo.most;
  }
  out["alternatives"] = AlternativesJson(solution.alternatives);
  return out;
}

// Labelled materials, in the order of their labels; empty where there are no
// labels.
Json MaterialsJson(const InverseProblem& inverse, const Solution& solution) {
  Json out = Json::array();
  for (size_t m = 0; m < solution.materials.size(); ++m) {
    const MaterialLabel& label = inverse.materials[m];
    const Solution one = OfMaterial(solution, static_cast<int>(m));
    Json material = {
        {"label", label.value},
        {"pixels", label.pixels},
        {"colour_in_labels_png", ColourOfMaterial(static_cast<int>(m)).name},
        {"srgb_in_labels_png", ColourOfMaterial(static_cast<int>(m)).srgb},
        {"files",
         {MaterialFile(label) + ".binary", MaterialFile(label) + ".json"}},
        {"start", one.start},
        {"material", MaterialJson(SummariseMaterial(inverse, one))},
        {"posterior", PosteriorJson(inverse, one)}};
    out.push_back(std::move(material));
  }
  return out;
}

// Empty where no labels were sought.
Json FoundLabelsJson(const FoundLabels& found) {
  if (found.labels.empty()) return Json::object();
  return {{"gain_nats", Finite(found.gain)},
          {"gain_of_more_nats", Finite(found.gain_of_more)},
          {"cut_short", found.cut_short}};
}

// How the reflectance that was found varies.
ReflectanceVariation VariationOf(const Solution& solution) {
  if (!solution.materials.empty()) return ReflectanceVariation::kLabels;
  return solution.has_paint() ? ReflectanceVariation::kAlbedo
                              : ReflectanceVariation::kNone;
}

// How well each of several views is explained.
Json ViewsJson(const SolvedProblem& solved) {
  Json views = Json::array();
  for (const ViewMisfit& view : solved.metrics.views) {
    views.push_back({{"name", view.name},
                     {"pixels_used", view.pixels},
                     {"misfit", Finite(view.misfit)}});
  }
  return views;
}

// How well each photograph beside the first is explained.
Json OtherLightsJson(const SolvedProblem& solved) {
  Json lights = Json::array();
  for (size_t k = 0; k < solved.solution.other_lights.size(); ++k) {
    lights.push_back(
        {{"file", solved.inverse.other_photographs[k]->file},
         {"results", PhotographFolder("", k)},
         {"misfit", Finite(solved.solution.other_lights[k].misfit)}});
  }
  return lights;
}

// Which photographs to take next; empty where none were chosen.
Json NextViewsJson(const InformativeViews* next) {
  if (next == nullptr) return Json::object();
  Json chosen = Json::array(), farthest = Json::array(), all = Json::array();
  for (size_t k = 0; k < next->chosen.size(); ++k) {
    chosen.push_back({{"candidate", next->candidates[next->chosen[k]].name},
                      {"gain_nats", next->gains[k]}});
  }
  for (const int i : next->farthest) {
    farthest.push_back(next->candidates[i].name);
  }
  for (size_t i = 0; i < next->candidates.size(); ++i) {
    all.push_back({{"candidate", next->candidates[i].name},
                   {"gain_nats", next->first_gains[i]}});
  }
  return {{"from", next->from},
          {"information_nats", next->information},
          {"chosen", std::move(chosen)},
          {"farthest_points", std::move(farthest)},
          {"as_the_next_one", std::move(all)},
          {"seconds", next->seconds}};
}

std::string Text(const Json& document) {
  // Paths need not be UTF-8.
  return document.dump(2, ' ', false, Json::error_handler_t::replace) + "\n";
}

}  // namespace

std::string ResultJson(const SolvedProblem& solved,
                       const MaterialSummary& material) {
  const InverseProblem& inverse = solved.inverse;
  const Solution& solution = solved.solution;
  const ObjectLook* const look = inverse.look.get();
  return Text({{"ibrdf_version", kVersion},
               {"status", StatusName(solution.status)},
               {"verdict", VerdictJson(MakeVerdict(solved))},
               {"warnings", ResultWarnings(solved)},
               {"check", look == nullptr ? Json() : CheckToJson(look->check)},
               {"problem", ProblemToJson(solved.problem)},
               {"effects", Describe(inverse.effects)},
               {"effects_plan", EffectsJson(inverse)},
               {"gauge", GaugeWords(inverse)},
               {"illumination_frame",
                MapFrameName(solved.problem.illumination.output_frame)},
               {"start", solution.start},
               {"material", MaterialJson(material)},
               {"posterior", PosteriorJson(inverse, solution)},
               {"materials", MaterialsJson(inverse, solution)},
               {"labels_found", FoundLabelsJson(solution.found_labels)},
               {"curves", CurvesJson(solution.curves)},
               {"seed", inverse.seed},
               {"pixels_used", solution.pixels_used},
               {"pixels_of_object", inverse.points.size()},
               {"views", ViewsJson(solved)},
               {"other_lights", OtherLightsJson(solved)},
               {"next_views", NextViewsJson(solved.next_views)},
               {"variation", ReflectanceVariationName(VariationOf(solution))},
               {"dark_pixels", DarkPixelsJson(solved)},
               {"likelihood",
                {{"scale", solution.scale}, {"epsilon", solution.epsilon}}},
               {"cost",
                {{"start", Finite(solution.start_cost)},
                 {"end", Finite(solution.end_cost)}}},
               {"metrics", MetricsJson(solved.metrics)},
               {"trace", TraceJson(solution.trace)}});
}

std::string BrdfJson(const SolvedProblem& solved) {
  Json lobes = Json::array();
  for (const LobeSummary& lobe :
       SummariseLobes(solved.inverse, solved.solution)) {
    lobes.push_back({{"code", lobe.code}, {"colour_raw_merl", lobe.colour}});
  }
  return Text({{"model", solved.inverse.model_name},
               {"formula", kLobeFormula},
               {"exponent", solved.inverse.model->exponent},
               {"lobes", lobes}});
}

}  // namespace ibrdf
