#include "ibrdf/solvers/report/report_posterior.h"

#include <cmath>
#include <vector>

#include "ibrdf/solvers/report/html.h"
#include "ibrdf/solvers/report/json_values.h"

namespace ibrdf {
namespace {
using Json = nlohmann::ordered_json;

// A standard deviation of a logarithm in words.
std::string Uncertainty(double log_std) {
  if (!std::isfinite(log_std)) return "";
  if (log_std < 0.4) return " \xC2\xB1 " + ShortNumber(100 * log_std) + " %";
  return " within a factor of " + ShortNumber(std::exp(log_std));
}

std::vector<double> Numbers(const Json& list) {
  std::vector<double> out;
  if (!list.is_array()) return out;
  for (const Json& value : list) out.push_back(ToNumber(value));
  return out;
}

double Norm(const std::vector<double>& v) {
  double sum = 0.0;
  for (const double x : v) sum += x * x;
  return std::sqrt(sum);
}

std::string LobeTable(const Json& lobes, const Json& deviations) {
  std::vector<std::vector<std::string>> rows;
  for (size_t k = 0; k < lobes.size(); ++k) {
    const Json deviation =
        deviations.is_array() && k < deviations.size() ? deviations[k] : Json();
    const std::vector<double> colour =
        Numbers(MemberAt(lobes[k], "colour_raw_merl"));
    const std::vector<double> colour_std =
        Numbers(MemberAt(deviation, "log_colour_std"));
    const std::vector<double> code = Numbers(MemberAt(lobes[k], "code"));
    const std::vector<double> code_std =
        Numbers(MemberAt(deviation, "code_std"));
    std::vector<std::string> row = {"lobe " + std::to_string(k + 1)};
    for (size_t c = 0; c < 3; ++c) {
      row.push_back(
          c < colour.size()
              ? ShortNumber(colour[c]) +
                    (c < colour_std.size() ? Uncertainty(colour_std[c]) : "")
              : "-");
    }
    row.push_back(ShortNumber(Norm(code)));
    row.push_back(
        code_std.empty()
            ? "-"
            : ShortNumber(Norm(code_std) / std::sqrt(double(code_std.size()))));
    rows.push_back(row);
  }
  return HtmlTable({"", "red", "green", "blue", "length of the code",
                    "deviation of a code's entry"},
                   rows);
}

std::string AlternativeTable(const Json& alternatives) {
  std::vector<std::vector<std::string>> rows;
  for (const Json& other : alternatives) {
    const double cost = NumberAt(other, "cost_above_best");
    rows.push_back({TextAt(other, "start"), ShortNumber(cost),
                    ShortNumber(std::exp(-cost)),
                    ShortNumber(NumberAt(other, "brdf_log_difference"))});
  }
  return HtmlTable(
      {"started from", "cost above the best (nats)", "relative evidence",
       "BRDF log-RMSE from the estimate, aligned"},
      rows);
}

// Where it is stated.
std::string ExpectedErrorWords(const Json& posterior) {
  const double expected = NumberAt(posterior, "brdf_log_rmse_expected");
  if (!std::isfinite(expected)) return "";
  const double most = NumberAt(posterior, "brdf_log_rmse_90");
  return HtmlElement(
             "p",
             "How far off to expect it: reflectances drawn from this posterior "
             "differ from the estimate by " +
                 ShortNumber(NumberAt(posterior, "brdf_spread")) +
                 " in the logarithm (root mean square over all angles, "
                 "aligned). Such posteriors are too sure: of images whose "
                 "truth is known half were off by more than " +
                 ShortNumber(expected) + " at such a spread (a factor of " +
                 ShortNumber(std::exp(expected)) +
                 "), one in ten by more "
                 "than " +
                 ShortNumber(most) + ".") +
         "\n";
}

}  // namespace

std::string PosteriorSection(const Json& posterior, const Json& brdf) {
  if (brdf.is_null()) return "";
  std::string out = "<section>\n" +
                    HtmlElement("h2", "How well the reflectance is known") +
                    "\n";
  const Json lobes = MemberAt(brdf, "lobes");
  const Json deviations = MemberAt(posterior, "lobes");
  if (lobes.is_array() && !lobes.empty()) {
    out +=
        HtmlElement(
            "p", "The estimate (brdf.json): " + TextAt(brdf, "formula") + ".") +
        "\n";
    out += LobeTable(lobes, deviations);
    out += HtmlElement(
        "p",
        deviations.is_array()
            ? "Colours are in raw MERL units. Each number has one standard "
              "deviation, by Laplace's approximation at this optimum with the "
              "light integrated out; entries of codes lie within the unit "
              "ball. Correlations are in result.json (posterior.covariance). "
              "What the approximation cannot see are other optima:"
            : "Colours are in raw MERL units. No covariance was computed for "
              "this problem: how well these numbers are known is not stated.");
    out += "\n";
  }
  out += ExpectedErrorWords(posterior);
  const Json alternatives = MemberAt(posterior, "alternatives");
  if (alternatives.is_array() && !alternatives.empty()) {
    out += HtmlElement("h3", "Other explanations") + "\n" +
           AlternativeTable(alternatives) +
           HtmlElement(
               "p",
               "Where the search ended from its best starts. The relative "
               "evidence is exp(-cost above the best): how probable that end "
               "is compared with the best, given the image. One close to 1 "
               "with a large difference is an ambiguity that this image leaves "
               "open; materials that were ranked lower at the start were not "
               "followed.") +
           "\n";
  } else {
    out += HtmlElement("p", "No other starts were followed.") + "\n";
  }
  return out + "</section>\n";
}

}  // namespace ibrdf
