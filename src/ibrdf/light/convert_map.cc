#include "ibrdf/light/convert_map.h"

#include <glog/logging.h>

#include <algorithm>
#include <cmath>
#include <cstring>
#include <optional>
#include <vector>

#include "ibrdf/base/pi.h"
#include "ibrdf/light/area_average.h"
#include "ibrdf/light/texel_overlaps.h"

namespace ibrdf {
namespace {

// Where the columns of a latlong map are in another frame of the same size:
// column c is column sign c + shift, modulo the width.
struct ColumnMove {
  int sign, shift;
};

std::optional<ColumnMove> WholeColumns(const MapGrid& from, const MapGrid& to) {
  if (!from.latlong().has_value() || !to.latlong().has_value() ||
      from.size() != to.size() || from.latlong()->nodes ||
      to.latlong()->nodes) {
    return std::nullopt;
  }
  // sign_t u_t + q_t / 4 = sign_f u_f + q_f / 4, with u = (c + 1/2) / W.
  const int sign = from.latlong()->sign * to.latlong()->sign;
  const int64_t quarters = from.latlong()->sign *
                           (to.latlong()->quarters - from.latlong()->quarters);
  const int width = to.size().width;
  if (quarters * width % 4 != 0) return std::nullopt;
  const int64_t shift = quarters * width / 4 + (sign < 0 ? -1 : 0);
  return ColumnMove{sign, static_cast<int>((shift % width + width) % width)};
}

Image MoveColumns(const Image& map, const ColumnMove& move) {
  Image out(map.width, map.height);
  for (int r = 0; r < map.height; ++r) {
    for (int c = 0; c < map.width; ++c) {
      const int source = (move.sign * c + move.shift + map.width) % map.width;
      std::memcpy(out.At(c, r), map.At(source, r), 3 * sizeof(float));
    }
  }
  return out;
}

// -cos(theta) at the borders of rows, in [0, 1]: equal steps are equal solid
// angles.
std::vector<double> Heights(const MapGrid& grid) {
  std::vector<double> edges = grid.RowEdges();
  for (double& edge : edges) {
    const double s = std::sin(0.5 * kPi * edge);
    edge = s * s;
  }
  edges.front() = 0.0;
  edges.back() = 1.0;
  return edges;
}

std::vector<std::vector<IntervalPart>> RowParts(const MapGrid& from,
                                                const MapGrid& to) {
  const std::vector<double> edges = Heights(to);
  return PeriodicParts({edges.begin(), edges.end() - 1},
                       {edges.begin() + 1, edges.end()}, Heights(from));
}

std::vector<std::vector<IntervalPart>> ColumnParts(const MapGrid& from,
                                                   const MapGrid& to) {
  const int sign = from.latlong()->sign;
  const double offset =
      0.25 * (to.latlong()->quarters - from.latlong()->quarters);
  std::vector<double> edges = to.ColumnEdges(), low, high;
  for (double& u : edges) u = sign * (to.latlong()->sign * u + offset);
  for (size_t c = 0; c + 1 < edges.size(); ++c) {
    low.push_back(std::min(edges[c], edges[c + 1]));
    high.push_back(std::max(edges[c], edges[c + 1]));
  }
  return PeriodicParts(low, high, from.ColumnEdges());
}

Image ResampleLatLong(const Image& map, const MapGrid& from, const MapGrid& to,
                      int num_threads) {
  return AverageByArea(map, RowParts(from, to), ColumnParts(from, to),
                       num_threads);
}

Image ResampleSphere(const Image& map, const MapGrid& from, const MapGrid& to,
                     int num_threads) {
  const std::vector<double> from_angles = from.SolidAngles();
  const std::vector<double> to_angles = to.SolidAngles();
  std::vector<double> sums(3 * to_angles.size());
  for (const TexelOverlap& o :
       SampledOverlaps(from, from_angles, to, to_angles, num_threads)) {
    for (int k = 0; k < 3; ++k) {
      sums[size_t{3} * o.target + k] += static_cast<double>(o.solid_angle) *
                                        map.rgb[size_t{3} * o.source + k];
    }
  }
  Image out(to.size().width, to.size().height);
  for (size_t i = 0; i < sums.size(); ++i) {
    const double angle = to_angles[i / 3];
    if (angle > 0.0) out.rgb[i] = static_cast<float>(sums[i] / angle);
  }
  return out;
}

}  // namespace

StatusOr<Image> ConvertMap(const std::string& where, const Image& map,
                           MapFrame from, MapFrame to, MapSize size,
                           int num_threads) {
  const MapSize found = {map.width, map.height};
  IBRDF_RETURN_IF_ERROR(CheckMapSize(where, from, found));
  IBRDF_RETURN_IF_ERROR(CheckMapSize(where, to, size));
  if (from == to && found == size) return map;
  const MapGrid source(from, found), target(to, size);
  if (const std::optional<ColumnMove> move = WholeColumns(source, target)) {
    return MoveColumns(map, *move);
  }
  if (source.latlong().has_value() && target.latlong().has_value()) {
    return ResampleLatLong(map, source, target, num_threads);
  }
  return ResampleSphere(map, source, target, num_threads);
}

StatusOr<Image> ToLibraryFrame(const std::string& where, const Image& map,
                               MapFrame from, int num_threads) {
  const MapSize size = {map.width, map.height};
  IBRDF_RETURN_IF_ERROR(CheckMapSize(where, from, size));
  return ConvertMap(where, map, from, kLibraryMapFrame,
                    SizeForRows(kLibraryMapFrame, RowsForSize(from, size)),
                    num_threads);
}

StatusOr<Image> FromLibraryFrame(const std::string& where, const Image& map,
                                 MapFrame to, int num_threads) {
  const int rows = std::max(map.height, (map.width + 1) / 2);
  const MapSize size = SizeForRows(to, rows);
  if (map.width == 2 * map.height) {
    return ConvertMap(where, map, kLibraryMapFrame, to, size, num_threads);
  }
  return ConvertMap(where, ResizeMap(map, rows, 2 * rows), kLibraryMapFrame, to,
                    size, num_threads);
}

Eigen::Array3d TotalRadiance(const Image& map, const MapGrid& grid) {
  CHECK(map.width == grid.size().width && map.height == grid.size().height);
  const std::vector<double> angles = grid.SolidAngles();
  Eigen::Array3d sum = Eigen::Array3d::Zero();
  for (size_t i = 0; i < map.rgb.size(); ++i) {
    sum[i % 3] += angles[i / 3] * map.rgb[i];
  }
  return sum;
}

}  // namespace ibrdf
