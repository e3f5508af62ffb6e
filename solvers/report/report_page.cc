#include "ibrdf/solvers/report/report_page.h"

#include <utility>

#include "ibrdf/solvers/report/html.h"
#include "ibrdf/solvers/report/json_values.h"
#include "ibrdf/solvers/report/report_metrics.h"
#include "ibrdf/solvers/report/report_plots.h"
#include "ibrdf/solvers/report/report_posterior.h"
#include "ibrdf/solvers/report/report_style.h"
#include "ibrdf/solvers/report/report_warnings.h"
#include "ibrdf/solvers/report/svg_plot.h"

namespace ibrdf {
namespace {
using Json = nlohmann::ordered_json;

std::string Section(const std::string& heading, const std::string& body) {
  return "<section>\n" + HtmlElement("h2", heading) + "\n" + body +
         "</section>\n";
}

std::string KindInWords(const Json& problem) {
  const std::string kind = TextAt(problem, "problem");
  if (kind == "joint") return "Reflectance and illumination, both unknown.";
  if (kind == "reflectance") return "Reflectance under known illumination.";
  if (kind == "illumination") return "Illumination of known reflectance.";
  return kind;
}

std::string Summary(const Json& result) {
  const Json metrics = MemberAt(result, "metrics");
  std::string text = KindInWords(MemberAt(result, "problem"));
  text += " Misfit " + ShortNumber(NumberAt(metrics, "misfit")) +
          " (mean |log render - log image|) after " +
          ShortNumber(NumberAt(metrics, "seconds")) + " s, from " +
          ShortNumber(NumberAt(result, "pixels_used")) + " pixels.";
  return text;
}

std::string WarningList(const Json& result) {
  std::string items;
  for (const std::string& warning : ResultWarnings(result)) {
    items += HtmlElement("li", warning) + "\n";
  }
  if (items.empty()) return "";
  return "<section class=\"warnings\">\n" + HtmlElement("h2", "Warnings") +
         "\n<ul>\n" + items + "</ul>\n</section>\n";
}

// One row for each leaf of the document, named as --set names it.
void Flatten(const std::string& name, const Json& value,
             std::vector<std::vector<std::string>>* rows) {
  if (value.is_object() && !value.empty()) {
    for (const auto& [key, member] : value.items()) {
      Flatten(name.empty() ? key : name + "." + key, member, rows);
    }
    return;
  }
  rows->push_back(
      {name, value.is_string()
                 ? value.get<std::string>()
                 : value.dump(-1, ' ', false, Json::error_handler_t::replace)});
}

std::string ProblemSection(const Json& result) {
  std::vector<std::vector<std::string>> rows;
  Flatten("", MemberAt(result, "problem"), &rows);
  std::vector<std::vector<std::string>> chosen = {
      {"effects", TextAt(result, "effects")},
      {"gauge", TextAt(result, "gauge")}};
  const Json likelihood = MemberAt(result, "likelihood");
  chosen.push_back({"likelihood.scale",
                    ShortNumber(NumberAt(likelihood, "scale")) +
                        " (b of the Laplacian, natural log, at the end)"});
  chosen.push_back(
      {"likelihood.epsilon", ShortNumber(NumberAt(likelihood, "epsilon")) +
                                 " (radiance added inside the logarithms)"});
  const std::string start = TextAt(result, "start");
  if (!start.empty()) chosen.push_back({"start", start});
  chosen.push_back({"seed", ShortNumber(NumberAt(result, "seed"))});
  return Section("What was solved",
                 HtmlElement("p", KindInWords(MemberAt(result, "problem"))) +
                     "\n" + HtmlElement("h3", "What the program chose") + "\n" +
                     HtmlTable({}, chosen) +
                     HtmlElement("h3", "The problem as resolved") + "\n" +
                     HtmlTable({}, rows));
}

std::string GaugeSection(const Json& result) {
  return Section(
      "Scale",
      HtmlElement("p",
                  "(s R, L / s) renders the same image for every s, per "
                  "channel, so that no image fixes it. Here: " +
                      TextAt(result, "gauge") + ".") +
          "\n");
}

std::string PlotSection(const Json& trace) {
  const std::vector<LinePlot> plots = TracePlots(trace);
  if (plots.empty()) return "";
  std::string body =
      HtmlElement(
          "p",
          "The best state after each step. Misfits compare across the "
          "steps at the pixels; costs only between steps with as many "
          "pixels and the same scale b, which is estimated anew in "
          "each round: a smaller b raises the likelihood term. Lines break "
          "where the number of pixels changes.") +
      "\n<div class=\"plots\">\n";
  for (const LinePlot& plot : plots) {
    body += "<div class=\"plot\">\n" + SvgLinePlot(plot) + "</div>\n";
  }
  return Section("Progress", body + "</div>\n");
}

}  // namespace

StatusOr<std::string> ReportPage(const ReportInput& input) {
  const Json& result = input.result;
  const Json problem = MemberAt(result, "problem");
  std::string body = HtmlElement("h1", input.name) + "\n" +
                     HtmlElement("p", Summary(result), "class=\"summary\"") +
                     "\n" + WarningList(result);
  for (const ReportGroup& group : input.groups) {
    const StatusOr<std::string> section = GroupSection(group);
    if (!section.ok()) return section.status();
    body += *section;
  }
  body += PosteriorSection(MemberAt(result, "posterior"), input.brdf);
  body += MetricsSection(MemberAt(result, "metrics"), problem);
  if (TextAt(problem, "problem") == "joint") body += GaugeSection(result);
  body += PlotSection(MemberAt(result, "trace"));
  body += ProblemSection(result);
  body += HtmlElement("footer", "ibrdf " + TextAt(result, "ibrdf_version") +
                                    ". Numbers in full: result.json, beside "
                                    "this file. Logarithms are natural.") +
          "\n";
  return "<!DOCTYPE html>\n<html lang=\"en\">\n<head>\n"
         "<meta charset=\"utf-8\" />\n"
         "<meta name=\"viewport\" content=\"width=device-width, "
         "initial-scale=1\" />\n"
         "<meta name=\"color-scheme\" content=\"light dark\" />\n" +
         HtmlElement("title", input.name + " - ibrdf") + "\n<style>\n" +
         kReportStyle + "</style>\n</head>\n<body>\n<main>\n" + body +
         "</main>\n</body>\n</html>\n";
}

}  // namespace ibrdf
