#include "ibrdf/solvers/priors/determined_directions.h"

#include <Eigen/Dense>
#include <algorithm>
#include <cmath>
#include <limits>

namespace ibrdf {

int DeterminedDirections::num_determined() const {
  return static_cast<int>(
      std::count_if(variance_left.begin(), variance_left.end(),
                    [](double left) { return left < kDetermined; }));
}

double DeterminedDirections::degrees_of_freedom() const {
  double sum = 0.0;
  for (const double left : variance_left) sum += 1.0 - left;
  return sum;
}

double DeterminedDirections::information() const {
  double sum = 0.0;
  for (const double left : variance_left) {
    sum -= 0.5 * std::log(std::max(left, std::numeric_limits<double>::min()));
  }
  return sum;
}

std::optional<DeterminedDirections> FindDeterminedDirections(
    const MaterialPrior& prior, const std::vector<double>& covariance) {
  const auto n = static_cast<Eigen::Index>(prior.num_parameters());
  if (n == 0 || static_cast<Eigen::Index>(covariance.size()) != n * n) {
    return std::nullopt;
  }
  const Eigen::Map<const Eigen::MatrixXd> posterior(covariance.data(), n, n);
  const auto lower = prior.factor.triangularView<Eigen::Lower>();
  const Eigen::MatrixXd half = lower.solve(posterior);
  const Eigen::MatrixXd whitened = lower.solve(half.transpose());
  if (!whitened.allFinite()) return std::nullopt;
  const Eigen::SelfAdjointEigenSolver<Eigen::MatrixXd> solver(
      0.5 * (whitened + whitened.transpose()), Eigen::EigenvaluesOnly);
  DeterminedDirections out;
  for (Eigen::Index i = 0; i < n; ++i) {
    out.variance_left.push_back(std::clamp(solver.eigenvalues()[i], 0.0, 1.0));
  }
  return out;
}

}  // namespace ibrdf
