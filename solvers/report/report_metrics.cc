#include "ibrdf/solvers/report/report_metrics.h"

#include <algorithm>
#include <set>
#include <vector>

#include "ibrdf/solvers/report/html.h"
#include "ibrdf/solvers/report/json_values.h"

namespace ibrdf {
namespace {
using Json = nlohmann::ordered_json;

struct MetricRow {
  const char* name;
  const char* key;
  const char* aligned;  // key after the best scale; null: there is none
  const char* meaning;
};

constexpr MetricRow kTruthRows[] = {
    {"BRDF log-RMSE", "brdf_log_rmse", "brdf_log_rmse_aligned",
     "Root mean square difference of natural logarithms over the valid bins of "
     "the MERL table: 0.1 is about 10 %, 0.7 a factor of two."},
    {"BRDF log-RMSE below 80 degrees", "brdf_log_rmse_below80", nullptr,
     "The same where both directions lie within 80 degrees of the normal: "
     "grazing bins dominate the whole table and hardly show in an image."},
    {"Illumination relative log-RMSE", "illumination_relative_log_rmse",
     "illumination_relative_log_rmse_aligned",
     "Root mean square difference of log radiance over the sphere, as a share "
     "of the truth's range from darkest to brightest."},
    {"The same, unweighted", "illumination_relative_log_rmse_unweighted",
     nullptr, "Every texel counts alike, those at the poles too."},
};

constexpr MetricRow kImageRows[] = {
    {"Misfit", "misfit", nullptr,
     "Mean |log E - log I| of render and image, natural: 0.02 is 2 %. It ends "
     "at the noise, or at what the lobes cannot render."},
    {"Image log-RMSE", "image_log_rmse", nullptr,
     "Root mean square of the same difference."},
    {"PSNR (dB)", "psnr", nullptr,
     "Peak signal to noise ratio after the best scale: bright pixels count "
     "most."},
    {"DSSIM", "dssim", nullptr,
     "(1 - SSIM) / 2 of log(1 + radiance): 0 is the same structure."},
    {"Time (s)", "seconds", nullptr, "Of the solver, without files."},
};

template <size_t N>
std::vector<std::vector<std::string>> Rows(const MetricRow (&rows)[N],
                                           const Json& metrics, bool aligned,
                                           std::set<std::string>* shown) {
  std::vector<std::vector<std::string>> out;
  for (const MetricRow& row : rows) {
    shown->insert(row.key);
    if (row.aligned != nullptr) shown->insert(row.aligned);
    if (MemberAt(metrics, row.key).is_null() &&
        (row.aligned == nullptr || MemberAt(metrics, row.aligned).is_null())) {
      continue;
    }
    std::vector<std::string> cells = {row.name,
                                      ShortNumber(NumberAt(metrics, row.key))};
    if (aligned) {
      cells.push_back(row.aligned == nullptr
                          ? ""
                          : ShortNumber(NumberAt(metrics, row.aligned)));
    }
    cells.push_back(row.meaning);
    out.push_back(cells);
  }
  return out;
}

}  // namespace

std::string MetricsSection(const Json& metrics, const Json& problem) {
  std::set<std::string> shown;
  std::string out = "<section>\n" + HtmlElement("h2", "Metrics") + "\n";
  const auto truth = Rows(kTruthRows, metrics, true, &shown);
  if (truth.empty()) {
    out += HtmlElement("p",
                       "No truth was given: nothing here says how near the "
                       "estimate is to it. A low misfit alone does not.");
  } else {
    out += HtmlElement("h3", "Against the truth") + "\n" +
           HtmlTable({"metric", "as is", "after the best scale", "meaning"},
                     truth);
    const bool joint = TextAt(problem, "problem") == "joint";
    if (joint) {
      out += HtmlElement(
          "p",
          "The best scale is one factor per channel. An image cannot tell a "
          "bright object in dim light from a dark one in bright light, so that "
          "the first number holds the luck of that choice, too; the second "
          "leaves it out, and with it the overall colour.");
    }
  }
  out += "\n" + HtmlElement("h3", "Against the image") + "\n";
  auto image = Rows(kImageRows, metrics, false, &shown);
  if (metrics.is_object()) {
    for (const auto& [key, value] : metrics.items()) {
      if (shown.count(key) > 0 || !value.is_number()) continue;
      image.push_back({key, ShortNumber(ToNumber(value)), ""});
    }
  }
  return out + HtmlTable({"metric", "value", "meaning"}, image) +
         "</section>\n";
}

}  // namespace ibrdf
