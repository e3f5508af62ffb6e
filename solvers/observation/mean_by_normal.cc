#include "ibrdf/solvers/observation/mean_by_normal.h"

#include <glog/logging.h>

#include <array>
#include <cmath>
#include <map>

#include "ibrdf/solvers/observation/normal_bins.h"

namespace ibrdf {
namespace {

// Side of the bins of viewing directions, in components of the unit vector:
// finer than any bin of normals, and one bin for an orthographic view.
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

BinMeans MeanByNormal(const std::vector<ShadingPoint>& points,
                      const std::vector<double>& radiance, int bins_across,
                      double min_cosine) {
  CHECK_EQ(radiance.size(), 3 * points.size());
  CHECK_GT(bins_across, 0);
  const double side = 2.0 / bins_across;
  std::map<std::array<int, 5>, Sums> bins;
  for (size_t i = 0; i < points.size(); ++i) {
    const std::optional<Eigen::Vector2d> in_view =
        NormalInView(points[i], &radiance[3 * i], min_cosine);
    if (!in_view.has_value()) continue;
    const Eigen::Map<const Eigen::Array3d> rgb(&radiance[3 * i]);
    const Eigen::Vector3d n = points[i].normal.cast<double>().normalized();
    const Eigen::Vector3d wo = points[i].wo.cast<double>().normalized();
    Sums& sums = bins[{Bin(wo.x(), kViewBin), Bin(wo.y(), kViewBin),
                       Bin(wo.z(), kViewBin), Bin(in_view->y(), side),
                       Bin(in_view->x(), side)}];
    if (sums.first == nullptr) sums.first = &points[i];
    sums.normal += n;
    sums.wo += wo;
    sums.log_radiance += rgb.log();
    ++sums.count;
  }
  BinMeans out;
  for (const auto& [key, sums] : bins) {
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
