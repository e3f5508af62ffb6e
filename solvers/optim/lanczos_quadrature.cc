#include "ibrdf/solvers/optim/lanczos_quadrature.h"

#include <Eigen/Eigenvalues>
#include <algorithm>
#include <random>

namespace ibrdf {
namespace {

// A direction this short beside the product it is left of is rounding: the
// space of the probe is exhausted.
constexpr double kExhausted = 1e-10;

void AddProbe(
    const std::function<Eigen::VectorXd(const Eigen::VectorXd&)>& product,
    Eigen::VectorXd probe, int steps, double share,
    std::vector<SpectralNode>* nodes) {
  Eigen::MatrixXd basis(probe.size(), steps);
  basis.col(0) = probe.normalized();
  Eigen::VectorXd diagonal(steps), below(steps);
  int taken = 0;
  while (true) {
    Eigen::VectorXd next = product(basis.col(taken));
    const double length = next.norm();
    diagonal[taken] = next.dot(basis.col(taken));
    const auto so_far = basis.leftCols(taken + 1);
    // Twice, as once leaves what rounding left.
    for (int pass = 0; pass < 2; ++pass) {
      next -= so_far * (so_far.transpose() * next);
    }
    below[taken] = next.norm();
    ++taken;
    if (taken == steps || below[taken - 1] <= kExhausted * length) break;
    basis.col(taken) = next / below[taken - 1];
  }
  Eigen::SelfAdjointEigenSolver<Eigen::MatrixXd> eigen;
  eigen.computeFromTridiagonal(diagonal.head(taken), below.head(taken - 1));
  for (int i = 0; i < taken; ++i) {
    const double first = eigen.eigenvectors()(0, i);
    nodes->push_back({eigen.eigenvalues()[i], share * first * first});
  }
}

}  // namespace

std::vector<SpectralNode> LanczosQuadrature(
    const std::function<Eigen::VectorXd(const Eigen::VectorXd&)>& product,
    Eigen::Index size, int probes, int steps, uint64_t seed) {
  std::vector<SpectralNode> nodes;
  if (size == 0) return nodes;
  std::mt19937_64 rng(seed);
  steps = static_cast<int>(std::min<Eigen::Index>(steps, size));
  for (int k = 0; k < probes; ++k) {
    Eigen::VectorXd probe(size);
    for (double& v : probe) v = (rng() & 1) != 0 ? 1.0 : -1.0;
    AddProbe(product, std::move(probe), steps,
             static_cast<double>(size) / probes, &nodes);
  }
  return nodes;
}

}  // namespace ibrdf
