#include "ibrdf/solvers/report/lobe_summary.h"

#include <cmath>

namespace ibrdf {

std::vector<LobeSummary> SummariseLobes(const InverseProblem& inverse,
                                        const Solution& solution) {
  const std::vector<double>& parameters = solution.lobe_parameters;
  const std::vector<double>& covariance = solution.lobe_covariance;
  const auto codes = static_cast<size_t>(inverse.model.shape.code_size());
  const size_t size = codes + 3, n = parameters.size();
  std::vector<LobeSummary> lobes;
  for (size_t first = 0; first + size <= n; first += size) {
    LobeSummary lobe;
    const double* const p = parameters.data() + first;
    lobe.code.assign(p, p + codes);
    for (size_t c = 0; c < 3; ++c) lobe.colour[c] = std::exp(p[codes + c]);
    if (!covariance.empty()) {
      const auto deviation = [&](size_t i) {
        return std::sqrt(covariance[(first + i) * n + first + i]);
      };
      lobe.deviation.emplace();
      for (size_t i = 0; i < codes; ++i) {
        lobe.deviation->code.push_back(deviation(i));
      }
      for (size_t c = 0; c < 3; ++c) {
        lobe.deviation->log_colour[c] = deviation(codes + c);
      }
    }
    lobes.push_back(lobe);
  }
  return lobes;
}

}  // namespace ibrdf
