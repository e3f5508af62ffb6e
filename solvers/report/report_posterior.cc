#include "ibrdf/solvers/report/report_posterior.h"

#include <cmath>
#include <vector>

#include "ibrdf/solvers/report/html.h"
#include "ibrdf/solvers/report/lobe_summary.h"
#include "ibrdf/solvers/report/readable_numbers.h"
#include "ibrdf/solvers/solve/reflectance_spread.h"

namespace ibrdf {
namespace {

// A standard deviation of a logarithm in words.
std::string Uncertainty(double log_std) {
  if (!std::isfinite(log_std)) return "";
  if (log_std < 0.4) return " \xC2\xB1 " + ShortNumber(100 * log_std) + " %";
  return " within a factor of " + ShortNumber(std::exp(log_std));
}

double Norm(const std::vector<double>& v) {
  double sum = 0.0;
  for (const double x : v) sum += x * x;
  return std::sqrt(sum);
}

std::string LobeTable(const std::vector<LobeSummary>& lobes) {
  std::vector<std::vector<std::string>> rows;
  for (size_t k = 0; k < lobes.size(); ++k) {
    const auto& deviation = lobes[k].deviation;
    std::vector<std::string> row = {"lobe " + std::to_string(k + 1)};
    for (size_t c = 0; c < 3; ++c) {
      row.push_back(ShortNumber(lobes[k].colour[c]) +
                    (deviation ? Uncertainty(deviation->log_colour[c]) : ""));
    }
    row.push_back(ShortNumber(Norm(lobes[k].code)));
    row.push_back(deviation
                      ? ShortNumber(Norm(deviation->code) /
                                    std::sqrt(double(deviation->code.size())))
                      : "-");
    rows.push_back(row);
  }
  return HtmlTable({"", "red", "green", "blue", "length of the code",
                    "deviation of a code's entry"},
                   rows);
}

std::string LobesInWords(const std::vector<LobeSummary>& lobes) {
  if (lobes.empty()) return "";
  return HtmlElement("p", std::string("The estimate (brdf.json): ") +
                              kLobeFormula + ".") +
         "\n" + LobeTable(lobes) +
         HtmlElement(
             "p",
             lobes[0].deviation
                 ? "Colours are in raw MERL units. Each number has one "
                   "standard "
                   "deviation, by Laplace's approximation at this optimum with "
                   "the light integrated out; entries of codes lie within the "
                   "unit ball. Correlations are in result.json "
                   "(posterior.covariance). What the approximation cannot see "
                   "are other optima:"
                 : "Colours are in raw MERL units. No covariance was computed "
                   "for this problem: how well these numbers are known is not "
                   "stated.") +
         "\n";
}

std::string ExpectedErrorInWords(double spread) {
  if (!std::isfinite(spread)) return "";
  const ErrorToExpect error = ExpectError(spread);
  return HtmlElement(
             "p",
             "How far off to expect it: reflectances drawn from this posterior "
             "differ from the estimate by " +
                 ShortNumber(spread) +
                 " in the logarithm (root mean square over all angles, "
                 "aligned). Such posteriors are too sure: of images whose "
                 "truth is known half were off by more than " +
                 ShortNumber(error.median) + " at such a spread (a factor of " +
                 ShortNumber(std::exp(error.median)) +
                 "), one in ten by more "
                 "than " +
                 ShortNumber(error.most) + ".") +
         "\n";
}

std::string AlternativesInWords(const std::vector<Alternative>& alternatives) {
  if (alternatives.empty()) {
    return HtmlElement("p", "No other starts were followed.") + "\n";
  }
  std::vector<std::vector<std::string>> rows;
  for (const Alternative& other : alternatives) {
    rows.push_back({other.start, ShortNumber(other.cost),
                    ShortNumber(std::exp(-other.cost)),
                    ShortNumber(other.brdf_log_difference)});
  }
  return HtmlElement("h3", "Other explanations") + "\n" +
         HtmlTable(
             {"started from", "cost above the best (nats)", "relative evidence",
              "BRDF log-RMSE from the estimate, aligned"},
             rows) +
         HtmlElement(
             "p",
             "Where the search ended from its best starts. The relative "
             "evidence is exp(-cost above the best): how probable that end "
             "is compared with the best, given the image. One close to 1 "
             "with a large difference is an ambiguity that this image leaves "
             "open; materials that were ranked lower at the start were not "
             "followed.") +
         "\n";
}

}  // namespace

std::string PosteriorSection(const InverseProblem& inverse,
                             const Solution& solution) {
  if (solution.brdf.raw.empty()) return "";
  return "<section>\n" +
         HtmlElement("h2", "How well the reflectance is known") + "\n" +
         LobesInWords(SummariseLobes(inverse, solution)) +
         ExpectedErrorInWords(solution.spread) +
         AlternativesInWords(solution.alternatives) + "</section>\n";
}

}  // namespace ibrdf
