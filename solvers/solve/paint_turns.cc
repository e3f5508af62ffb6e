#include "ibrdf/solvers/solve/paint_turns.h"

#include <glog/logging.h>

#include <Eigen/Core>
#include <algorithm>
#include <cmath>
#include <utility>
#include <vector>

#include "ibrdf/brdf/brdf_grid.h"
#include "ibrdf/brdf/lambertian.h"
#include "ibrdf/solvers/paint/albedo_fit.h"
#include "ibrdf/solvers/solve/unpainted_object.h"

namespace ibrdf {
namespace {

// Places across an object of square shape. Nearer ones differ by little but
// noise, farther ones are less often of one paint.
constexpr double kPlacesAcross = 23.0;
constexpr size_t kFewestPairs = 50;
// Darker where the surface turns away, a place's mean is not its middle's.
constexpr float kLeastCosine = 0.3f;
// A sharp edge changes log R/G or log B/G by this. Balls with patches and
// prints have it in 0.08 to 0.31 of the pairs, those with wood and fading paint
// in 0.02 at most.
constexpr double kSharpStep = 0.4, kSharpPairs = 0.04;
constexpr double kMostAlike = 0.35;  // quantile
// Where no turn leaves less of the pairs they are not of one paint. The right
// one left 0.02 at most of those balls.
constexpr double kExplainedOfPairs = 0.05;
// On seven balls with sharp edges the right frame's misfit was at most 1.03
// times that of the best turn, and a wrong one's 1.19 times at least.
constexpr double kBetter = 1.11;
// Frames differ by quarter turns: one that is as good as this is preferred.
constexpr double kAsGood = 1.05;
constexpr double kLeastShading = 1e-9;

struct Places {
  std::vector<ShadingPoint> points;
  std::vector<Eigen::Array3d> log_radiance;  // means around the points
  std::vector<std::pair<size_t, size_t>> pairs;
};

// Pixels by place, of which one view's are taken; -1: none to be used.
class PixelGrid {
 public:
  PixelGrid(const Observation& pixels, int width)
      : pixels_(pixels), width_(width) {
    int last = 0;
    for (const ShadingPoint& point : pixels.points) {
      last = std::max(last, point.pixel);
    }
    point_.assign((static_cast<size_t>(last) / width + 1) * width, -1);
    for (size_t i = 0; i < pixels.points.size(); ++i) {
      if (pixels.points[i].view == 0 && HasKnownRadiance(pixels.observed, i)) {
        point_[pixels.points[i].pixel] = static_cast<int>(i);
      }
    }
  }

  int height() const { return static_cast<int>(point_.size()) / width_; }
  int At(int x, int y) const {
    return x < 0 || y < 0 || x >= width_ || y >= height()
               ? -1
               : point_[static_cast<size_t>(y) * width_ + x];
  }
  // The mean of log radiance within `reach` pixels.
  Eigen::Array3d MeanAround(int x, int y, int reach) const {
    Eigen::Array3d sum = Eigen::Array3d::Zero();
    int count = 0;
    for (int dy = -reach; dy <= reach; ++dy) {
      for (int dx = -reach; dx <= reach; ++dx) {
        const int point = At(x + dx, y + dy);
        if (point < 0) continue;
        const double* I =
            &pixels_.observed.radiance[3 * static_cast<size_t>(point)];
        sum += Eigen::Map<const Eigen::Array3d>(I).log();
        ++count;
      }
    }
    return sum / count;
  }

 private:
  const Observation& pixels_;
  const int width_;
  std::vector<int> point_;
};

Places PlacesOf(const Observation& pixels, int width) {
  Places places;
  const PixelGrid grid(pixels, width);
  const int step = std::max(
      1, static_cast<int>(
             std::lround(std::sqrt(static_cast<double>(pixels.points.size())) /
                         kPlacesAcross)));
  std::vector<int> above(width, -1);  // places of the last row
  for (int y = step / 2; y < grid.height(); y += step) {
    int left = -1;
    for (int x = step / 2; x < width; x += step) {
      const int point = grid.At(x, y);
      const bool used =
          point >= 0 && pixels.points[point].normal.dot(
                            pixels.points[point].wo) > kLeastCosine;
      const int place = used ? static_cast<int>(places.points.size()) : -1;
      if (used) {
        places.points.push_back(pixels.points[point]);
        places.log_radiance.push_back(grid.MeanAround(x, y, step / 2));
        for (const int other : {left, above[x]}) {
          if (other >= 0) places.pairs.emplace_back(other, place);
        }
      }
      left = above[x] = place;
    }
  }
  return places;
}

// The logarithm of a matte object's radiance under a turn [places][3].
Eigen::ArrayX3d LogShading(const TurnedMaps& maps, int turn) {
  Eigen::ArrayX3d shading(maps.Radiance(turn, 0, 0).size(), 3);
  for (int c = 0; c < 3; ++c) shading.col(c) = maps.Radiance(turn, 0, c);
  return shading.log();
}

// What the shading leaves of the pairs' differences [pairs][3]; not finite
// where no light comes from.
Eigen::ArrayX3d LeftOfPairs(const Places& places,
                            const Eigen::ArrayX3d& log_shading) {
  Eigen::ArrayX3d left(static_cast<Eigen::Index>(places.pairs.size()), 3);
  for (Eigen::Index k = 0; k < left.rows(); ++k) {
    const auto& [a, b] = places.pairs[static_cast<size_t>(k)];
    left.row(k) =
        (places.log_radiance[a] - places.log_radiance[b]).transpose() -
        (log_shading.row(static_cast<Eigen::Index>(a)) -
         log_shading.row(static_cast<Eigen::Index>(b)));
  }
  return left;
}

double MisfitOfAlike(const Eigen::ArrayX3d& left) {
  std::vector<double> sizes;
  for (const double difference : left.reshaped()) {
    sizes.push_back(std::isfinite(difference) ? std::abs(difference)
                                              : HUGE_VAL);
  }
  const auto at =
      sizes.begin() + static_cast<std::ptrdiff_t>(
                          kMostAlike * static_cast<double>(sizes.size()));
  std::nth_element(sizes.begin(), at, sizes.end());
  return *at;
}

bool HasSharpEdges(const Eigen::ArrayX3d& left) {
  const Eigen::ArrayXd chroma =
      (left.col(0) - left.col(1)).abs().max((left.col(2) - left.col(1)).abs());
  const double share = (chroma >= kSharpStep).cast<double>().sum() /
                       static_cast<double>(chroma.size());
  VLOG(1) << "a share of " << share << " of places differs in colour";
  return share > kSharpPairs;
}

// How the log albedo's luminance differs under two maps [points], less its
// mean.
Eigen::ArrayXd ChangeOfAlbedo(const std::vector<double>& shading,
                              const std::vector<double>& other_shading) {
  const auto log_of = [](const std::vector<double>& values) {
    return Eigen::Map<const Eigen::Array3Xd>(
               values.data(), 3, static_cast<Eigen::Index>(values.size()) / 3)
        .max(kLeastShading)
        .log()
        .eval();
  };
  const Eigen::ArrayXd change =
      (log_of(shading) - log_of(other_shading)).colwise().mean().transpose();
  return change - change.mean();
}

}  // namespace

std::optional<MapTurns> FindPaintTurns(const SolveSetup& setup) {
  const Places places = PlacesOf(setup.pixels, setup.problem->image.width);
  if (places.pairs.size() < kFewestPairs) return {};
  const TurnedMaps maps(
      setup, places.points,
      {BrdfGrid::FromFunction(Lambertian{Eigen::Array3d::Ones()}.Function(),
                              setup.transport.grid)});
  std::vector<double> misfits;
  Eigen::ArrayX3d least;  // what the best turn leaves
  for (int turn = 0; turn < maps.num_turns(); ++turn) {
    Eigen::ArrayX3d left = LeftOfPairs(places, LogShading(maps, turn));
    const double misfit = MisfitOfAlike(left);
    if (misfits.empty() ||
        misfit < *std::min_element(misfits.begin(), misfits.end())) {
      least = std::move(left);
    }
    misfits.push_back(misfit);
  }
  const MapTurns found = maps.Best(misfits, kAsGood);
  if (found.best.misfit > kExplainedOfPairs || !HasSharpEdges(least)) return {};
  VLOG(1) << "like paint differs by " << found.as_given
          << " under the map as it is given, by " << found.best.misfit
          << " under the map " << (found.best.mirrored ? "mirrored and " : "")
          << "turned by " << found.best.degrees;
  return found;
}

bool IsBetterOfPaint(const MapTurns& turns) {
  return turns.as_given > kBetter * turns.best.misfit;
}

void DoubtAlbedo(const SolveSetup& setup, const MapTurn& turn,
                 Solution* solution) {
  InverseProblem problem = *setup.problem;
  const Image& map = *setup.problem->known_map;
  problem.known_map =
      Turned(map, turn.mirrored,
             static_cast<int>(std::lround(turn.degrees / 360.0 * map.width)));
  const StatusOr<SolveSetup> turned = SetUp(problem);
  if (!turned.ok()) return;
  const Eigen::ArrayXd change =
      ChangeOfAlbedo(MatteShading(setup), MatteShading(*turned));
  for (Eigen::Index i = 0; i < change.size(); ++i) {
    float* std =
        &solution->albedo_log_std
             .rgb[3 * static_cast<size_t>(setup.pixels.points[i].pixel)];
    std::fill_n(std, 3,
                static_cast<float>(
                    std::min(kMostOfPaint, std::hypot(*std, change[i]))));
  }
}

}  // namespace ibrdf
