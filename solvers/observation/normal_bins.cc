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

NormalBins BinByNormal(const std::vector<ShadingPoint>& points,
                       const std::vector<double>& radiance,
                       const NormalBinOptions& options) {
  CHECK_EQ(radiance.size(), 3 * points.size());
  CHECK(options.bins_across > 0 && options.points_per_bin > 0);
  const auto bin_of = [&](double x) {
    return std::clamp(static_cast<int>((0.5 * x + 0.5) * options.bins_across),
                      0, options.bins_across - 1);
  };
  std::map<int, std::vector<int>> members;
  for (size_t i = 0; i < points.size(); ++i) {
    const std::optional<Eigen::Vector2d> normal =
        NormalInView(points[i], &radiance[3 * i], options.min_cosine);
    if (!normal.has_value()) continue;
    members[bin_of(normal->y()) * options.bins_across + bin_of(normal->x())]
        .push_back(static_cast<int>(i));
  }
  NormalBins bins;
  bins.first.push_back(0);
  std::vector<Eigen::Array3d> means;
  for (const auto& [bin, all] : members) {
    const int count =
        std::min(options.points_per_bin, static_cast<int>(all.size()));
    Eigen::Array3d sum = Eigen::Array3d::Zero();
    for (int k = 0; k < count; ++k) {
      // Evenly spread over the list, which runs in image order.
      const int i = all[(2 * static_cast<size_t>(k) + 1) * all.size() /
                        (2 * static_cast<size_t>(count))];
      bins.points.push_back(points[i]);
      sum += Eigen::Array3d(radiance[3 * static_cast<size_t>(i)],
                            radiance[3 * static_cast<size_t>(i) + 1],
                            radiance[3 * static_cast<size_t>(i) + 2]);
    }
    bins.first.push_back(static_cast<int>(bins.points.size()));
    means.push_back(sum / count);
  }
  for (int c = 0; c < 3; ++c) {
    for (const Eigen::Array3d& mean : means) {
      bins.log_radiance.push_back(std::log(mean[c]));
    }
  }
  return bins;
}

NormalBins KeepBins(const NormalBins& bins, const std::vector<bool>& keep) {
  const int count = bins.num_bins();
  CHECK_EQ(keep.size(), static_cast<size_t>(count));
  NormalBins kept;
  kept.first.push_back(0);
  for (int i = 0; i < count; ++i) {
    if (!keep[i]) continue;
    kept.points.insert(kept.points.end(), bins.points.begin() + bins.first[i],
                       bins.points.begin() + bins.first[i + 1]);
    kept.first.push_back(static_cast<int>(kept.points.size()));
  }
  for (int c = 0; c < 3; ++c) {
    for (int i = 0; i < count; ++i) {
      if (keep[i])
        kept.log_radiance.push_back(bins.log_radiance[c * count + i]);
    }
  }
  return kept;
}

}  // namespace ibrdf
