#include "ibrdf/solvers/report/sphere_lookup.h"

#include <glog/logging.h>

#include <algorithm>
#include <cmath>

#include "ibrdf/solvers/photograph_check/normal_samples.h"

namespace ibrdf {

SphereLookup::SphereLookup(const Image& sphere) : sphere_(sphere) {
  CHECK_GT(sphere.width, 2);
  CHECK_EQ(sphere.width, sphere.height);
}

bool SphereLookup::Shows(int column, int row) const {
  if (column < 0 || row < 0 || column >= sphere_.width ||
      row >= sphere_.height) {
    return false;
  }
  const double u = 2.0 * (column + 0.5) / sphere_.width - 1.0;
  const double v = 2.0 * (row + 0.5) / sphere_.height - 1.0;
  return u * u + v * v < 1.0;
}

Eigen::Array3f SphereLookup::At(double right, double up) const {
  const int size = sphere_.width;
  // Pixels within a pixel and a half of the edge have corners outside.
  const double length = std::hypot(right, up);
  const double inside = 1.0 - 3.0 / size;
  for (double reach = 1.0;; reach = std::min(inside, 0.99 * reach)) {
    const double shrink = length > reach ? reach / length : 1.0;
    const double x = 0.5 * size * (1.0 + shrink * right) - 0.5;
    const double y = 0.5 * size * (1.0 - shrink * up) - 0.5;
    const int column = static_cast<int>(std::floor(x));
    const int row = static_cast<int>(std::floor(y));
    Eigen::Array3f sum = Eigen::Array3f::Zero();
    double weights = 0.0;
    for (int j = 0; j < 2; ++j) {
      for (int i = 0; i < 2; ++i) {
        if (!Shows(column + i, row + j)) continue;
        const double weight =
            (1.0 - std::fabs(x - column - i)) * (1.0 - std::fabs(y - row - j));
        sum +=
            static_cast<float>(weight) *
            Eigen::Map<const Eigen::Array3f>(sphere_.At(column + i, row + j));
        weights += weight;
      }
    }
    if (weights > 1e-6) return sum / static_cast<float>(weights);
  }
}

Image ResizeSphere(const Image& sphere, int size) {
  const SphereLookup lookup(sphere);
  Image out(size, size);
  for (int y = 0; y < size; ++y) {
    for (int x = 0; x < size; ++x) {
      const double right = 2.0 * (x + 0.5) / size - 1.0;
      const double up = 1.0 - 2.0 * (y + 0.5) / size;
      if (right * right + up * up >= 1.0) continue;
      Eigen::Map<Eigen::Array3f>(out.At(x, y)) = lookup.At(right, up);
    }
  }
  return out;
}

Image RelitObject(const Image& sphere, const std::vector<ShadingPoint>& points,
                  int width, int height) {
  const SphereLookup lookup(sphere);
  Image out(width, height);
  for (const ShadingPoint& point : points) {
    const Eigen::Vector3d n = NormalToViewer(point);
    const double length = std::max(std::hypot(n.x(), n.y()), 1.0);
    Eigen::Map<Eigen::Array3f>(&out.rgb[size_t{3} * point.pixel]) =
        lookup.At(n.x() / length, n.y() / length);
  }
  return out;
}

}  // namespace ibrdf
