#include "ibrdf/solvers/observation/observation.h"

#include <cmath>
#include <utility>

#include "ibrdf/solvers/observation/mean_by_normal.h"
#include "ibrdf/solvers/observation/normal_bins.h"

namespace ibrdf {
namespace {

// Points nearer the limb are left out.
constexpr double kMinCosine = 0.1;
constexpr size_t kThinPoints = 4000;  // about as many are left
// Of MakeLevelPair: squares of so many pixels a side, one of so many each way.
constexpr int kBlock = 8;
constexpr int kOfBlocks = 3;
// Of these, at most about so many pixels: they are transported at once.
constexpr size_t kMostPairPoints = 8192;

std::unique_ptr<Level> MakeLevel(std::vector<ShadingPoint> points,
                                 const std::vector<double>& radiance) {
  auto level = std::make_unique<Level>();
  level->observed = MakeObservations(radiance);
  level->points = std::move(points);
  return level;
}

std::unique_ptr<Level> MakeThinLevel(const InverseProblem& problem) {
  int step = 1;
  while (problem.points.size() >
         kThinPoints * static_cast<size_t>(step) * step) {
    ++step;
  }
  std::vector<ShadingPoint> thin;
  for (const ShadingPoint& p : problem.points) {
    const int x = p.pixel % problem.image.width;
    const int y = p.pixel / problem.image.width;
    if (x % step == 0 && y % step == 0) thin.push_back(p);
  }
  std::unique_ptr<Level> level =
      MakeLevel(thin, RadianceOf(problem.image, thin));
  if (level->observed.num_valid > 0) return level;
  return MakeLevel(problem.points, RadianceOf(problem.image, problem.points));
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

std::unique_ptr<Level> MakeFullLevel(const InverseProblem& problem) {
  return MakeLevel(problem.points, RadianceOf(problem.image, problem.points));
}

std::unique_ptr<Level> MakeBinnedLevel(const InverseProblem& problem,
                                       int bins_across) {
  if (problem.transport.visibility != nullptr) return MakeThinLevel(problem);
  const std::vector<double> radiance =
      RadianceOf(problem.image, problem.points);
  BinMeans bins =
      MeanByNormal(problem.points, radiance, bins_across, kMinCosine);
  if (bins.points.empty()) return MakeLevel(problem.points, radiance);
  return MakeLevel(std::move(bins.points), bins.radiance);
}

LevelPair MakeLevelPair(const InverseProblem& problem, int bins_across) {
  size_t step = 1;  // in squares' pixels, each way
  while (problem.points.size() >
         kMostPairPoints * kOfBlocks * kOfBlocks * step * step) {
    ++step;
  }
  std::vector<ShadingPoint> some;
  for (const ShadingPoint& p : problem.points) {
    const size_t x = p.pixel % problem.image.width;
    const size_t y = p.pixel / problem.image.width;
    if (x / kBlock % kOfBlocks == 0 && y / kBlock % kOfBlocks == 0 &&
        x % step == 0 && y % step == 0) {
      some.push_back(p);
    }
  }
  const std::vector<double> radiance = RadianceOf(problem.image, some);
  BinMeans bins = MeanByNormal(some, radiance, bins_across, kMinCosine);
  return {MakeLevel(std::move(bins.points), bins.radiance),
          MakeLevel(std::move(some), radiance)};
}

double BinningError(const Level& pixels, const std::vector<double>& of_pixels,
                    const std::vector<double>& of_bins, int bins_across) {
  // Pixels that are in no bin of the image are in none here.
  std::vector<double> radiance = of_pixels;
  for (size_t i = 0; i < radiance.size(); ++i) {
    if (!pixels.observed.valid[i / 3]) radiance[i] = 0.0;
  }
  const std::vector<double> joined =
      MeanByNormal(pixels.points, radiance, bins_across, kMinCosine).radiance;
  if (joined.empty() || joined.size() != of_bins.size()) return 0.0;
  double sum = 0.0;
  for (size_t i = 0; i < joined.size(); ++i) {
    sum += std::abs(std::log(of_bins[i] / joined[i]));
  }
  return std::isfinite(sum) ? sum / static_cast<double>(joined.size()) : 0.0;
}

std::unique_ptr<Level> MakeSampleLevel(const InverseProblem& problem,
                                       int bins_across) {
  const std::vector<ShadingPoint> points =
      BinByNormal(problem.points, RadianceOf(problem.image, problem.points),
                  {bins_across, 1, kMinCosine})
          .points;
  if (points.empty()) return MakeFullLevel(problem);
  return MakeLevel(points, RadianceOf(problem.image, points));
}

}  // namespace ibrdf
