#include "ibrdf/solvers/observation/observation.h"

#include <algorithm>
#include <cmath>
#include <unordered_map>
#include <unordered_set>
#include <utility>

#include "ibrdf/solvers/observation/mean_by_normal.h"
#include "ibrdf/solvers/observation/normal_bins.h"

namespace ibrdf {
namespace {

// Points nearer the limb are left out.
constexpr double kMinCosine = 0.1;
constexpr size_t kMostHighlights = 240;
constexpr size_t kThinPoints = 4000;  // about as many are left
// A pair has squares of so many pixels a side, one of so many each way.
constexpr int kBlock = 8;
constexpr int kOfBlocks = 3;
// A pair has at most about so many pixels, which are transported at once.
constexpr size_t kMostPairPoints = 8192;

// The points of `pixels`, by index.
Observation Select(const Observation& pixels,
                   const std::vector<size_t>& points) {
  Observation out;
  for (const size_t i : points) out.points.push_back(pixels.points[i]);
  out.observed = SelectObservations(pixels.observed, points);
  return out;
}

// Radiance of the points' pixels, [points * 3].
std::vector<double> ValuesOf(const Image& image,
                             const std::vector<ShadingPoint>& points) {
  std::vector<double> values;
  for (const ShadingPoint& p : points) {
    const float* rgb = image.rgb.data() + size_t{3} * p.pixel;
    values.insert(values.end(), rgb, rgb + 3);
  }
  return values;
}

// Those points of `pixels` that `keep`, a function of a pixel's column and row,
// returns true for.
template <typename Keep>
Observation SelectPixels(const Observation& pixels, int image_width,
                         const Keep& keep) {
  std::vector<size_t> kept;
  for (size_t i = 0; i < pixels.points.size(); ++i) {
    const int pixel = pixels.points[i].pixel;
    if (keep(pixel % image_width, pixel / image_width)) kept.push_back(i);
  }
  return Select(pixels, kept);
}

// The least step at which every step-th row and column of `points` pixels
// leaves at most `most`.
size_t StepFor(size_t points, size_t most) {
  size_t step = 1;
  while (points > most * step * step) ++step;
  return step;
}

}  // namespace

Observation Observe(const Image& image, const RadianceBounds* bounds,
                    const std::vector<ShadingPoint>& points) {
  std::vector<double> low, high;
  if (bounds != nullptr) {
    low = ValuesOf(bounds->low, points);
    high = ValuesOf(bounds->high, points);
  }
  return {points, MakeObservations(ValuesOf(image, points), std::move(low),
                                   std::move(high))};
}

Observation MeansByNormal(const Observation& pixels, int bins_across) {
  BinMeans bins =
      MeanByNormal(pixels.points, pixels.observed, bins_across, kMinCosine);
  if (bins.points.empty()) return pixels;
  return {std::move(bins.points), std::move(bins.observed)};
}

Observation Thin(const Observation& pixels, int image_width) {
  const int step = static_cast<int>(StepFor(pixels.points.size(), kThinPoints));
  Observation thin = SelectPixels(pixels, image_width, [step](int x, int y) {
    return x % step == 0 && y % step == 0;
  });
  return thin.observed.num_valid > 0 ? thin : pixels;
}

Observation OnePixelPerBin(const Observation& pixels, int bins_across) {
  const NormalBins bins =
      BinByNormal(pixels.points, pixels.observed, {bins_across, 1, kMinCosine});
  if (bins.points.empty()) return pixels;
  std::unordered_map<int, size_t> where;  // of pixels in `pixels`
  for (size_t i = 0; i < pixels.points.size(); ++i) {
    where.emplace(pixels.points[i].pixel, i);
  }
  std::vector<size_t> chosen;
  for (const ShadingPoint& p : bins.points) chosen.push_back(where.at(p.pixel));
  return Select(pixels, chosen);
}

Observation Highlights(const Observation& pixels,
                       const std::vector<Eigen::Vector3d>& lights,
                       double angle) {
  const double least = std::cos(angle);
  const auto mirrors = [&](const ShadingPoint& point) {
    const Eigen::Vector3d n = point.normal.cast<double>().normalized();
    const Eigen::Vector3d wo = point.wo.cast<double>().normalized();
    return std::any_of(lights.begin(), lights.end(),
                       [&](const Eigen::Vector3d& light) {
                         const Eigen::Vector3d h = light + wo;
                         return n.dot(h) > least * h.norm();
                       });
  };
  std::vector<size_t> found;
  for (size_t i = 0; i < pixels.points.size(); ++i) {
    if (pixels.observed.valid[i] && mirrors(pixels.points[i])) {
      found.push_back(i);
    }
  }
  const size_t count = std::min(found.size(), kMostHighlights);
  std::vector<size_t> kept;
  for (size_t k = 0; k < count; ++k) {
    kept.push_back(found[k * found.size() / count]);
  }
  return Select(pixels, kept);
}

Observation Union(const Observation& first, const Observation& second) {
  std::unordered_set<int> there;  // pixels
  for (const ShadingPoint& p : first.points) there.insert(p.pixel);
  std::vector<size_t> more;
  for (size_t i = 0; i < second.points.size(); ++i) {
    if (there.count(second.points[i].pixel) == 0) more.push_back(i);
  }
  const Observation added = Select(second, more);
  Observation out = first;
  out.points.insert(out.points.end(), added.points.begin(), added.points.end());
  const auto append = [](const std::vector<double>& from,
                         std::vector<double> to) {
    to.insert(to.end(), from.begin(), from.end());
    return to;
  };
  out.observed =
      MakeObservations(append(added.observed.radiance, first.observed.radiance),
                       append(added.observed.low, first.observed.low),
                       append(added.observed.high, first.observed.high));
  return out;
}

ObservationPair MakePair(const Observation& pixels, int image_width,
                         int bins_across) {
  // In squares' pixels, each way.
  const size_t step =
      StepFor(pixels.points.size(), kMostPairPoints * kOfBlocks * kOfBlocks);
  ObservationPair pair;
  pair.pixels = SelectPixels(pixels, image_width, [step](int x, int y) {
    return x / kBlock % kOfBlocks == 0 && y / kBlock % kOfBlocks == 0 &&
           x % step == 0 && y % step == 0;
  });
  BinMeans bins = MeanByNormal(pair.pixels.points, pair.pixels.observed,
                               bins_across, kMinCosine);
  pair.bins = {std::move(bins.points), std::move(bins.observed)};
  return pair;
}

double BinningError(const Observation& pixels,
                    const std::vector<double>& of_pixels,
                    const std::vector<double>& of_bins, int bins_across) {
  // Pixels that are in no bin of the image are in none here.
  std::vector<double> radiance = of_pixels;
  for (size_t i = 0; i < radiance.size(); ++i) {
    if (!pixels.observed.valid[i / 3]) radiance[i] = 0.0;
  }
  const std::vector<double> binned =
      MeanByNormal(pixels.points, MakeObservations(std::move(radiance)),
                   bins_across, kMinCosine)
          .observed.radiance;
  if (binned.empty() || binned.size() != of_bins.size()) return 0.0;
  double sum = 0.0;
  for (size_t i = 0; i < binned.size(); ++i) {
    sum += std::abs(std::log(of_bins[i] / binned[i]));
  }
  return std::isfinite(sum) ? sum / static_cast<double>(binned.size()) : 0.0;
}

}  // namespace ibrdf
