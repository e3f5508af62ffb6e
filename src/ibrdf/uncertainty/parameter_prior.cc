#include "ibrdf/uncertainty/parameter_prior.h"

#include <glog/logging.h>

#include <algorithm>
#include <cmath>

namespace ibrdf {
namespace {

size_t NearestValue(const std::vector<double>& values, double x) {
  size_t best = 0;
  for (size_t k = 1; k < values.size(); ++k) {
    if (std::abs(values[k] - x) < std::abs(values[best] - x)) best = k;
  }
  return best;
}

}  // namespace

Status CheckPrior(const std::vector<double>& prior, int num_cells) {
  if (prior.empty()) return OkStatus();
  if (prior.size() != static_cast<size_t>(num_cells)) {
    return InvalidInput("prior", "expected num_alpha num_ks numbers");
  }
  for (const double p : prior) {
    if (!(p > 0.0) || !std::isfinite(p)) {
      return InvalidInput("prior", "expected finite numbers > 0");
    }
  }
  return OkStatus();
}

std::vector<double> PriorPenalty(const std::vector<double>& prior) {
  std::vector<double> out;
  if (prior.empty()) return out;
  const double most = *std::max_element(prior.begin(), prior.end());
  for (const double p : prior) out.push_back(std::log(most / p));
  return out;
}

std::vector<double> PriorOfMaterials(const std::vector<double>& alpha,
                                     const std::vector<double>& Ks,
                                     const std::vector<double>& alpha_values,
                                     const std::vector<double>& Ks_values,
                                     double floor) {
  CHECK_EQ(alpha.size(), Ks.size());
  CHECK_GT(floor, 0.0);
  std::vector<double> out(alpha_values.size() * Ks_values.size(), floor);
  for (size_t k = 0; k < alpha.size(); ++k) {
    out[NearestValue(alpha_values, alpha[k]) * Ks_values.size() +
        NearestValue(Ks_values, Ks[k])] += 1.0;
  }
  return out;
}

}  // namespace ibrdf
