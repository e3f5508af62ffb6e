#include "ibrdf/solvers/observation/mean_by_normal.h"

#include <glog/logging.h>

#include <array>
#include <cmath>
#include <map>
#include <utility>

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
  // Sums over intervals; an open end makes the sum infinite.
  Eigen::Array3d log_low = Eigen::Array3d::Zero();
  Eigen::Array3d log_high = Eigen::Array3d::Zero();
  const ShadingPoint* first = nullptr;
  int count = 0;
};

int Bin(double x, double side) {
  return static_cast<int>(std::lround(x / side));
}

}  // namespace

BinMeans MeanByNormal(const std::vector<ShadingPoint>& points,
                      const Observations& observed, int bins_across,
                      double min_cosine) {
  CHECK_EQ(observed.radiance.size(), 3 * points.size());
  CHECK_GT(bins_across, 0);
  const double side = 2.0 / bins_across;
  std::map<std::array<int, 7>, Sums> bins;
  for (size_t i = 0; i < points.size(); ++i) {
    const std::optional<Eigen::Vector2d> in_view =
        NormalInView(points[i], min_cosine);
    if (!observed.valid[i] || !in_view.has_value()) continue;
    const auto values = [i](const std::vector<double>& of) {
      return Eigen::Map<const Eigen::Array3d>(&of[3 * i]);
    };
    const Eigen::Vector3d n = points[i].normal.cast<double>().normalized();
    const Eigen::Vector3d wo = points[i].wo.cast<double>().normalized();
    Sums& sums =
        bins[{points[i].material, points[i].view, Bin(wo.x(), kViewBin),
              Bin(wo.y(), kViewBin), Bin(wo.z(), kViewBin),
              Bin(in_view->y(), side), Bin(in_view->x(), side)}];
    if (sums.first == nullptr) sums.first = &points[i];
    sums.normal += n;
    sums.wo += wo;
    sums.log_radiance += values(observed.radiance).log();
    if (!observed.exact()) {
      sums.log_low += values(observed.low).log();
      sums.log_high += values(observed.high).log();
    }
    ++sums.count;
  }
  BinMeans out;
  std::vector<double> radiance, low, high;
  for (const auto& [key, sums] : bins) {
    ShadingPoint point = *sums.first;
    point.normal = sums.normal.normalized().cast<float>();
    point.wo = sums.wo.normalized().cast<float>();
    out.points.push_back(point);
    const auto append = [count = sums.count](const Eigen::Array3d& sum,
                                             std::vector<double>* means) {
      for (int c = 0; c < 3; ++c) means->push_back(std::exp(sum[c] / count));
    };
    append(sums.log_radiance, &radiance);
    if (observed.exact()) continue;
    append(sums.log_low, &low);
    append(sums.log_high, &high);
  }
  out.observed =
      MakeObservations(std::move(radiance), std::move(low), std::move(high));
  return out;
}

}  // namespace ibrdf
