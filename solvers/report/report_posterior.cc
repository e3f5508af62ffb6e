#include "ibrdf/solvers/report/report_posterior.h"

#include <cmath>
#include <limits>
#include <vector>

#include "ibrdf/base/format.h"
#include "ibrdf/solvers/report/html.h"
#include "ibrdf/solvers/report/lobe_summary.h"
#include "ibrdf/solvers/report/posterior_plots.h"
#include "ibrdf/solvers/report/readable_numbers.h"
#include "ibrdf/solvers/report/result_metrics.h"
#include "ibrdf/solvers/solve/reflectance_spread.h"

namespace ibrdf {
namespace {

constexpr double kNan = std::numeric_limits<double>::quiet_NaN();

// A lobe's colour with one standard deviation of its logarithm. A colour that
// could be five times as much is none.
std::string ColourInWords(double colour, double log_std) {
  if (!std::isfinite(log_std)) return RoundNumber(colour);
  if (std::fabs(log_std) > kLargestKnownError) return "not determined";
  return RoundNumber(colour) + ", within " + ErrorInWords(log_std);
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
    const bool lambertian = lobes[k].code.empty();
    std::vector<std::string> row = {
        lambertian ? "Lambertian" : "lobe\xC2\xA0" + std::to_string(k + 1)};
    for (size_t c = 0; c < 3; ++c) {
      row.push_back(ColourInWords(lobes[k].colour[c],
                                  deviation ? deviation->log_colour[c] : kNan));
    }
    row.push_back(lambertian ? "-" : ShortNumber(Norm(lobes[k].code)));
    row.push_back(deviation && !lambertian
                      ? ShortNumber(Norm(deviation->code) /
                                    std::sqrt(double(deviation->code.size())))
                      : "-");
    rows.push_back(row);
  }
  return HtmlTable({"", "red", "green", "blue", "norm of the code",
                    "standard deviation of its entries"},
                   rows);
}

std::string LobesInWords(const std::vector<LobeSummary>& lobes) {
  if (lobes.empty()) return "";
  return HtmlElement(
             "p", std::string("The estimate is a sum of lobes (brdf.json): ") +
                      kLobeFormula +
                      ". A code is a place among the training materials, whose "
                      "codes have norms of at most 1. " +
                      (lobes.back().code.empty()
                           ? "The Lambertian lobe has no code, and its density "
                             "is 1. "
                           : "") +
                      "Colours are in raw MERL units.") +
         "\n" + LobeTable(lobes) +
         HtmlElement(
             "p",
             lobes[0].deviation
                 ? "Each colour is given with one standard deviation of its "
                   "logarithm. The last column is the root mean square of the "
                   "standard deviations of a code's entries. Both come from "
                   "Laplace's approximation at this optimum; an unknown light "
                   "is "
                   "integrated out. Correlations are in result.json "
                   "(posterior.covariance). The approximation does not see "
                   "other local optima."
                 : "No covariance was computed for this problem: how well "
                   "these numbers are known is not stated.") +
         "\n";
}

// "The image determines n of m directions", and how far.
std::string DeterminedInWords(const Solution& solution) {
  if (!solution.determined) return "";
  const DeterminedDirections& found = *solution.determined;
  return HtmlElement(
             "p",
             "The image determines " + std::to_string(found.num_determined()) +
                 " of " + std::to_string(found.variance_left.size()) +
                 " directions of codes and colours: along these less than a "
                 "tenth of the prior's variance is left. Together it holds " +
                 Format("%.1f", found.degrees_of_freedom()) +
                 " degrees of freedom. The rest is what the prior says "
                 "(posterior.directions in result.json).") +
         "\n";
}

std::string ExpectedErrorInWords(const Solution& solution, bool light_unknown) {
  const double spread = solution.spread;
  if (!std::isfinite(spread)) return "";
  const ErrorToExpect error = ExpectError(solution, light_unknown);
  return HtmlElement(
             "p",
             "How far off to expect it: reflectances sampled from this "
             "posterior differ from the estimate by " +
                 Format("%.2g", spread) +
                 " in the logarithm (root mean square over all angles" +
                 (light_unknown ? ", after the best scale)"
                                : "; the median of samples)") +
                 ". Of images whose truth is known, half were off by more "
                 "than " +
                 Format("%.2g", error.median) + " at such a spread" +
                 (std::isfinite(solution.structured_misfit)
                      ? " and such residuals"
                      : "") +
                 " (" + ErrorInWords(error.median) +
                 "), one in ten by more than " + Format("%.2g", error.most) +
                 " (" + ErrorInWords(error.most) + ").") +
         "\n";
}

// What is smaller than `least` is not told apart from it.
std::string AtLeast(double least, double value) {
  if (!std::isfinite(value)) return "-";
  return value >= 0.0 && value < least ? "below " + ShortNumber(least)
                                       : Format("%.2g", value);
}

// The models that were searched, and what the estimate is the mean of.
std::string ModelsInWords(const Solution& solution, bool light_unknown) {
  // An initial guess is of no search.
  if (solution.models.empty() ||
      solution.status.code() == StatusCode::kNoImprovement) {
    return "";
  }
  // Under a known light a model has one optimum.
  if (!light_unknown && solution.models.size() == 1) {
    return HtmlElement("p", "The model " + solution.models.front().name +
                                " alone was searched.") +
           "\n";
  }
  std::string text = std::string("The estimate is the mean of the ") +
                     (light_unknown ? "local" : "models'") +
                     " optima, by evidence: those that explain the image as "
                     "well count alike.";
  for (size_t m = 0; solution.models.size() > 1 && m < solution.models.size();
       ++m) {
    text += (m == 0 ? " The model " : ", the model ") +
            solution.models[m].name + " has " +
            Format("%.0f", 100.0 * solution.model_weights[m]) + " %";
  }
  return HtmlElement("p",
                     text + (solution.models.size() > 1 ? " of it." : "")) +
         "\n";
}

std::string AlternativesInWords(const std::vector<Alternative>& alternatives,
                                bool light_unknown) {
  if (alternatives.empty()) {
    // Under a known light some were followed and are not kept.
    if (!light_unknown) return "";
    return HtmlElement("p", "No other candidates were followed.") + "\n";
  }
  std::vector<std::vector<std::string>> rows;
  for (const Alternative& other : alternatives) {
    rows.push_back({other.start, AtLeast(0.1, other.cost),
                    AtLeast(1e-3, std::exp(-other.cost)),
                    AtLeast(1e-3, other.brdf_log_difference)});
  }
  return HtmlElement("h3", "Other explanations") + "\n" +
         HtmlTable({"initial guess", "cost above the best (nats)",
                    "relative evidence", "BRDF log-RMSE from the estimate"},
                   rows) +
         HtmlElement(
             "p",
             "Each row is a local optimum, named after the training material "
             "that the search began with. The relative evidence is exp(-cost "
             "above the best): how probable the optimum is compared with the "
             "best one, given the image. The BRDF log-RMSE is taken after the "
             "best scale. An evidence near 1 with a large difference is an "
             "ambiguity that this image leaves open. Candidates that ranked "
             "lower were not followed.") +
         "\n";
}

std::string SlicesInWords(const std::vector<BrdfSlice>& slices,
                          bool light_unknown) {
  if (slices.empty()) return "";
  return HtmlElement("h3", "Slices of the BRDF") + "\n" +
         HtmlElement(
             "p",
             std::string("Lines are the estimate. Nine tenths of the "
                         "reflectances that are sampled from the posterior at "
                         "this optimum lie in the band, at each angle by "
                         "itself") +
                 (light_unknown
                      ? ", each after the scale by channel that brings it "
                        "nearest to the estimate: under an unknown light no "
                        "image tells the level, and the band is of the shape. "
                      : ". ") +
                 "What lobes cannot render is not in it. The numbers are in "
                 "result.json (posterior.slices).") +
         "\n" + HtmlPlots(SlicePlots(slices));
}

}  // namespace

std::string PosteriorSection(const InverseProblem& inverse,
                             const Solution& solution) {
  if (solution.brdf.raw.empty()) return "";
  const bool light_unknown = !inverse.known_map.has_value();
  return "<section>\n" +
         HtmlElement("h2", "How well the reflectance is known") + "\n" +
         LobesInWords(SummariseLobes(inverse, solution)) +
         DeterminedInWords(solution) +
         ExpectedErrorInWords(solution, light_unknown) +
         SlicesInWords(solution.slices, light_unknown) +
         ModelsInWords(solution, light_unknown) +
         AlternativesInWords(solution.alternatives, light_unknown) +
         "</section>\n";
}

std::string LightPosteriorSection(const Solution& solution) {
  if (solution.map_variance_left.empty() ||
      solution.map_variance_left_by_degree.empty()) {
    return "";
  }
  const DeterminedLight light = MeasureDetermined(solution.map_variance_left);
  return "<section>\n" + HtmlElement("h2", "How well the light is known") +
         "\n" +
         HtmlElement(
             "p",
             "Given the reflectance, less than a tenth of the prior's variance "
             "of log radiance is left over " +
                 Format("%.0f", 100.0 * light.share) +
                 " % of the sphere (illumination_variance_left.exr). The plot "
                 "has the same by degree l of spherical harmonics, that is, by "
                 "size: degree l tells places about 180 / l degrees apart. "
                 "What is not determined is what the prior says "
                 "(posterior.light in result.json).") +
         "\n" + HtmlPlots({DegreePlot(solution.map_variance_left_by_degree)}) +
         "</section>\n";
}

}  // namespace ibrdf
