#include "ibrdf/light/environment_map.h"

#include <glog/logging.h>

#include <algorithm>
#include <cmath>
#include <vector>

#include "ibrdf/base/fast_atan2.h"
#include "ibrdf/base/pi.h"
#include "ibrdf/light/area_average.h"

namespace ibrdf {
namespace {

// Overlap of the intervals [edges_a[i], edges_a[i+1]] with those of b, as
// (b index, length) lists per interval of a. Both ascending, same ends.
std::vector<std::vector<IntervalPart>> Overlaps(
    const std::vector<double>& target, const std::vector<double>& source) {
  std::vector<std::vector<IntervalPart>> lists(target.size() - 1);
  size_t j = 0;
  for (size_t i = 0; i + 1 < target.size(); ++i) {
    while (j > 0 && source[j] > target[i]) --j;
    while (j + 2 < source.size() && source[j + 1] <= target[i]) ++j;
    for (size_t k = j; k + 1 < source.size() && source[k] < target[i + 1];
         ++k) {
      const double length = std::min(source[k + 1], target[i + 1]) -
                            std::max(source[k], target[i]);
      if (length > 0.0) lists[i].push_back({static_cast<int>(k), length});
    }
  }
  return lists;
}

// -cos(theta) at the row edges: equal steps are equal solid angles.
std::vector<double> RowEdges(int height) {
  std::vector<double> edges(height + 1);
  for (int r = 0; r <= height; ++r) edges[r] = -std::cos(kPi * r / height);
  edges.front() = -1.0;
  edges.back() = 1.0;
  return edges;
}

std::vector<double> ColumnEdges(int width) {
  std::vector<double> edges(width + 1);
  for (int c = 0; c <= width; ++c) edges[c] = static_cast<double>(c) / width;
  return edges;
}
template <typename Atan2>
void PositionBy(const Atan2& atan2, const Eigen::Vector3d& direction,
                int height, int width, double* row, double* column) {
  // atan2 keeps full precision beside the poles, where acos loses half of it.
  const double theta = atan2(
      std::sqrt(direction.x() * direction.x() + direction.z() * direction.z()),
      direction.y());
  double turn = atan2(direction.x(), direction.z()) / (2.0 * kPi);
  if (turn < 0.0) turn += 1.0;
  if (turn >= 1.0) turn = 0.0;
  *row = std::clamp(theta / kPi, 0.0, 1.0) * height;
  *column = turn * width;
  if (*column >= width) *column = 0.0;
}

}  // namespace

Eigen::Vector3d MapDirection(double row, double column, int height, int width) {
  const double theta = kPi * row / height;
  const double phi = 2.0 * kPi * column / width;
  const double s = std::sin(theta);
  return {s * std::sin(phi), std::cos(theta), s * std::cos(phi)};
}

void MapPosition(const Eigen::Vector3d& direction, int height, int width,
                 double* row, double* column) {
  PositionBy([](double y, double x) { return std::atan2(y, x); }, direction,
             height, width, row, column);
}

void FastMapPosition(const Eigen::Vector3d& direction, int height, int width,
                     double* row, double* column) {
  PositionBy([](double y, double x) { return FastAtan2(y, x); }, direction,
             height, width, row, column);
}

double TexelSolidAngle(int row, int height, int width) {
  // cos(a) - cos(b) as a product: exact for thin rows at the poles.
  const double half = kPi / (2.0 * height);
  const double middle = kPi * (row + 0.5) / height;
  return 2.0 * std::sin(middle) * std::sin(half) * (2.0 * kPi / width);
}

MapTaps BilinearTaps(const Eigen::Vector3d& direction, int height, int width) {
  double row = 0.0, column = 0.0;
  MapPosition(direction, height, width, &row, &column);
  const double y = row - 0.5, x = column - 0.5;
  const double y0 = std::floor(y), x0 = std::floor(x);
  const double fy = y - y0, fx = x - x0;
  MapTaps taps;
  for (int corner = 0; corner < 4; ++corner) {
    const int dx = corner & 1, dy = corner >> 1;
    int r = static_cast<int>(y0) + dy;
    int c = static_cast<int>(x0) + dx;
    if (r < 0 || r >= height) {  // across the pole
      r = std::clamp(r, 0, height - 1);
      c += width / 2;
    }
    c = (c % width + width) % width;
    taps.texel[corner] = r * width + c;
    taps.weight[corner] = (dx ? fx : 1.0 - fx) * (dy ? fy : 1.0 - fy);
  }
  return taps;
}

Eigen::Array3d LookUpMap(const Image& map, const Eigen::Vector3d& direction) {
  const MapTaps taps = BilinearTaps(direction, map.height, map.width);
  Eigen::Array3d sum = Eigen::Array3d::Zero();
  for (int k = 0; k < 4; ++k) {
    const float* texel = map.rgb.data() + size_t{3} * taps.texel[k];
    for (int c = 0; c < 3; ++c) sum[c] += taps.weight[k] * texel[c];
  }
  return sum;
}

Image ResizeMap(const Image& map, int height, int width) {
  CHECK(!map.empty() && height > 0 && width > 0);
  const std::vector<std::vector<IntervalPart>> rows =
      Overlaps(RowEdges(height), RowEdges(map.height));
  const std::vector<std::vector<IntervalPart>> columns =
      Overlaps(ColumnEdges(width), ColumnEdges(map.width));
  return AverageByArea(map, rows, columns, 1);
}

std::vector<float> ResamplePlanes(const std::vector<float>& planes,
                                  MapSize from, MapSize to) {
  const size_t before = from.num_texels(), texels = to.num_texels();
  CHECK(before > 0 && planes.size() % before == 0);
  const size_t channels = planes.size() / before;
  std::vector<float> out(channels * texels);
  for (size_t t = 0; t < texels; ++t) {
    const MapTaps taps =
        BilinearTaps(MapDirection(static_cast<double>(t / to.width) + 0.5,
                                  static_cast<double>(t % to.width) + 0.5,
                                  to.height, to.width),
                     from.height, from.width);
    for (size_t c = 0; c < channels; ++c) {
      double sum = 0.0;
      for (int k = 0; k < 4; ++k) {
        sum += taps.weight[k] * planes[c * before + taps.texel[k]];
      }
      out[c * texels + t] = static_cast<float>(sum);
    }
  }
  return out;
}

Eigen::Array3d MeanRadiance(const Image& map) {
  Eigen::Array3d sum = Eigen::Array3d::Zero();
  for (int r = 0; r < map.height; ++r) {
    Eigen::Array3d row_sum = Eigen::Array3d::Zero();
    for (int c = 0; c < map.width; ++c) {
      for (int k = 0; k < 3; ++k) row_sum[k] += map.At(c, r)[k];
    }
    sum += TexelSolidAngle(r, map.height, map.width) * row_sum;
  }
  return sum / (4.0 * kPi);
}

}  // namespace ibrdf
