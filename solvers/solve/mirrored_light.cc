#include "ibrdf/solvers/solve/mirrored_light.h"

#include <Eigen/Dense>
#include <algorithm>
#include <cmath>
#include <cstdlib>
#include <utility>

#include "ibrdf/base/median.h"
#include "ibrdf/base/pi.h"
#include "ibrdf/light/environment_map.h"

namespace ibrdf {
namespace {

constexpr int kSamples = 3;  // of a pixel, a side
// Of the map's mean: what is darker counts as that.
constexpr double kDarkestMirrored = 1e-4;

Eigen::Vector3d MirroredDirection(const ShadingPoint& point) {
  const Eigen::Vector3d n = point.normal.cast<double>(),
                        wo = point.wo.cast<double>();
  return 2.0 * n.dot(wo) * n - wo;
}

// Mirrored directions of pixels, and how they turn from pixel to pixel.
class MirroredDirections {
 public:
  MirroredDirections(const std::vector<ShadingPoint>& points, int image_width)
      : points_(points), width_(image_width) {
    for (const ShadingPoint& point : points) {
      if (point.pixel >= static_cast<int>(at_.size())) {
        at_.resize(point.pixel + 1, nullptr);
      }
      at_[point.pixel] = &point;
    }
  }

  Eigen::Vector3d Of(size_t i) const { return MirroredDirection(points_[i]); }
  // By a pixel to the right, and by one down; 0 where there is no neighbour.
  Eigen::Vector3d Across(size_t i) const { return Turn(points_[i], 1); }
  Eigen::Vector3d Down(size_t i) const { return Turn(points_[i], width_); }

 private:
  const ShadingPoint* At(const ShadingPoint& near, int pixel) const {
    const bool inside = pixel >= 0 && pixel < static_cast<int>(at_.size()) &&
                        std::abs(pixel % width_ - near.pixel % width_) <= 1;
    return inside && at_[pixel] != nullptr ? at_[pixel] : &near;
  }
  Eigen::Vector3d Turn(const ShadingPoint& point, int step) const {
    const ShadingPoint* const before = At(point, point.pixel - step);
    const ShadingPoint* const after = At(point, point.pixel + step);
    const double pixels = (before != &point) + (after != &point);
    return (MirroredDirection(*after) - MirroredDirection(*before)) /
           std::max(pixels, 1.0);
  }

  const std::vector<ShadingPoint>& points_;
  int width_;
  std::vector<const ShadingPoint*> at_;  // by pixel; null: none
};

// Where kSamples of a pixel are farther apart than texels, they would see some
// texels and miss others.
Image AsFineAsSamples(const Image& map, double turn) {
  const double finest = 2.0 * kPi * kSamples / std::max(turn, 1e-6);
  int block = 1;
  while (map.width / (2 * block) >= finest && map.width % (2 * block) == 0 &&
         map.height % (2 * block) == 0) {
    block *= 2;
  }
  return block == 1 ? map
                    : ResizeMap(map, map.height / block, map.width / block);
}

double MedianTurn(const MirroredDirections& directions,
                  const std::vector<size_t>& indices) {
  if (indices.empty()) return 0.0;
  std::vector<double> turns;
  for (const size_t i : indices) turns.push_back(directions.Across(i).norm());
  return UpperMedian(std::move(turns));
}

// Sums of products of differences of neighbours.
struct Moments {
  Eigen::Matrix2d regressors = Eigen::Matrix2d::Zero();  // render, mirror
  Eigen::Vector2d with_residual = Eigen::Vector2d::Zero();
  double residual = 0.0, count = 0.0;
};

}  // namespace

std::vector<double> MirroredLogRadiance(const Image& map,
                                        const std::vector<ShadingPoint>& points,
                                        int image_width,
                                        const std::vector<size_t>& indices) {
  const MirroredDirections directions(points, image_width);
  const Image seen = AsFineAsSamples(map, MedianTurn(directions, indices));
  const double darkest =
      std::max(kDarkestMirrored * MeanRadiance(seen).mean(), 1e-30);
  std::vector<double> out;
  out.reserve(3 * indices.size());
  for (const size_t i : indices) {
    const Eigen::Vector3d middle = directions.Of(i),
                          across = directions.Across(i),
                          down = directions.Down(i);
    Eigen::Array3d sum = Eigen::Array3d::Zero();
    for (int k = 0; k < kSamples * kSamples; ++k) {
      const double x = (k % kSamples + 0.5) / kSamples - 0.5;
      const double y = (k / kSamples + 0.5) / kSamples - 0.5;
      sum += LookUpMap(seen, middle + x * across + y * down);
    }
    for (int c = 0; c < 3; ++c) {
      out.push_back(
          std::log(std::max(sum[c] / (kSamples * kSamples), darkest)));
    }
  }
  return out;
}

double MirroredShare(const Image& map, const std::vector<ShadingPoint>& points,
                     int image_width, const ResidualRows& rows) {
  const std::vector<double> mirrored =
      MirroredLogRadiance(map, points, image_width, rows.indices);
  const double largest = rows.LargestResidual();
  Moments sums;
  for (const auto& [first, second] : PairsInRows(points, rows.indices)) {
    for (size_t c = 0; c < 3; ++c) {
      const size_t here = 3 * first + c, next = 3 * second + c;
      const Eigen::Vector2d x(rows.log_render[next] - rows.log_render[here],
                              mirrored[next] - mirrored[here]);
      const double y = std::clamp(rows.residuals[next], -largest, largest) -
                       std::clamp(rows.residuals[here], -largest, largest);
      sums.regressors += x * x.transpose();
      sums.with_residual += y * x;
      sums.residual += y * y;
      sums.count += 1.0;
    }
  }
  const Eigen::Matrix2d& A = sums.regressors;
  const Eigen::Vector2d& b = sums.with_residual;
  // Even light in a mirror, or the render again, explains nothing more.
  // Rounding makes differences of 1e-7.
  if (!(A(1, 1) > 1e-10 * sums.count) || sums.residual == 0.0 ||
      !(A.determinant() > 1e-9 * A(0, 0) * A(1, 1))) {
    return 0.0;
  }
  const double by_both = b.dot(A.ldlt().solve(b));
  const double by_render = b[0] * b[0] / A(0, 0);
  return std::clamp((by_both - by_render) / sums.residual, 0.0, 1.0);
}

}  // namespace ibrdf
