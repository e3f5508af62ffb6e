#include "ibrdf/solvers/observation/observation.h"

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
constexpr size_t kThinPoints = 4000;  // about as many are left
// A pair has squares of so many pixels a side, one of so many each way.
constexpr int kBlock = 8;
constexpr int kOfBlocks = 3;
// A pair has at most about so many pixels, which are transported at once.
constexpr size_t kMostPairPoints = 8192;

Observation WithRadiance(std::vector<ShadingPoint> points,
                         const std::vector<double>& radiance) {
  Observation out;
  out.observed = MakeObservations(radiance);
  out.points = std::move(points);
  return out;
}

// Those points of `pixels` that `keep`, a function of a pixel's column and row,
// returns true for.
template <typename Keep>
Observation Select(const Observation& pixels, int image_width,
                   const Keep& keep) {
  std::vector<ShadingPoint> points;
  std::vector<double> radiance;
  for (size_t i = 0; i < pixels.points.size(); ++i) {
    const ShadingPoint& p = pixels.points[i];
    if (!keep(p.pixel % image_width, p.pixel / image_width)) continue;
    points.push_back(p);
    const double* const rgb = &pixels.observed.radiance[3 * i];
    radiance.insert(radiance.end(), rgb, rgb + 3);
  }
  return WithRadiance(std::move(points), radiance);
}

// The least step at which every step-th row and column of `points` pixels
// leaves at most `most`.
size_t StepFor(size_t points, size_t most) {
  size_t step = 1;
  while (points > most * step * step) ++step;
  return step;
}

}  // namespace

std::vector<double> RadianceOf(const Image& image,
                               const std::vector<ShadingPoint>& points) {
  std::vector<double> radiance;
  for (const ShadingPoint& p : points) {
    const float* rgb = image.rgb.data() + size_t{3} * p.pixel;
    radiance.insert(radiance.end(), rgb, rgb + 3);
  }
  return radiance;
}

Observation Observe(const Image& image,
                    const std::vector<ShadingPoint>& points) {
  return WithRadiance(points, RadianceOf(image, points));
}

Observation MeansByNormal(const Observation& pixels, int bins_across) {
  BinMeans bins = MeanByNormal(pixels.points, pixels.observed.radiance,
                               bins_across, kMinCosine);
  if (bins.points.empty()) return pixels;
  return WithRadiance(std::move(bins.points), bins.radiance);
}

Observation Thin(const Observation& pixels, int image_width) {
  const int step = static_cast<int>(StepFor(pixels.points.size(), kThinPoints));
  Observation thin = Select(pixels, image_width, [step](int x, int y) {
    return x % step == 0 && y % step == 0;
  });
  return thin.observed.num_valid > 0 ? thin : pixels;
}

Observation OnePixelPerBin(const Observation& pixels, int bins_across) {
  const NormalBins bins = BinByNormal(pixels.points, pixels.observed.radiance,
                                      {bins_across, 1, kMinCosine});
  if (bins.points.empty()) return pixels;
  std::unordered_set<int> chosen;
  for (const ShadingPoint& p : bins.points) chosen.insert(p.pixel);
  std::unordered_map<int, size_t> where;  // of chosen pixels in `pixels`
  for (size_t i = 0; i < pixels.points.size(); ++i) {
    const int pixel = pixels.points[i].pixel;
    if (chosen.count(pixel) != 0) where.emplace(pixel, i);
  }
  std::vector<double> radiance;
  for (const ShadingPoint& p : bins.points) {
    const double* const rgb = &pixels.observed.radiance[3 * where.at(p.pixel)];
    radiance.insert(radiance.end(), rgb, rgb + 3);
  }
  return WithRadiance(bins.points, radiance);
}

ObservationPair MakePair(const Observation& pixels, int image_width,
                         int bins_across) {
  // In squares' pixels, each way.
  const size_t step =
      StepFor(pixels.points.size(), kMostPairPoints * kOfBlocks * kOfBlocks);
  ObservationPair pair;
  pair.pixels = Select(pixels, image_width, [step](int x, int y) {
    return x / kBlock % kOfBlocks == 0 && y / kBlock % kOfBlocks == 0 &&
           x % step == 0 && y % step == 0;
  });
  BinMeans bins =
      MeanByNormal(pair.pixels.points, pair.pixels.observed.radiance,
                   bins_across, kMinCosine);
  pair.bins = WithRadiance(std::move(bins.points), bins.radiance);
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
      MeanByNormal(pixels.points, radiance, bins_across, kMinCosine).radiance;
  if (binned.empty() || binned.size() != of_bins.size()) return 0.0;
  double sum = 0.0;
  for (size_t i = 0; i < binned.size(); ++i) {
    sum += std::abs(std::log(of_bins[i] / binned[i]));
  }
  return std::isfinite(sum) ? sum / static_cast<double>(binned.size()) : 0.0;
}

}  // namespace ibrdf
