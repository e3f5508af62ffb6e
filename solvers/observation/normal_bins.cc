#include "ibrdf/solvers/observation/normal_bins.h"

#include <glog/logging.h>

#include <algorithm>
#include <cmath>
#include <map>

#include "ibrdf/transport/quadrature.h"

namespace ibrdf {

std::optional<Eigen::Vector2d> NormalInView(const ShadingPoint& point,
                                            const double* radiance,
                                            double min_cosine) {
  if (!std::all_of(radiance, radiance + 3,
                   [](double v) { return std::isfinite(v) && v > 0.0; })) {
    return std::nullopt;
  }
  const Eigen::Vector3d n = point.normal.cast<double>().normalized();
  const Eigen::Vector3d wo = point.wo.cast<double>().normalized();
  if (n.dot(wo) < min_cosine) return std::nullopt;
  Eigen::Vector3d right, up;
  ViewFrame(wo, Eigen::Vector3d::UnitY(), &up, &right);
  return Eigen::Vector2d(n.dot(right), n.dot(up));
}

ImageCells GroupByNormal(const std::vector<ShadingPoint>& points,
                         const std::vector<double>& radiance,
                         const ImageCellOptions& options) {
  CHECK_EQ(radiance.size(), 3 * points.size());
  CHECK(options.cells_across > 0 && options.points_per_cell > 0);
  const auto bin = [&](double x) {
    return std::clamp(static_cast<int>((0.5 * x + 0.5) * options.cells_across),
                      0, options.cells_across - 1);
  };
  std::map<int, std::vector<int>> members;
  for (size_t i = 0; i < points.size(); ++i) {
    const std::optional<Eigen::Vector2d> normal =
        NormalInView(points[i], &radiance[3 * i], options.min_cosine);
    if (!normal.has_value()) continue;
    members[bin(normal->y()) * options.cells_across + bin(normal->x())]
        .push_back(static_cast<int>(i));
  }
  ImageCells cells;
  cells.first.push_back(0);
  std::vector<Eigen::Array3d> means;
  for (const auto& [cell, all] : members) {
    const int count =
        std::min(options.points_per_cell, static_cast<int>(all.size()));
    Eigen::Array3d sum = Eigen::Array3d::Zero();
    for (int k = 0; k < count; ++k) {
      // Evenly spread over the list, which runs in image order.
      const int i = all[(2 * static_cast<size_t>(k) + 1) * all.size() /
                        (2 * static_cast<size_t>(count))];
      cells.points.push_back(points[i]);
      sum += Eigen::Array3d(radiance[3 * static_cast<size_t>(i)],
                            radiance[3 * static_cast<size_t>(i) + 1],
                            radiance[3 * static_cast<size_t>(i) + 2]);
    }
    cells.first.push_back(static_cast<int>(cells.points.size()));
    means.push_back(sum / count);
  }
  for (int c = 0; c < 3; ++c) {
    for (const Eigen::Array3d& mean : means) {
      cells.log_radiance.push_back(std::log(mean[c]));
    }
  }
  return cells;
}

ImageCells KeepCells(const ImageCells& cells, const std::vector<bool>& keep) {
  const int count = cells.num_cells();
  CHECK_EQ(keep.size(), static_cast<size_t>(count));
  ImageCells kept;
  kept.first.push_back(0);
  for (int i = 0; i < count; ++i) {
    if (!keep[i]) continue;
    kept.points.insert(kept.points.end(), cells.points.begin() + cells.first[i],
                       cells.points.begin() + cells.first[i + 1]);
    kept.first.push_back(static_cast<int>(kept.points.size()));
  }
  for (int c = 0; c < 3; ++c) {
    for (int i = 0; i < count; ++i) {
      if (keep[i])
        kept.log_radiance.push_back(cells.log_radiance[c * count + i]);
    }
  }
  return kept;
}

}  // namespace ibrdf
