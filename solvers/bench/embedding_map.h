// The geometry of an embedding: principal axes, neighbours, a page layout.
#pragma once
#include <Eigen/Core>
#include <vector>

namespace ibrdf {

struct EmbeddingMap {
  Eigen::MatrixXd centred;   // [materials, dimensions], mean taken off
  Eigen::MatrixXd axes;      // [dimensions, components], unit columns
  Eigen::MatrixXd scores;    // [materials, components]
  Eigen::VectorXd variance;  // share of each component, descending, sum 1
};

// Principal components of points [materials, dimensions], at least two of them;
// as many as there are dimensions. An axis points to where its largest entry is
// positive.
EmbeddingMap PrincipalAxes(const Eigen::MatrixXd& points);

struct Neighbour {
  int index;
  double distance;
};
// The `count` nearest other points of each, nearest first; fewer where there
// are fewer points.
std::vector<std::vector<Neighbour>> NearestNeighbours(
    const Eigen::MatrixXd& points, int count);

// Moves places [n, 2] apart until the centres of all pairs are at least
// `distance` apart or `iterations` are over, each step as little as needed, in
// the box from low to high. Deterministic.
Eigen::MatrixXd SpreadApart(const Eigen::MatrixXd& places, double distance,
                            const Eigen::Array2d& low,
                            const Eigen::Array2d& high, int iterations = 2000);

}  // namespace ibrdf
