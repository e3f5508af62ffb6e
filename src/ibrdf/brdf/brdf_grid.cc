#include "ibrdf/brdf/brdf_grid.h"

#include <glog/logging.h>

#include <algorithm>
#include <cmath>

#include "ibrdf/base/parallel_for.h"
#include "ibrdf/base/pi.h"
#include "ibrdf/geometry/half_diff.h"

namespace ibrdf {
namespace {

// Whether InterpolateMerl would meet a valid bin.
bool AnyValidCorner(const MerlTable& table, double theta_h, double theta_d,
                    double phi_d) {
  const double x = std::sqrt(theta_h / (kPi / 2)) * kMerlThetaH - 0.5;
  const double y = theta_d / (kPi / 2) * kMerlThetaD - 0.5;
  const double z = phi_d / kPi * kMerlPhiD - 0.5;
  const int x0 = static_cast<int>(std::floor(x));
  const int y0 = static_cast<int>(std::floor(y));
  const int z0 = static_cast<int>(std::floor(z));
  for (int corner = 0; corner < 8; ++corner) {
    const int di = corner & 1, dj = (corner >> 1) & 1, dk = corner >> 2;
    // A corner of weight zero is not read.
    if ((di == 1 && x == x0) || (dj == 1 && y == y0) || (dk == 1 && z == z0)) {
      continue;
    }
    const int bin = MerlTable::Bin(std::clamp(x0 + di, 0, kMerlThetaH - 1),
                                   std::clamp(y0 + dj, 0, kMerlThetaD - 1),
                                   (z0 + dk + kMerlPhiD) % kMerlPhiD);
    if (table.Raw(0, bin) >= 0.0) return true;
  }
  return false;
}
}  // namespace

Eigen::Vector3d ToUnitCube(double theta_h, double theta_d, double phi_d) {
  const double bound = ThetaHBound(theta_d, phi_d);
  const double ratio =
      bound > 0.0 ? std::clamp(theta_h / bound, 0.0, 1.0) : 0.0;
  double x_p = phi_d / kPi;
  x_p -= std::floor(x_p);
  return {std::sqrt(ratio), std::clamp(theta_d / (kPi / 2), 0.0, 1.0), x_p};
}

Eigen::Vector3d BrdfGridShape::NodePoint(int node) const {
  const int ip = node % p, id = (node / p) % d, ih = node / (p * d);
  return {ih / (h - 1.0), id / (d - 1.0), ip / static_cast<double>(p)};
}

Eigen::Vector3d BrdfGridShape::NodeAngles(int node) const {
  const Eigen::Vector3d x = NodePoint(node);
  const double theta_d = x.y() * (kPi / 2), phi_d = x.z() * kPi;
  return {x.x() * x.x() * ThetaHBound(theta_d, phi_d), theta_d, phi_d};
}

BrdfGridCell FindCell(const BrdfGridShape& shape, const Eigen::Vector3d& x) {
  const double h = std::clamp(x[0], 0.0, 1.0) * (shape.h - 1);
  const double d = std::clamp(x[1], 0.0, 1.0) * (shape.d - 1);
  const double p = (x[2] - std::floor(x[2])) * shape.p;
  BrdfGridCell cell{};
  cell.h = std::min(static_cast<int>(h), shape.h - 2);
  cell.d = std::min(static_cast<int>(d), shape.d - 2);
  cell.p = std::min(static_cast<int>(p), shape.p - 1);
  cell.fh = h - cell.h;
  cell.fd = d - cell.d;
  cell.fp = p - cell.p;
  return cell;
}

BrdfGridTaps GridTaps(const BrdfGridShape& shape, const Eigen::Vector3d& x) {
  const BrdfGridCell cell = FindCell(shape, x);
  BrdfGridTaps taps;
  for (int corner = 0; corner < 8; ++corner) {
    const int ih = corner >> 2, id = (corner >> 1) & 1, ip = corner & 1;
    taps.node[corner] =
        shape.Node(cell.h + ih, cell.d + id, (cell.p + ip) % shape.p);
    taps.weight[corner] = (ih ? cell.fh : 1.0 - cell.fh) *
                          (id ? cell.fd : 1.0 - cell.fd) *
                          (ip ? cell.fp : 1.0 - cell.fp);
  }
  return taps;
}

BrdfGrid BrdfGrid::FromFunction(const BrdfFunction& brdf,
                                const BrdfGridShape& shape) {
  CHECK(shape.h >= 2 && shape.d >= 2 && shape.p >= 1);
  // A lobe grows as 1 / cos^2(theta_d) and has no value at 90 degrees: there
  // the last bin centre's stands for it, as in FromMerl.
  const double last_theta_d = MerlThetaD(kMerlThetaD - 1);
  BrdfGrid grid(shape);
  ParallelFor(shape.h, 0, [&](int64_t ih, int) {
    const int per_h = shape.d * shape.p;
    for (int k = 0; k < per_h; ++k) {
      const int node = static_cast<int>(ih) * per_h + k;
      const Eigen::Vector3d angles = shape.NodeAngles(node);
      const Eigen::Array3d f =
          brdf(angles[0], std::min(angles[1], last_theta_d), angles[2]);
      for (int c = 0; c < 3; ++c) {
        grid.Channel(c)[node] = static_cast<float>(f[c]);
      }
    }
  });
  return grid;
}

BrdfGrid BrdfGrid::FromMerl(const MerlTable& table,
                            const BrdfGridShape& shape) {
  const auto lookup = [&table](double theta_h, double theta_d, double phi_d) {
    double x = std::sqrt(theta_h / (kPi / 2)) * kMerlThetaH;
    while (x > 0.0 && !AnyValidCorner(table, theta_h, theta_d, phi_d)) {
      x = std::max(x - 0.5, 0.0);  // half a bin
      theta_h = x * x / (kMerlThetaH * kMerlThetaH) * (kPi / 2);
    }
    return InterpolateMerl(table, theta_h, theta_d, phi_d);
  };
  return FromFunction(lookup, shape);
}

Eigen::Array3d BrdfGrid::Evaluate(double theta_h, double theta_d,
                                  double phi_d) const {
  const BrdfGridTaps taps =
      GridTaps(shape, ToUnitCube(theta_h, theta_d, phi_d));
  Eigen::Array3d f = Eigen::Array3d::Zero();
  for (int i = 0; i < 8; ++i) {
    for (int c = 0; c < 3; ++c) {
      f[c] += taps.weight[i] * Channel(c)[taps.node[i]];
    }
  }
  return f;
}

}  // namespace ibrdf
