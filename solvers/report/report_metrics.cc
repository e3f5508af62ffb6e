#include "ibrdf/solvers/report/report_metrics.h"

#include <cmath>
#include <optional>
#include <vector>

#include "ibrdf/solvers/report/html.h"
#include "ibrdf/solvers/report/readable_numbers.h"

namespace ibrdf {
namespace {

struct MetricRow {
  const char* name;
  double value;
  std::optional<double> aligned;  // after the best scale; unset: there is none
  const char* meaning;

  bool IsKnown() const {
    return std::isfinite(value) ||
           (aligned.has_value() && std::isfinite(*aligned));
  }
};

std::vector<MetricRow> TruthRows(const ResultMetrics& metrics) {
  std::vector<MetricRow> rows;
  if (const auto& brdf = metrics.brdf) {
    rows.push_back(
        {"BRDF log-RMSE", brdf->log_rmse, brdf->log_rmse_aligned,
         "Root mean square difference of natural logarithms over the valid "
         "bins of the MERL table: 0.1 is about 10 %, 0.7 a factor of two."});
    rows.push_back(
        {"BRDF log-RMSE below 80 degrees", brdf->log_rmse_below80,
         brdf->log_rmse_aligned_below80,
         "The same over the bins whose two directions lie within 80 degrees of "
         "the normal. Grazing bins dominate the whole table and hardly show in "
         "an image."});
  }
  if (const auto& map = metrics.illumination) {
    rows.push_back(
        {"Illumination relative log-RMSE", map->relative_log_rmse,
         map->relative_log_rmse_aligned,
         "Root mean square difference of log radiance over the sphere, as a "
         "share of the range of the truth's log radiance."});
    rows.push_back({"The same, unweighted", map->relative_log_rmse_unweighted,
                    std::nullopt,
                    "Every texel counts alike, those at the poles too."});
  }
  return rows;
}

std::vector<MetricRow> ImageRows(const ResultMetrics& metrics) {
  std::vector<MetricRow> rows = {
      {"Misfit", metrics.misfit, std::nullopt,
       "Mean absolute log error, |log L_o - log I|, of the rendered radiance "
       "L_o against the image I: 0.02 is about 2 %. The least that can be "
       "reached is the noise, and what the model cannot render."}};
  if (const auto& image = metrics.image) {
    rows.push_back({"Image log-RMSE", image->log_rmse, std::nullopt,
                    "Root mean square of log L_o - log I."});
    rows.push_back({"PSNR (dB)", image->psnr, std::nullopt,
                    "Peak signal-to-noise ratio after the best scale. Bright "
                    "pixels count most."});
    rows.push_back(
        {"DSSIM", image->dssim, std::nullopt,
         "(1 - SSIM) / 2 of log(1 + radiance): 0 is the same structure."});
  }
  rows.push_back({"Time (s)", metrics.seconds, std::nullopt,
                  "Reading of the input and solving, without writing."});
  return rows;
}

using Cells = std::vector<std::vector<std::string>>;

Cells ToCells(const std::vector<MetricRow>& rows, bool with_aligned) {
  Cells out;
  for (const MetricRow& row : rows) {
    if (!row.IsKnown()) continue;
    std::vector<std::string> cells = {row.name, ShortNumber(row.value)};
    if (with_aligned) {
      cells.push_back(row.aligned.has_value() ? ShortNumber(*row.aligned) : "");
    }
    cells.push_back(row.meaning);
    out.push_back(cells);
  }
  return out;
}

std::string TruthTable(const ResultMetrics& metrics, ProblemKind kind) {
  const Cells cells = ToCells(TruthRows(metrics), true);
  if (cells.empty()) {
    return HtmlElement("p",
                       "No truth was given: nothing here says how near the "
                       "estimate is to it. A low misfit alone does not.");
  }
  const std::string out =
      HtmlElement("h3", "Against the truth") + "\n" +
      HtmlTable({"metric", "as is", "after the best scale", "meaning"}, cells);
  std::string note = "The best scale is one factor per channel.";
  if (kind == ProblemKind::kJoint) {
    note +=
        " An image cannot tell a bright object in dim light from a dark object "
        "in bright light. The first number holds the luck of that choice, too. "
        "The second leaves it out, and with it the overall colour.";
  }
  return out + HtmlElement("p", note);
}

}  // namespace

std::string MetricsSection(const ResultMetrics& metrics, ProblemKind kind) {
  return "<section>\n" + HtmlElement("h2", "Metrics") + "\n" +
         TruthTable(metrics, kind) + "\n" +
         HtmlElement("h3", "Against the image") + "\n" +
         HtmlTable({"metric", "value", "meaning"},
                   ToCells(ImageRows(metrics), false)) +
         "</section>\n";
}

}  // namespace ibrdf
