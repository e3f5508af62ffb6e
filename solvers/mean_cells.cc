#include "solvers/mean_cells.h"

#include <glog/logging.h>

#include <array>
#include <cmath>
#include <map>

#include "ibrdf/render/quadrature.h"

namespace ibrdf {
namespace {

// Side of the bins of viewing directions, in components of the unit vector:
// finer than any cell of normals, and one bin for an orthographic view.
constexpr double kViewBin = 0.03;

struct Sums {
  Eigen::Vector3d normal = Eigen::Vector3d::Zero();
  Eigen::Vector3d wo = Eigen::Vector3d::Zero();
  Eigen::Array3d log_radiance = Eigen::Array3d::Zero();
  const ShadingPoint* first = nullptr;
  int count = 0;
};

int Bin(double x, double side) {
  return static_cast<int>(std::lround(x / side));
}

}  // namespace

MeanCells JoinLikePoints(const std::vector<ShadingPoint>& points,
                         const std::vector<double>& radiance, int cells_across,
                         double min_cosine) {
  CHECK_EQ(radiance.size(), 3 * points.size());
  CHECK_GT(cells_across, 0);
  const double side = 2.0 / cells_across;
  // By the normal in the frame of the world's axes but for its depth along the
  // view, which the other two tell.
  std::map<std::array<int, 5>, Sums> cells;
  for (size_t i = 0; i < points.size(); ++i) {
    const Eigen::Map<const Eigen::Array3d> rgb(&radiance[3 * i]);
    if (!rgb.isFinite().all() || !(rgb > 0.0).all()) continue;
    const Eigen::Vector3d n = points[i].normal.cast<double>().normalized();
    const Eigen::Vector3d wo = points[i].wo.cast<double>().normalized();
    if (n.dot(wo) < min_cosine) continue;
    Eigen::Vector3d up, across;
    ViewFrame(wo, Eigen::Vector3d::UnitY(), &up, &across);
    Sums& sums = cells[{Bin(wo.x(), kViewBin), Bin(wo.y(), kViewBin),
                        Bin(wo.z(), kViewBin), Bin(n.dot(up), side),
                        Bin(n.dot(across), side)}];
    if (sums.first == nullptr) sums.first = &points[i];
    sums.normal += n;
    sums.wo += wo;
    sums.log_radiance += rgb.log();
    ++sums.count;
  }
  MeanCells out;
  for (const auto& [key, sums] : cells) {
    ShadingPoint point = *sums.first;
    point.normal = sums.normal.normalized().cast<float>();
    point.wo = sums.wo.normalized().cast<float>();
    out.points.push_back(point);
    for (int c = 0; c < 3; ++c) {
      out.radiance.push_back(std::exp(sums.log_radiance[c] / sums.count));
    }
  }
  return out;
}

}  // namespace ibrdf
