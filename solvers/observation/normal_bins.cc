#include "ibrdf/solvers/observation/normal_bins.h"

#include <glog/logging.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <map>

#include "ibrdf/transport/quadrature.h"

namespace ibrdf {

namespace {

// Log of the mean of `values` [points * 3] over some points, by channel.
Eigen::Array3d LogMean(const std::vector<double>& values,
                       const std::vector<size_t>& points) {
  Eigen::Array3d sum = Eigen::Array3d::Zero();
  for (const size_t i : points) {
    sum += Eigen::Map<const Eigen::Array3d>(&values[3 * i]);
  }
  const Eigen::Array3d mean = sum / static_cast<double>(points.size());
  return {std::log(mean[0]), std::log(mean[1]), std::log(mean[2])};
}

// [bins] to [3 * bins], by channel.
std::vector<double> ByChannel(const std::vector<Eigen::Array3d>& bins) {
  std::vector<double> values;
  for (int c = 0; c < 3; ++c) {
    for (const Eigen::Array3d& bin : bins) values.push_back(bin[c]);
  }
  return values;
}

// At most so many of a list, evenly spread.
class Thinning {
 public:
  Thinning(size_t count, int most)
      : count_(count), most_(most > 0 ? static_cast<size_t>(most) : count) {}

  bool Keeps(size_t i) const {
    return count_ <= most_ || i * most_ / count_ != (i + 1) * most_ / count_;
  }

 private:
  size_t count_, most_;
};

}  // namespace

std::optional<Eigen::Vector2d> NormalInView(const ShadingPoint& point,
                                            double min_cosine) {
  const Eigen::Vector3d n = point.normal.cast<double>().normalized();
  const Eigen::Vector3d wo = point.wo.cast<double>().normalized();
  if (n.dot(wo) < min_cosine) return std::nullopt;
  Eigen::Vector3d right, up;
  ViewFrame(wo, Eigen::Vector3d::UnitY(), &up, &right);
  return Eigen::Vector2d(n.dot(right), n.dot(up));
}

NormalBins BinByNormal(const std::vector<ShadingPoint>& points,
                       const Observations& observed,
                       const NormalBinOptions& options) {
  CHECK_EQ(observed.radiance.size(), 3 * points.size());
  CHECK(options.bins_across > 0 && options.points_per_bin > 0);
  const auto bin_of = [&](double x) {
    return std::clamp(static_cast<int>((0.5 * x + 0.5) * options.bins_across),
                      0, options.bins_across - 1);
  };
  std::map<std::array<int, 5>, std::vector<size_t>> members;
  for (size_t i = 0; i < points.size(); ++i) {
    const std::optional<Eigen::Vector2d> normal =
        NormalInView(points[i], options.min_cosine);
    if (!observed.valid[i] || !normal.has_value()) continue;
    members[{points[i].material, points[i].part, points[i].view,
             bin_of(normal->y()), bin_of(normal->x())}]
        .push_back(i);
  }
  NormalBins bins;
  bins.first.push_back(0);
  std::vector<Eigen::Array3d> means, lows, highs;
  const Thinning thinning(members.size(), options.most_bins);
  size_t rank = 0;
  for (const auto& [bin, all] : members) {
    if (!thinning.Keeps(rank++)) continue;
    const size_t count =
        std::min(static_cast<size_t>(options.points_per_bin), all.size());
    std::vector<size_t> kept;
    for (size_t k = 0; k < count; ++k) {
      // Evenly spread over the list, which runs in image order.
      kept.push_back(all[(2 * k + 1) * all.size() / (2 * count)]);
      bins.points.push_back(points[kept.back()]);
    }
    bins.first.push_back(static_cast<int>(bins.points.size()));
    means.push_back(LogMean(observed.radiance, kept));
    if (observed.exact()) continue;
    lows.push_back(LogMean(observed.low, kept));
    highs.push_back(LogMean(observed.high, kept));
  }
  bins.log_radiance = ByChannel(means);
  bins.log_low = ByChannel(lows);
  bins.log_high = ByChannel(highs);
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
  const auto select = [&](const std::vector<double>& values) {
    std::vector<double> selected;
    for (size_t k = 0; k < values.size(); ++k) {
      if (keep[k % count]) selected.push_back(values[k]);
    }
    return selected;
  };
  kept.log_radiance = select(bins.log_radiance);
  kept.log_low = select(bins.log_low);
  kept.log_high = select(bins.log_high);
  return kept;
}

}  // namespace ibrdf
