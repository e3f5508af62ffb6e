#include "ibrdf/solvers/estimation/map_evidence.h"

#include <algorithm>
#include <cmath>
#include <limits>
#include <vector>

#include "ibrdf/solvers/optim/lanczos_quadrature.h"

namespace ibrdf {
namespace {

constexpr int kLanczosSteps = 60;
constexpr uint64_t kProbeSeed = 7;
// b is sought up to these multiples of the mean residual, s up to these, in
// steps of a twentieth.
constexpr double kLeastScale = 0.5, kMostScale = 6.0;
constexpr double kLeastPrior = 0.2, kMostPrior = 2.0;
constexpr double kStep = 1.05;
// A map that leaves nothing has no scale.
constexpr double kLeastResidual = 1e-6;

// 1 / (L_o + epsilon) of the values that the image bounds from both sides, else
// 0: the derivative of their log.
std::vector<double> LogSlopes(const std::vector<double>& L_o,
                              const Observations& observed, double epsilon) {
  std::vector<double> slopes(L_o.size(), 0.0);
  for (size_t i = 0; i < L_o.size(); ++i) {
    if (!observed.valid[i / 3] || observed.Interval(i).IsOneSided()) continue;
    slopes[i] = 1.0 / (std::max(L_o[i], 0.0) + epsilon);
  }
  return slopes;
}

// What the cost is made of.
struct Terms {
  double values = 0.0;    // N
  double residual = 0.0;  // mean |r|
  double prior = 0.0;     // |z|^2 / 2
  // The spectrum of S^T J^T J S, in units of the mean residual.
  std::vector<SpectralNode> information;

  double Cost(double scale, double prior_scale) const {
    const double gain = prior_scale * residual / scale;
    double log_determinant = 0.0;
    for (const SpectralNode& node : information) {
      log_determinant +=
          node.weight *
          std::log1p(gain * gain * std::max(node.eigenvalue, 0.0));
    }
    return values * (residual / scale + std::log(2.0 * scale)) +
           prior / (prior_scale * prior_scale) + 0.5 * log_determinant;
  }
};

Terms TermsOf(const SolveSetup& setup, const Estimate& estimate) {
  const Iterate& iterate = estimate.iterate;
  const PosteriorObjective on =
      ObjectiveOn(estimate.pixels.get(), setup, iterate.light,
                  iterate.light.priors, iterate.scale);
  JointObjective* const objective = on.objective.get();
  if (setup.lobes_unknown()) objective->Free(JointBlocks::kLight);
  const JointCost cost = objective->Linearise(iterate.state);
  Terms terms;
  terms.residual = std::max(cost.misfit, kLeastResidual);
  terms.prior = cost.illumination_prior;
  const std::vector<double> slopes = LogSlopes(
      objective->radiance(), estimate.pixels->observed(), setup.epsilon);
  terms.values = static_cast<double>(
      slopes.size() - std::count(slopes.begin(), slopes.end(), 0.0));
  const Eigen::Map<const Eigen::ArrayXd> slope(
      slopes.data(), static_cast<Eigen::Index>(slopes.size()));
  terms.information = LanczosQuadrature(
      [&](const Eigen::VectorXd& v) -> Eigen::VectorXd {
        const Eigen::ArrayXd of_log =
            objective->RadianceJvp(v).array() * slope / terms.residual;
        return objective->RadianceVjp(
            (of_log * slope / terms.residual).matrix());
      },
      objective->size(), kProbesOfEvidence, kLanczosSteps, kProbeSeed);
  return terms;
}

}  // namespace

MapEvidence EvidenceOfMap(const SolveSetup& setup, const Estimate& estimate) {
  const Terms terms = TermsOf(setup, estimate);
  MapEvidence best;
  best.misfit = terms.residual;
  best.cost = std::numeric_limits<double>::infinity();
  for (double s = kLeastPrior; s <= kMostPrior; s *= kStep) {
    for (double f = kLeastScale; f <= kMostScale; f *= kStep) {
      const double scale = f * terms.residual;
      const double cost = terms.Cost(scale, s);
      if (!(cost < best.cost)) continue;
      best.cost = cost;
      best.scale = scale;
      best.prior_scale = s;
    }
  }
  return best;
}

}  // namespace ibrdf
