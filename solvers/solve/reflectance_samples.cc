#include "ibrdf/solvers/solve/reflectance_samples.h"

#include <glog/logging.h>

#include <Eigen/Dense>

#include "ibrdf/base/eigen_vectors.h"
#include "ibrdf/base/normal_source.h"

namespace ibrdf {

std::vector<std::vector<double>> SampleReflectances(
    const LobeModel& lobes, const std::vector<double>& parameters,
    const std::vector<double>& covariance, int count, uint64_t seed) {
  const auto n = static_cast<Eigen::Index>(parameters.size());
  CHECK_EQ(parameters.size() * parameters.size(), covariance.size());
  CHECK_GT(count, 0);
  const Eigen::Map<const Eigen::MatrixXd> matrix(covariance.data(), n, n);
  if (!matrix.allFinite()) return {};
  const Eigen::SelfAdjointEigenSolver<Eigen::MatrixXd> solver(matrix);
  if (solver.info() != Eigen::Success) return {};
  const Eigen::VectorXd deviations =
      solver.eigenvalues().cwiseMax(0.0).cwiseSqrt();
  NormalSource normal(seed);
  std::vector<std::vector<double>> out;
  for (int k = 0; k < count; ++k) {
    Eigen::VectorXd z(n);
    for (Eigen::Index i = 0; i < n; ++i) z[i] = normal.Next();
    Eigen::VectorXd sample = ToEigen(parameters) +
                             solver.eigenvectors() * deviations.cwiseProduct(z);
    lobes.Mixture(sample.data()).ClampCodes();
    out.push_back(ToVector(sample));
  }
  return out;
}

}  // namespace ibrdf
