#include "ibrdf/solvers/report/report_page.h"

#include <cmath>
#include <filesystem>
#include <string>
#include <vector>

#include "ibrdf/base/format.h"
#include "ibrdf/io/problem_json.h"
#include "ibrdf/solvers/effects/describe_plan.h"
#include "ibrdf/solvers/report/gauge_words.h"
#include "ibrdf/solvers/report/html.h"
#include "ibrdf/solvers/report/html_page.h"
#include "ibrdf/solvers/report/readable_numbers.h"
#include "ibrdf/solvers/report/report_metrics.h"
#include "ibrdf/solvers/report/report_plots.h"
#include "ibrdf/solvers/report/report_posterior.h"
#include "ibrdf/solvers/report/report_warnings.h"
#include "ibrdf/solvers/report/svg_plot.h"
#include "ibrdf/solvers/report/verdict.h"

namespace ibrdf {
namespace {

std::string KindInWords(ProblemKind kind) {
  switch (kind) {
    case ProblemKind::kJoint:
      return "Reflectance and illumination, both unknown.";
    case ProblemKind::kReflectance:
      return "Reflectance under known illumination.";
    case ProblemKind::kIllumination:
      return "Illumination of known reflectance.";
    case ProblemKind::kTextures:
      return "Textures under known illumination.";
  }
  return "";
}

std::string Summary(const SolvedProblem& solved) {
  const ResultMetrics& metrics = solved.metrics;
  const std::string misfit =
      std::isfinite(metrics.misfit) ? Format("%.2g", metrics.misfit) : "-";
  const std::string seconds =
      std::isfinite(metrics.seconds) ? Format("%.0f", metrics.seconds) : "-";
  return KindInWords(solved.problem.kind) + " Misfit " + misfit + " after " +
         seconds + " s, from " + std::to_string(solved.solution.pixels_used) +
         " pixels. The misfit is the mean absolute log error of the render: "
         "the mean of |log L_o - log I| over pixels and channels, with the "
         "rendered radiance L_o and the image I.";
}

std::string VerdictSection(const SolvedProblem& solved) {
  const Verdict verdict = MakeVerdict(solved);
  const TrustRatings& r = verdict.ratings;
  std::vector<std::string> names = {"light's directions", "hue", "gloss",
                                    "brightness"};
  std::vector<std::string> ratings = {NameOf(r.light), NameOf(r.hue),
                                      NameOf(r.gloss), NameOf(r.level)};
  if (r.paint) {
    names.emplace_back("paint");
    ratings.emplace_back(NameOf(*r.paint));
  }
  std::string text;
  for (const std::string& sentence : verdict.Sentences()) {
    text += HtmlElement("p", sentence) + "\n";
  }
  return "<section class=\"verdict\">\n" + text + HtmlTable(names, {ratings}) +
         "</section>\n";
}

std::string WarningList(const SolvedProblem& solved) {
  std::vector<std::string> warnings = ResultWarnings(solved);
  const std::string note = EffectsNote(solved);
  if (!note.empty()) warnings.push_back(note);
  return WarningSection(warnings);
}

using Rows = std::vector<std::vector<std::string>>;

// What the problem left to the program.
Rows Choices(const SolvedProblem& solved) {
  const Solution& solution = solved.solution;
  Rows rows = {
      {"effects", Describe(solved.inverse.effects)},
      {"gauge", GaugeWords(solved.inverse)},
      {"likelihood.scale",
       ShortNumber(solution.scale) +
           " (b of the Laplace distribution of log errors, at the "
           "result)"},
      {"likelihood.epsilon", ShortNumber(solution.epsilon) +
                                 " (radiance added inside the logarithms)"}};
  if (!solution.start.empty()) {
    rows.push_back({"initial guess", solution.start});
  }
  rows.push_back({"seed", std::to_string(solved.inverse.seed)});
  return rows;
}

std::string ProblemSection(const SolvedProblem& solved) {
  Rows settings;
  for (const ProblemSetting& setting : ListSettings(solved.problem)) {
    settings.push_back({setting.key, setting.value});
  }
  return HtmlSection(
      "What was solved",
      HtmlElement("p", KindInWords(solved.problem.kind) +
                           " Problem file: " + solved.problem.path + ".") +
          "\n" + HtmlElement("h3", "What the program chose") + "\n" +
          HtmlTable({}, Choices(solved)) +
          HtmlElement("h3", "The problem as resolved") + "\n" +
          HtmlTable({}, settings));
}

std::string GaugeSection(const InverseProblem& inverse) {
  return HtmlSection(
      "Scale",
      HtmlElement("p",
                  "A reflectance R and a light L render the same image as the "
                  "pair (s R, L / s), for every factor s per channel. No image "
                  "tells s. What set it here: " +
                      GaugeWords(inverse) + ".") +
          "\n");
}

// Which photographs to take next, and what they would add.
std::string NextViewsSection(const InformativeViews* next) {
  if (next == nullptr || next->chosen.empty()) return "";
  Rows rows;
  for (size_t k = 0; k < next->chosen.size(); ++k) {
    const CalibratedView& view = next->candidates[next->chosen[k]];
    const Eigen::Vector3d from = view.world_from_camera.topRightCorner<3, 1>();
    rows.push_back({view.name,
                    "[" + ShortNumber(from.x()) + ", " + ShortNumber(from.y()) +
                        ", " + ShortNumber(from.z()) + "]",
                    ShortNumber(next->gains[k])});
  }
  return HtmlSection(
      "Which photographs to take next",
      HtmlElement(
          "p",
          "Of " + std::to_string(next->candidates.size()) +
              " candidates these would tell the most of codes and colours, "
              "with the unknown light integrated out, each beside those above "
              "it. What the photographs say now is " +
              Format("%.1f", next->information) +
              " nats beyond the prior. Places are in the library's world, y "
              "up; next_views.json has the cameras.") +
          "\n" + HtmlTable({"candidate", "stands at", "adds (nats)"}, rows));
}

std::string PlotSection(const std::vector<TraceEntry>& trace) {
  const std::vector<LinePlot> plots = TracePlots(trace);
  if (plots.empty()) return "";
  return HtmlSection(
      "Progress",
      HtmlElement(
          "p",
          "A point is the best state after a step. Misfits compare across all "
          "steps at the image's pixels. Costs compare only between steps with "
          "as many pixels and the same scale b of the likelihood. The scale is "
          "estimated anew in each outer iteration, and a smaller b raises the "
          "likelihood term. Lines break where the number of pixels changes.") +
          "\n" + HtmlPlots(plots));
}

}  // namespace

StatusOr<std::string> ReportPage(const SolvedProblem& solved,
                                 const std::vector<ReportGroup>& groups) {
  const Problem& problem = solved.problem;
  // Many problem files are called problem.yaml.
  const std::string& named =
      problem.image.file.empty() ? problem.path : problem.image.file;
  const std::string name = std::filesystem::path(named).filename().string();
  const ProblemKind kind = problem.kind;
  std::string body = HtmlElement("h1", name) + "\n" + VerdictSection(solved) +
                     HtmlElement("p", Summary(solved), "class=\"summary\"") +
                     "\n" + WarningList(solved);
  for (const ReportGroup& group : groups) {
    const StatusOr<std::string> section = GroupSection(group);
    if (!section.ok()) return section.status();
    body += *section;
  }
  body += PosteriorSection(solved.inverse, solved.solution);
  body += LightPosteriorSection(solved.solution);
  body += NextViewsSection(solved.next_views);
  body += MetricsSection(solved.metrics, kind);
  if (kind == ProblemKind::kJoint) body += GaugeSection(solved.inverse);
  body += PlotSection(solved.solution.trace);
  body += ProblemSection(solved);
  return HtmlPage(name, body + ReportFooter());
}

}  // namespace ibrdf
