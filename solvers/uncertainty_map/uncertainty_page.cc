#include "ibrdf/solvers/uncertainty_map/uncertainty_page.h"

#include <algorithm>
#include <cmath>
#include <filesystem>
#include <utility>

#include "ibrdf/base/format.h"
#include "ibrdf/io/problem_json.h"
#include "ibrdf/solvers/drawing/tone_map.h"
#include "ibrdf/solvers/report/html.h"
#include "ibrdf/solvers/report/html_page.h"
#include "ibrdf/solvers/report/preview.h"
#include "ibrdf/solvers/report/report_figures.h"
#include "ibrdf/uncertainty/band_limit.h"

namespace ibrdf {
namespace {

constexpr int kPageSide = 1024;
using TableRows = std::vector<std::vector<std::string>>;

constexpr char kEntropyNote[] =
    "How much the views leave unknown of a texel's roughness and gloss: 0 is "
    "nothing, 1 is everything. It is the entropy of their probability over a "
    "grid of values, as a share of that of a uniform one, and the least of "
    "the three channels. A texel that no view sees has 1. Grey is no surface.";
constexpr char kParameterNote[] =
    "The most probable values, of the green channel; 0 where no view sees the "
    "texel. They are no estimate to rely on where the entropy is high. Width "
    "alpha is the square of roughness, one of a few values of a grid. A "
    "perfect mirror has gloss 1.";
constexpr char kViewNote[] =
    "Photographs, each with its own exposure, and the entropy of the texels "
    "that they show.";
constexpr char kNextNote[] =
    "Candidates after whose photograph the least entropy is to be expected, "
    "the first to take first. The numbers are means over texels and channels "
    "by the spectrum evaluator. next_views.json has the cameras.";

ReportFigure TexelFigure(const TexelRows& rows,
                         const std::vector<float>& values, double high,
                         const std::string& caption) {
  ReportFigure figure;
  figure.caption = caption;
  figure.pixels = DrawTexels(rows, values, high, kPageSide);
  figure.bar = ReportFigure::Bar::kPositive;
  figure.range = high;
  return figure;
}

std::vector<float> ChannelOf(const std::vector<float>& values, size_t channel) {
  std::vector<float> out;
  for (size_t i = channel; i < values.size(); i += 3) out.push_back(values[i]);
  return out;
}

ReportGroup EntropyGroup(const TexelEntropy& texels, const TexelRows& texture) {
  const int most = *std::max_element(texels.observed_views.begin(),
                                     texels.observed_views.end());
  const std::vector<float> seen(texels.observed_views.begin(),
                                texels.observed_views.end());
  const std::vector<float> below(texels.below_band_limit.begin(),
                                 texels.below_band_limit.end());
  return {"Entropy",
          kEntropyNote,
          {TexelFigure(texture, texels.maps.MinimumEntropy(), 1.0,
                       "Entropy, over the texture."),
           TexelFigure(texture, seen, std::max(1, most),
                       "Views that have a sample of the texel."),
           TexelFigure(texture, below, 1.0,
                       "Below the band limit: even the best values do not "
                       "explain what the views show.")}};
}

ReportGroup ParameterGroup(const TexelEntropy& texels,
                           const TexelRows& texture) {
  return {
      "Most probable values",
      kParameterNote,
      {TexelFigure(texture, ChannelOf(texels.maps.alpha, 1), 1.0,
                   "Width alpha of the lobe."),
       TexelFigure(texture, ChannelOf(texels.maps.Ks, 1), 1.0, "Gloss Ks.")}};
}

ReportGroup ViewGroup(const UncertaintyResult& result,
                      const std::vector<TexelRows>& views) {
  ReportGroup group{"Views", kViewNote, {}};
  const std::vector<float> entropy = result.texels.maps.MinimumEntropy();
  for (size_t k = 0; k < views.size(); ++k) {
    const PhotographedView& view = result.inputs.views[k];
    PreviewPanel panel;
    panel.label = view.name;
    panel.image = view.radiance;
    panel.mask = views[k].Covered();
    panel.exposure = ExposureOf(view.radiance, panel.mask, 99.0);
    ReportFigure photograph;
    photograph.caption = view.name + ", the photograph.";
    photograph.pixels = DrawPanel(panel, kPageSide).pixels;
    group.figures.push_back(std::move(photograph));
    group.figures.push_back(
        TexelFigure(views[k], entropy, 1.0, view.name + ", entropy."));
  }
  return group;
}

std::string NextSection(const NextViews& next) {
  TableRows rows = {
      {"-", "photographs alone", Format("%.3f", next.expected_entropy[0])}};
  for (size_t i = 0; i < next.chosen.size(); ++i) {
    rows.push_back({std::to_string(i + 1), next.candidates[next.chosen[i]].name,
                    Format("%.3f", next.expected_entropy[i + 1])});
  }
  return HtmlSection("Next views",
                     HtmlElement("p", kNextNote) + "\n" +
                         HtmlTable({"", "candidate", "entropy"}, rows));
}

std::string NumbersSection(const UncertaintyResult& result) {
  const TexelEntropy& texels = result.texels;
  const auto count = static_cast<double>(texels.observed_views.size());
  const auto below = std::count(texels.below_band_limit.begin(),
                                texels.below_band_limit.end(), uint8_t{1});
  const int views = static_cast<int>(result.inputs.views.size());
  TableRows rows = {
      {"texels", std::to_string(texels.observed_views.size())},
      {"seen by a view",
       Format("%.1f %%", 100.0 * texels.CountObserved() / count)},
      {"mean entropy, over channels",
       Format("%.3f", texels.MeanEntropy(false))},
      {"of the texels that are seen", Format("%.3f", texels.MeanEntropy(true))},
      {"below the band limit", std::to_string(below)},
      {"least roughness that " + std::to_string(views) +
           " views can tell, spread over the sphere",
       Format("%.2f", std::sqrt(LeastAlpha(views)))}};
  for (const StageSeconds& stage : result.stages) {
    rows.push_back({"seconds: " + stage.stage, Format("%.2f", stage.seconds)});
  }
  return HtmlSection("Numbers", HtmlTable({}, rows));
}

std::string ViewTable(const UncertaintyResult& result) {
  TableRows rows;
  for (size_t k = 0; k < result.inputs.views.size(); ++k) {
    const PhotographedView& view = result.inputs.views[k];
    rows.push_back({view.name,
                    SizeName(view.radiance.width, view.radiance.height),
                    std::to_string(result.texels.texels_of_view[k])});
  }
  return HtmlSection("Samples of views",
                     HtmlTable({"view", "pixels", "texels"}, rows));
}

std::string SettingSection(const Problem& problem) {
  TableRows rows;
  for (const ProblemSetting& setting : ListSettings(problem)) {
    rows.push_back({setting.key, setting.value});
  }
  return HtmlSection("The problem", HtmlTable({"key", "value"}, rows));
}

}  // namespace

Rgb8Image DrawTexels(const TexelRows& rows, const std::vector<float>& values,
                     double high, int max_side) {
  PreviewPanel panel;
  panel.image = PictureOf(rows, values, 1);
  panel.kind = PreviewPanel::Kind::kSignedResidual;
  panel.mask = rows.Covered();
  panel.range = high;
  return DrawPanel(panel, max_side).pixels;
}

StatusOr<std::string> UncertaintyPage(const Problem& problem,
                                      const UncertaintyResult& result,
                                      const TexelRows& texture,
                                      const std::vector<TexelRows>& views) {
  const std::string name =
      std::filesystem::path(problem.path).filename().string();
  std::string body =
      HtmlElement("h1", name) + "\n" +
      HtmlElement("p",
                  "What " + std::to_string(result.inputs.views.size()) +
                      " views under known light leave unknown. Nothing was "
                      "solved.",
                  "class=\"summary\"") +
      "\n" + WarningSection(result.inputs.warnings);
  std::vector<ReportGroup> groups = {EntropyGroup(result.texels, texture),
                                     ParameterGroup(result.texels, texture)};
  if (!views.empty()) groups.push_back(ViewGroup(result, views));
  for (const ReportGroup& group : groups) {
    const StatusOr<std::string> section = GroupSection(group);
    if (!section.ok()) return section.status();
    body += *section;
  }
  if (result.next) body += NextSection(*result.next);
  body += NumbersSection(result) + ViewTable(result) + SettingSection(problem);
  return HtmlPage(name, body + ReportFooter());
}

}  // namespace ibrdf
