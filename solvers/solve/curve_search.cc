#include "ibrdf/solvers/solve/curve_search.h"

#include <algorithm>
#include <cmath>
#include <iterator>
#include <limits>
#include <map>
#include <string>
#include <utility>
#include <vector>

#include "ibrdf/base/format.h"
#include "ibrdf/solvers/costs/laplace_interval.h"
#include "ibrdf/solvers/estimation/marginal_search.h"
#include "ibrdf/solvers/estimation/reflectance_given_light.h"
#include "ibrdf/solvers/estimation/solve_setup.h"
#include "ibrdf/solvers/solve/exposure.h"

namespace ibrdf {
namespace {

constexpr double kInfinity = std::numeric_limits<double>::infinity();
// Deviations of the prior that are searched, either way; where a family's line
// begins, the most probable first, and how often it is refined.
constexpr double kReach = 2.0;
constexpr double kStarts[] = {0.0, -1.0, 1.0};
constexpr int kRefinements = 3;
// A parameter is settled to this share of its prior's deviation: costs of two
// searches so near differ by some nats of chance.
constexpr double kSettled = 0.08;
// A share of the time that remains, at most.
constexpr double kTimeShare = 0.6;
// Under known light: outer iterations of a search, for one curve; scales of the
// noise in log radiance; radiance that counts as no less.
constexpr int kKnownLightIterations = 30;
constexpr double kLeastScale = 2e-3, kMostScale = 0.5;
constexpr int kScalePoints = 12, kScaleRefinements = 3;
constexpr double kSettledScale = 0.03;  // of its logarithm
constexpr double kDarkest = 1e-100;

// -log of the probability of the codes, their noise Laplacian in log radiance
// of scale b.
double CodesCost(const std::vector<double>& L_o, const Observations& observed,
                 double b) {
  double cost = 0.0;
  for (size_t i = 0; i < L_o.size(); ++i) {
    if (!observed.valid[i / 3]) continue;
    const RadianceInterval interval = observed.Interval(i);
    cost += LaplaceIntervalCost(std::log(interval.low), std::log(interval.high),
                                std::log(std::max(L_o[i], kDarkest)), b);
  }
  return cost;
}

// Under known light: the codes' cost at the most probable scale, which is not
// that of the robust likelihood, in which codes that hold cost nothing.
double KnownLightCost(const SolveSetup& setup, SolveContext* context) {
  const Estimate estimate = EstimateReflectanceGivenLight(setup, context);
  const Iterate& iterate = estimate.iterate;
  const PosteriorObjective on =
      ObjectiveOn(estimate.pixels.get(), setup, iterate.light,
                  iterate.light.priors, iterate.scale);
  const JointCost cost = on.objective->Evaluate(iterate.state);
  const TraceEntry end = MakeEntry("curve", setup, *context, 0, iterate.scale,
                                   iterate.state, cost);
  const LineMinimum codes = MinimiseOnLine(
      [&](double log_b) {
        return CodesCost(on.objective->radiance(), estimate.pixels->observed(),
                         std::exp(log_b));
      },
      {std::log(kLeastScale), std::log(kMostScale),
       EqualSteps(std::log(kLeastScale), std::log(kMostScale), kScalePoints),
       kScaleRefinements, kSettledScale});
  return codes.value + end.reflectance_prior;
}

double CostOf(const InverseProblem& problem, SolveContext* context) {
  InverseProblem scaled = InUnitsOf(ExposureOf(problem), problem);
  scaled.solver.max_iterations =
      std::min(scaled.solver.max_iterations, kKnownLightIterations);
  const StatusOr<SolveSetup> setup = SetUp(scaled);
  if (!setup.ok()) return kInfinity;
  if (setup->light_unknown()) return CoarseEvidence(*setup, context);
  scaled.seconds_spent = context->Elapsed();
  const SolveProgress none;
  SolveContext quiet(scaled, none, context->stop());
  return KnownLightCost(*setup, &quiet);
}

ResponseDefinition CurveAt(const CurveFamily& family, double deviations) {
  ResponseDefinition curve;
  curve.kind = family.kind;
  if (!family.has_parameter) return curve;
  const ResponseParameter range = *ParameterOf(family.kind);
  curve.parameter =
      std::clamp(std::exp(family.log_mean + deviations * family.log_std),
                 range.least, range.most);
  return curve;
}

// Deviations of the prior at which the parameter comes to an end of its range.
double DeviationsOf(const CurveFamily& family, double parameter) {
  return (std::log(parameter) - family.log_mean) / family.log_std;
}

CurveEstimate BestOfFamily(
    const CurveFamily& family,
    const std::function<double(const ResponseDefinition&)>& cost) {
  CurveEstimate best;
  if (!family.has_parameter) {
    best.curve = CurveAt(family, 0.0);
    best.cost = cost(best.curve);
    return best;
  }
  const ResponseParameter range = *ParameterOf(family.kind);
  LineSearch line;
  line.low = std::max(-kReach, DeviationsOf(family, range.least));
  line.high = std::min(kReach, DeviationsOf(family, range.most));
  for (const double u : kStarts) {
    line.starts.push_back(std::clamp(u, line.low, line.high));
  }
  line.refinements = kRefinements;
  line.settled = kSettled;
  const LineMinimum minimum = MinimiseOnLine(
      [&](double u) { return cost(CurveAt(family, u)) + 0.5 * u * u; }, line);
  best.curve = CurveAt(family, minimum.at);
  best.cost = minimum.value;
  if (minimum.curvature > 0.0) {
    best.log_parameter_std = family.log_std / std::sqrt(minimum.curvature);
    // Laplace: the evidence of the family, its parameter integrated out.
    best.cost += 0.5 * std::log(minimum.curvature);
  }
  return best;
}

std::string StageName(const ResponseDefinition& curve) {
  std::string name = "curve " + NameOf(curve.kind);
  if (curve.parameter) name += Format(" %.3g", *curve.parameter);
  return name;
}

// Through three points of increasing x.
struct Parabola {
  double vertex = 0.0, curvature = 0.0;
};
Parabola Through(const double* x, const double* f) {
  const double left = (f[1] - f[0]) / (x[1] - x[0]);
  const double right = (f[2] - f[1]) / (x[2] - x[1]);
  Parabola parabola;
  parabola.curvature = 2.0 * (right - left) / (x[2] - x[0]);
  parabola.vertex = 0.5 * (x[0] + x[1]) - left / parabola.curvature;
  return parabola;
}

}  // namespace

std::vector<double> EqualSteps(double low, double high, int count) {
  std::vector<double> steps;
  for (int k = 0; k < count; ++k) {
    steps.push_back(low + (high - low) * k / (count - 1));
  }
  return steps;
}

LineMinimum MinimiseOnLine(const std::function<double(double)>& f,
                           const LineSearch& line) {
  std::map<double, double> values;
  const auto add = [&](double x) {
    const double value = f(x);
    if (std::isfinite(value)) values[x] = value;
  };
  for (const double start : line.starts) {
    if (values.count(start) == 0) add(start);
  }
  LineMinimum minimum;
  minimum.value = kInfinity;
  for (int k = 0; k <= line.refinements && !values.empty(); ++k) {
    const auto best = std::min_element(
        values.begin(), values.end(),
        [](const auto& a, const auto& b) { return a.second < b.second; });
    minimum.at = best->first;
    minimum.value = best->second;
    minimum.curvature = 0.0;
    if (values.size() < 3) break;
    // At an end of the line, the three points there.
    auto middle = best;
    if (middle == values.begin()) ++middle;
    if (std::next(middle) == values.end()) --middle;
    const auto before = std::prev(middle), after = std::next(middle);
    const double x[3] = {before->first, middle->first, after->first};
    const double y[3] = {before->second, middle->second, after->second};
    const Parabola parabola = Through(x, y);
    double next = minimum.at;
    if (parabola.curvature > 0.0) {
      next = std::clamp(parabola.vertex, line.low, line.high);
      if (next == parabola.vertex) minimum.curvature = parabola.curvature;
    } else if (best == values.begin()) {
      next = line.low;
    } else if (std::next(best) == values.end()) {
      next = line.high;
    }
    const double move = std::abs(next - minimum.at);
    if (k == line.refinements || move <= line.settled) break;
    add(next);
  }
  return minimum;
}

InverseProblem WithCurve(const InverseProblem& problem,
                         const ResponseDefinition& curve) {
  InverseProblem out = problem;
  DecodedCodes decoded =
      DecodeCodes(ResponseCurve(curve), problem.unknown_curve->levels,
                  problem.unknown_curve->codes);
  out.image = std::move(decoded.radiance);
  out.bounds = std::move(decoded.bounds);
  return out;
}

StatusOr<std::vector<CurveEstimate>> FindCurves(const InverseProblem& problem,
                                                SolveContext* context) {
  const std::function<bool()> stop = context->StopAfter(kTimeShare);
  bool first = true;
  const auto cost = [&](const ResponseDefinition& curve) {
    if (!std::exchange(first, false) && stop()) return kInfinity;
    const double found = CostOf(WithCurve(problem, curve), context);
    context->Report(StageName(curve), 0, found, 0.0);
    return found;
  };
  std::vector<CurveEstimate> found;
  for (const CurveFamily& family : problem.unknown_curve->families) {
    CurveEstimate best = BestOfFamily(family, cost);
    if (std::isfinite(best.cost)) found.push_back(best);
  }
  if (found.empty()) {
    return Status(StatusCode::kNoImprovement,
                  "no response curve explains the image's codes");
  }
  std::stable_sort(found.begin(), found.end(),
                   [](const CurveEstimate& a, const CurveEstimate& b) {
                     return a.cost < b.cost;
                   });
  const double least = found.front().cost;
  for (CurveEstimate& estimate : found) estimate.cost -= least;
  return found;
}

}  // namespace ibrdf
