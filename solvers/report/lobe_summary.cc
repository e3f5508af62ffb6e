#include "ibrdf/solvers/report/lobe_summary.h"

#include <cmath>

#include "ibrdf/base/eigen_vectors.h"
#include "ibrdf/brdf/lobe_mixture.h"

namespace ibrdf {

std::vector<LobeSummary> SummariseLobes(const InverseProblem& inverse,
                                        const Solution& solution) {
  const std::vector<double>& parameters = solution.lobe_parameters;
  const std::vector<double>& covariance = solution.lobe_covariance;
  if (parameters.empty()) return {};
  const LobeLayout layout =
      LobeLayout::OfSize(parameters.size(), inverse.model->shape.code_size());
  const size_t n = parameters.size();
  std::vector<double> deviations;
  for (size_t i = 0; i < n && !covariance.empty(); ++i) {
    deviations.push_back(std::sqrt(covariance[i * n + i]));
  }
  const LobeMixture mixture(layout, parameters.data());
  const LobeMixture of_deviations(layout, deviations.data());
  std::vector<LobeSummary> lobes(layout.num_lobes);
  for (int k = 0; k < layout.num_lobes; ++k) {
    LobeSummary& lobe = lobes[k];
    lobe.code = ToVector(mixture.code(k));
    // Not RawColours: the scale of solver.gauge is not clamped.
    for (int c = 0; c < 3; ++c) {
      lobe.colour[c] = std::exp(mixture.log_colour(k)[c]);
    }
    if (deviations.empty()) continue;
    lobe.deviation.emplace();
    lobe.deviation->code = ToVector(of_deviations.code(k));
    for (int c = 0; c < 3; ++c) {
      lobe.deviation->log_colour[c] = of_deviations.log_colour(k)[c];
    }
  }
  return lobes;
}

}  // namespace ibrdf
