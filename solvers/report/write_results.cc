#include "ibrdf/solvers/report/write_results.h"

#include <glog/logging.h>

#include <algorithm>
#include <cmath>
#include <nlohmann/json.hpp>

#include "ibrdf/base/eigen_vectors.h"
#include "ibrdf/base/format.h"
#include "ibrdf/base/version.h"
#include "ibrdf/brdf/lobe_mixture.h"
#include "ibrdf/io/atomic_file.h"
#include "ibrdf/io/exr.h"
#include "ibrdf/io/merl.h"
#include "ibrdf/io/output_paths.h"
#include "ibrdf/io/problem_file.h"
#include "ibrdf/io/problem_json.h"
#include "ibrdf/metrics/brdf_metrics.h"
#include "ibrdf/metrics/illumination_metrics.h"
#include "ibrdf/metrics/image_metrics.h"
#include "ibrdf/solvers/effects/describe_plan.h"
#include "ibrdf/solvers/optim/conditioning.h"
#include "ibrdf/solvers/report/report_page.h"
#include "ibrdf/solvers/report/result_preview.h"
#include "ibrdf/solvers/solve/reflectance_spread.h"

namespace ibrdf {
namespace {

using Json = nlohmann::ordered_json;

// Previews of reflectance and map, the table; and what grows with the image.
constexpr double kWriteSeconds = 0.75;
constexpr double kWriteSecondsPerMegapixel = 2.0;

Json Metric(double value) {
  return std::isfinite(value) ? Json(value) : Json();
}

// What was decided, and the predictions that it follows from.
Json EffectsJson(const InverseProblem& inverse) {
  const EffectsPlan& plan = inverse.effects;
  Json visibility = {{"simulated", plan.visibility},
                     {"points_probed", plan.probe.points},
                     {"hidden_mean", plan.probe.hidden_mean},
                     {"hidden_90", plan.probe.hidden_90},
                     {"hidden_max", plan.probe.hidden_max},
                     {"shadowed_share", plan.probe.shadowed_share},
                     {"log_radiance_error_without", plan.omission.unshadowed},
                     {"log_radiance_error_threshold", plan.threshold},
                     {"seconds_predicted", plan.omission.shadow_seconds}};
  if (const Visibility* rays = inverse.transport.visibility.get()) {
    visibility["rays"] = rays->num_rays();
    visibility["bytes"] = rays->MemoryBytes();
  }
  Json interreflection = {
      {"simulated", plan.bounces > 0},
      {"bounces", plan.bounces},
      {"log_radiance_error_by_bounces", plan.omission.bounces},
      {"log_radiance_error_threshold", plan.threshold},
      {"seconds_predicted", plan.omission.bounce_seconds}};
  if (const RadiosityPatches* patches = inverse.transport.patches.get()) {
    interreflection["emitters"] = patches->count();
    interreflection["bytes"] = patches->MemoryBytes();
  }
  return {{"visibility", visibility},
          {"interreflection", interreflection},
          {"log_radiance_error_left_out", plan.error}};
}

// Pixels that the estimate renders.
Mask ObjectMask(const InverseProblem& inverse) {
  Mask mask(inverse.image.width, inverse.image.height, 0);
  for (const ShadingPoint& p : inverse.points) mask.inside[p.pixel] = 1;
  return mask;
}

Status AddMetrics(const InverseProblem& inverse, const Solution& estimate,
                  const Truth& truth, Json* metrics) {
  Json& m = *metrics;
  m["seconds"] = estimate.seconds;
  m["misfit"] = Metric(estimate.misfit);
  if (!truth.brdf.raw.empty() && !estimate.brdf.raw.empty()) {
    const StatusOr<BrdfMetrics> b = CompareBrdfs(estimate.brdf, truth.brdf);
    if (!b.ok()) return b.status();
    m["brdf_log_rmse"] = Metric(b->log_rmse);
    m["brdf_log_rmse_aligned"] = Metric(b->log_rmse_aligned);
    m["brdf_log_rmse_below80"] = Metric(b->log_rmse_below80);
  }
  if (!truth.illumination.empty() && !inverse.known_map.has_value()) {
    const StatusOr<IlluminationMetrics> l =
        CompareIlluminations(estimate.map, truth.illumination);
    if (!l.ok()) return l.status();
    m["illumination_relative_log_rmse"] = Metric(l->relative_log_rmse);
    m["illumination_relative_log_rmse_aligned"] =
        Metric(l->relative_log_rmse_aligned);
    m["illumination_relative_log_rmse_unweighted"] =
        Metric(l->relative_log_rmse_unweighted);
  }
  const StatusOr<ImageMetrics> i =
      CompareImages(estimate.render, inverse.image, ObjectMask(inverse));
  if (i.ok()) {
    m["image_log_rmse"] = Metric(i->log_rmse);
    m["psnr"] = Metric(i->psnr);
    m["dssim"] = Metric(i->dssim);
  }
  return OkStatus();
}

Json TraceJson(const Solution& estimate) {
  Json trace = Json::array();
  for (const TraceEntry& t : estimate.trace) {
    trace.push_back({{"stage", t.stage},
                     {"seconds", t.seconds},
                     {"scale", t.scale},
                     {"pixels", t.pixels},
                     {"cost", Metric(t.cost)},
                     {"likelihood", Metric(t.likelihood)},
                     {"reflectance_prior", Metric(t.reflectance_prior)},
                     {"illumination_prior", Metric(t.illumination_prior)},
                     {"misfit", Metric(t.misfit)}});
  }
  return trace;
}

Json LobesJson(const InverseProblem& inverse, const Solution& estimate) {
  const LobeMixture mixture({inverse.lobes, inverse.model->shape.code_size()},
                            estimate.lobe_parameters.data());
  Json lobes = Json::array();
  for (int k = 0; k < inverse.lobes; ++k) {
    // Not RawColours: the scale of solver.gauge is not clamped.
    Json colour = Json::array();
    for (const double a : mixture.log_colour(k)) colour.push_back(std::exp(a));
    lobes.push_back(
        {{"code", ToVector(mixture.code(k))}, {"colour_raw_merl", colour}});
  }
  return lobes;
}

// How well the reflectance is known: standard deviations of what LobesJson
// writes, log colours, and other materials' ends.
Json PosteriorJson(const InverseProblem& inverse, const Solution& estimate) {
  Json out = Json::object();
  if (!estimate.lobe_covariance.empty()) {
    const size_t n = estimate.lobe_parameters.size();
    std::vector<double> std;
    for (size_t i = 0; i < n; ++i) {
      std.push_back(std::sqrt(estimate.lobe_covariance[i * n + i]));
    }
    const LobeMixture of_lobes(
        {inverse.lobes, inverse.model->shape.code_size()}, std.data());
    Json lobes = Json::array();
    for (int k = 0; k < inverse.lobes; ++k) {
      lobes.push_back({{"code_std", ToVector(of_lobes.code(k))},
                       {"log_colour_std", ToVector(of_lobes.log_colour(k))}});
    }
    out["lobes"] = lobes;
    out["covariance"] = estimate.lobe_covariance;
    const auto side = static_cast<Eigen::Index>(n);
    const double condition = ScaledCondition(Eigen::Map<const Eigen::MatrixXd>(
        estimate.lobe_covariance.data(), side, side));
    VLOG(1) << "condition of the posterior's correlations " << condition;
    out["condition_number"] = Metric(condition);
  }
  if (std::isfinite(estimate.spread)) {
    out["brdf_spread"] = estimate.spread;
    const ErrorToExpect error = ExpectError(estimate.spread);
    out["brdf_log_rmse_expected"] = error.median;
    out["brdf_log_rmse_90"] = error.most;
  }
  Json alternatives = Json::array();
  for (const Alternative& a : estimate.alternatives) {
    alternatives.push_back(
        {{"start", a.start},
         {"cost_above_best", Metric(a.cost)},
         {"brdf_log_difference", Metric(a.brdf_log_difference)}});
  }
  out["alternatives"] = alternatives;
  return out;
}

// The document as a file; paths need not be UTF-8.
std::string Text(const Json& document) {
  return document.dump(2, ' ', false, Json::error_handler_t::replace) + "\n";
}

const char* Gauge(const InverseProblem& inverse) {
  if (inverse.known_map.has_value()) return "set by the known illumination";
  if (inverse.known_brdf.has_value()) return "set by the known reflectance";
  switch (inverse.solver.gauge) {
    case SolverGauge::kGreyLight:
      return "scale between reflectance and light: the light's mean radiance "
             "is grey; level: as with gauge: prior";
    case SolverGauge::kUnitLight:
      return "scale between reflectance and light: the light's mean radiance "
             "is 1 in every channel";
    case SolverGauge::kPrior:
      break;
  }
  if (inverse.solver.estimator == SolverEstimator::kMarginal) {
    return "scale between reflectance and light: mean log reflectance that of "
           "the training materials; hue: most probable";
  }
  return "scale per channel between reflectance and light: least prior cost of "
         "log colours (training materials) and of the light's mean chroma";
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

// log L_o - log I with the likelihood's epsilon; 0 outside and where the pixel
// took no part: other programs sum over the file.
Image Residual(const InverseProblem& inverse, const Solution& estimate) {
  Image residual(inverse.image.width, inverse.image.height);
  for (const ShadingPoint& p : inverse.points) {
    const float* const observed = &inverse.image.rgb[size_t{3} * p.pixel];
    if (!std::all_of(observed, observed + 3,
                     [](float v) { return std::isfinite(v) && v > 0.0f; })) {
      continue;
    }
    for (int c = 0; c < 3; ++c) {
      const size_t at = size_t{3} * p.pixel + c;
      residual.rgb[at] = static_cast<float>(
          std::log(estimate.render.rgb[at] + estimate.epsilon) -
          std::log(observed[c] + estimate.epsilon));
    }
  }
  return residual;
}

std::vector<std::string> MetricLines(const Json& metrics) {
  std::vector<std::string> lines;
  for (const auto& [name, value] : metrics.items()) {
    if (!value.is_number()) continue;
    lines.push_back(Format("%s %.4g", name.c_str(), value.get<double>()));
  }
  return lines;
}

}  // namespace

double PredictWriteSeconds(const InverseProblem& inverse) {
  const double megapixels = 1e-6 * inverse.image.width * inverse.image.height;
  return kWriteSeconds + kWriteSecondsPerMegapixel * megapixels;
}

std::vector<std::string> ResultPaths(const Problem& problem,
                                     const std::string& folder) {
  std::vector<std::string> paths = {
      "result.json",  "report.html", "illumination.exr", "render.exr",
      "residual.exr", "input.png",   "render.png",       "residual.png",
      "overview.png", "brdf.png",    "illumination.png"};
  if (!problem.reflectance.known()) {
    paths.insert(paths.end(), {"brdf.binary", "brdf.json"});
  }
  if (!problem.illumination.known()) {
    paths.emplace_back("illumination_log_std.exr");
  }
  for (std::string& path : paths) path.insert(0, folder + "/");
  return paths;
}

Status WriteResults(const Problem& problem, const InverseProblem& inverse,
                    const Truth& truth, const Solution& estimate,
                    const std::string& folder, std::string* metrics_text) {
  IBRDF_RETURN_IF_ERROR(PrepareFolder(folder));
  Json metrics = Json::object();
  IBRDF_RETURN_IF_ERROR(AddMetrics(inverse, estimate, truth, &metrics));

  const auto path = [&](const char* name) { return folder + "/" + name; };
  // Of an earlier run, these would speak for what a run that is cut off leaves,
  // and the others be taken for results of this one.
  std::vector<std::string> earlier = {"result.json", "report.html", "brdf.png"};
  if (estimate.brdf.raw.empty()) {
    earlier.insert(earlier.end(), {"brdf.binary", "brdf.json"});
  }
  if (estimate.map_std.rgb.empty()) {
    earlier.emplace_back("illumination_log_std.exr");
  }
  RemoveEarlier(problem, folder, earlier);
  Json brdf;
  if (!estimate.brdf.raw.empty()) {
    IBRDF_RETURN_IF_ERROR(WriteMerl(estimate.brdf, path("brdf.binary")));
    brdf = {{"model", problem.reflectance.model.empty()
                          ? "default"
                          : problem.reflectance.model},
            {"formula",
             "raw = sum over lobes of colour * density(code) ^ exponent"},
            {"exponent", inverse.model->exponent},
            {"lobes", LobesJson(inverse, estimate)}};
    IBRDF_RETURN_IF_ERROR(WriteFileAtomically(path("brdf.json"), Text(brdf)));
  }
  IBRDF_RETURN_IF_ERROR(WriteExr(estimate.map, path("illumination.exr")));
  if (!estimate.map_std.rgb.empty()) {
    IBRDF_RETURN_IF_ERROR(
        WriteExr(estimate.map_std, path("illumination_log_std.exr")));
  }
  IBRDF_RETURN_IF_ERROR(WriteExr(estimate.render, path("render.exr")));
  IBRDF_RETURN_IF_ERROR(
      WriteExr(Residual(inverse, estimate), path("residual.exr")));

  ResultPreviewInput preview;
  preview.title = problem.path.substr(problem.path.find_last_of('/') + 1);
  preview.input = inverse.image;
  preview.mask = ObjectMask(inverse);
  preview.render = estimate.render;
  preview.illumination = estimate.map;
  preview.reference_illumination = truth.illumination;
  preview.brdf = estimate.brdf;
  preview.reference_brdf = truth.brdf;
  preview.metrics = MetricLines(metrics);
  preview.num_threads = inverse.num_threads;
  const StatusOr<ResultPanels> panels = MakeResultPanels(preview);
  if (!panels.ok()) return panels.status();
  IBRDF_RETURN_IF_ERROR(WriteResultPreviews(*panels, preview, folder));

  const Json result = {
      {"ibrdf_version", kVersion},
      {"status", StatusName(estimate.status)},
      {"problem", ProblemToJson(problem)},
      {"effects", Describe(inverse.effects)},
      {"effects_plan", EffectsJson(inverse)},
      {"gauge", Gauge(inverse)},
      {"start", estimate.start},
      {"posterior", PosteriorJson(inverse, estimate)},
      {"seed", inverse.seed},
      {"pixels_used", estimate.pixels_used},
      {"pixels_of_object", inverse.points.size()},
      {"likelihood",
       {{"scale", estimate.scale}, {"epsilon", estimate.epsilon}}},
      {"cost",
       {{"start", Metric(estimate.start_cost)},
        {"end", Metric(estimate.end_cost)}}},
      {"metrics", metrics},
      {"trace", TraceJson(estimate)}};
  IBRDF_RETURN_IF_ERROR(WriteFileAtomically(path("result.json"), Text(result)));
  const StatusOr<std::string> page =
      ReportPage({preview.title, result, brdf,
                  MakeReportGroups(*panels, estimate.map_std)});
  if (!page.ok()) return page.status();
  IBRDF_RETURN_IF_ERROR(WriteFileAtomically(path("report.html"), *page));
  if (metrics_text != nullptr) {
    metrics_text->clear();
    for (const std::string& line : MetricLines(metrics)) {
      *metrics_text += "  " + line + "\n";
    }
  }
  return OkStatus();
}

}  // namespace ibrdf
