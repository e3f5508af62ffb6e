// A BRDF as a table on the unit cube of the flow, linear between its nodes.
#pragma once
#include <Eigen/Core>
#include <cstddef>
#include <functional>
#include <vector>

#include "ibrdf/brdf/merl_table.h"

namespace ibrdf {

// Coordinates: x_h = sqrt(theta_h / ThetaHBound(theta_d, phi_d)),
// x_d = theta_d / (pi/2), both in [0, 1]; x_p = phi_d / pi, periodic, [0, 1).
Eigen::Vector3d ToUnitCube(double theta_h, double theta_d, double phi_d);

// Nodes at i / (n - 1) along x_h and x_d, end points included, and at k / n
// along x_p. Sizes: h, d >= 2, p >= 1.
struct BrdfGridShape {
  int h = 72;
  int d = 32;
  int p = 24;

  int num_nodes() const { return h * d * p; }
  int Node(int ih, int id, int ip) const { return (ih * d + id) * p + ip; }
  // Coordinates of a node.
  Eigen::Vector3d NodePoint(int node) const;
  // Its angles (theta_h, theta_d, phi_d), radians, all above the horizon.
  Eigen::Vector3d NodeAngles(int node) const;

  bool operator==(const BrdfGridShape& o) const {
    return h == o.h && d == o.d && p == o.p;
  }
};

// The cell that holds a point of the cube, and where in it.
struct BrdfGridCell {
  int h, d, p;        // lowest node; the upper neighbour of p is (p + 1) mod n
  double fh, fd, fp;  // in [0, 1]
};
BrdfGridCell FindCell(const BrdfGridShape& shape, const Eigen::Vector3d& x);

// Trilinear interpolation: f = sum weight[i] value[node[i]].
struct BrdfGridTaps {
  int node[8];
  double weight[8];  // >= 0, sum 1
};
BrdfGridTaps GridTaps(const BrdfGridShape& shape, const Eigen::Vector3d& x);

// BRDF in 1/sr at angles in radians, red, green, blue.
using BrdfFunction =
    std::function<Eigen::Array3d(double theta_h, double theta_d, double phi_d)>;

struct BrdfGrid {
  BrdfGridShape shape;
  std::vector<float> values;  // [3][num_nodes], 1/sr

  BrdfGrid() = default;
  explicit BrdfGrid(const BrdfGridShape& s)
      : shape(s), values(size_t{3} * s.num_nodes(), 0.0f) {}
  const float* Channel(int c) const {
    return values.data() + static_cast<size_t>(c) * shape.num_nodes();
  }
  float* Channel(int c) {
    return values.data() + static_cast<size_t>(c) * shape.num_nodes();
  }

  // Samples at the nodes; those at theta_d = 90 degrees at 89.5, as MERL tables
  // end there.
  static BrdfGrid FromFunction(const BrdfFunction& brdf,
                               const BrdfGridShape& shape);
  // By InterpolateMerl; a node whose bins are all invalid takes the value at
  // the nearest smaller theta_h that has one.
  static BrdfGrid FromMerl(const MerlTable& table, const BrdfGridShape& shape);

  Eigen::Array3d Evaluate(double theta_h, double theta_d, double phi_d) const;
};

}  // namespace ibrdf
