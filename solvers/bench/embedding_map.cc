#include "ibrdf/solvers/bench/embedding_map.h"

#include <glog/logging.h>

#include <Eigen/Eigenvalues>
#include <algorithm>
#include <cmath>

namespace ibrdf {

EmbeddingMap PrincipalAxes(const Eigen::MatrixXd& points) {
  CHECK_GE(points.rows(), 2);
  EmbeddingMap map;
  map.centred = points.rowwise() - points.colwise().mean();
  const Eigen::MatrixXd covariance = map.centred.transpose() * map.centred /
                                     static_cast<double>(points.rows());
  const Eigen::SelfAdjointEigenSolver<Eigen::MatrixXd> solver(covariance);
  map.axes = solver.eigenvectors().rowwise().reverse();
  map.variance = solver.eigenvalues().reverse().cwiseMax(0.0);
  const double total = map.variance.sum();
  if (total > 0.0) map.variance /= total;
  for (int k = 0; k < map.axes.cols(); ++k) {
    Eigen::Index at = 0;
    map.axes.col(k).cwiseAbs().maxCoeff(&at);
    if (map.axes(at, k) < 0.0) map.axes.col(k) *= -1.0;
  }
  map.scores = map.centred * map.axes;
  return map;
}

std::vector<std::vector<Neighbour>> NearestNeighbours(
    const Eigen::MatrixXd& points, int count) {
  const int n = static_cast<int>(points.rows());
  std::vector<std::vector<Neighbour>> result(n);
  for (int i = 0; i < n; ++i) {
    std::vector<Neighbour>& all = result[i];
    for (int j = 0; j < n; ++j) {
      if (j != i) all.push_back({j, (points.row(i) - points.row(j)).norm()});
    }
    std::stable_sort(all.begin(), all.end(),
                     [](const Neighbour& a, const Neighbour& b) {
                       return a.distance < b.distance;
                     });
    all.resize(std::min<size_t>(all.size(), count));
  }
  return result;
}

Eigen::MatrixXd SpreadApart(const Eigen::MatrixXd& places, double distance,
                            const Eigen::Array2d& low,
                            const Eigen::Array2d& high, int iterations) {
  Eigen::MatrixXd at = places;
  const int n = static_cast<int>(at.rows());
  for (int step = 0; step < iterations; ++step) {
    bool moved = false;
    for (int i = 0; i < n; ++i) {
      for (int j = i + 1; j < n; ++j) {
        Eigen::RowVector2d apart = at.row(j) - at.row(i);
        double length = apart.norm();
        if (length >= distance - 1e-3) continue;
        // Points at one place part along some direction of their own.
        if (length < 1e-9) {
          apart << std::cos(1.0 + i + 2.0 * j), std::sin(1.0 + i + 2.0 * j);
          length = 1.0;
        }
        const Eigen::RowVector2d push =
            apart / length *
            (0.5 * (distance - (at.row(j) - at.row(i)).norm()));
        at.row(i) -= push;
        at.row(j) += push;
        moved = true;
      }
    }
    for (int i = 0; i < n; ++i) {
      for (int k = 0; k < 2; ++k)
        at(i, k) = std::clamp(at(i, k), low[k], high[k]);
    }
    if (!moved) break;
  }
  return at;
}

}  // namespace ibrdf
