#include "ibrdf/surface/charts.h"

#include <glog/logging.h>

#include <Eigen/Geometry>
#include <algorithm>
#include <cmath>
#include <cstdint>
#include <map>
#include <unordered_set>
#include <utility>
#include <vector>

#include "ibrdf/surface/plane.h"

namespace ibrdf {
namespace {

// Between charts, of the picture's side.
constexpr double kGap = 1.0 / 256.0;
// Cells along a side of a square of the mesh's area, in which charts are
// looked at for overlaps: texels of an atlas of that size.
constexpr double kCells = 1024.0;

using Point = Eigen::Vector2d;
using Corners = std::array<Point, 3>;

// The axis nearest to a direction, 0 to 5: +x, -x, +y, -y, +z, -z.
int NearestAxis(const Eigen::Vector3d& n) {
  int axis = 0;
  n.cwiseAbs().maxCoeff(&axis);
  return 2 * axis + (n[axis] < 0.0 ? 1 : 0);
}

// Seen along the axis from outside.
Point Seen(const Eigen::Vector3f& p, int axis) {
  const int k = axis / 2;
  const double u = p[(k + 1) % 3], v = p[(k + 2) % 3];
  return axis % 2 == 0 ? Point(u, v) : Point(-u, v);
}

// Cells of a plane whose centres charts cover.
class CoveredCells {
 public:
  explicit CoveredCells(double side) : side_(side) {}

  // Covers the triangle's, or none where one is covered already.
  bool Cover(const Corners& t) {
    cells_.clear();
    Point low = t[0], high = t[0];
    for (const Point& p : t) {
      low = low.cwiseMin(p);
      high = high.cwiseMax(p);
    }
    for (int64_t j = CellOf(low.y()); j <= CellOf(high.y()); ++j) {
      for (int64_t i = CellOf(low.x()); i <= CellOf(high.x()); ++i) {
        const Point centre((static_cast<double>(i) + 0.5) * side_,
                           (static_cast<double>(j) + 0.5) * side_);
        if (!Holds(t, centre)) continue;
        const int64_t key = i * (int64_t{1} << 32) + j;
        if (covered_.count(key) > 0) return false;
        cells_.push_back(key);
      }
    }
    covered_.insert(cells_.begin(), cells_.end());
    return true;
  }

 private:
  int64_t CellOf(double x) const {
    return static_cast<int64_t>(std::floor(x / side_));
  }

  // Strictly inside: neighbours that share an edge cover no cell twice.
  static bool Holds(const Corners& t, const Point& p) {
    bool left = true, right = true;
    for (int k = 0; k < 3; ++k) {
      const double side = Cross(t[(k + 1) % 3] - t[k], p - t[k]);
      left = left && side > 0.0;
      right = right && side < 0.0;
    }
    return left || right;
  }

  const double side_;
  std::unordered_set<int64_t> covered_;
  std::vector<int64_t> cells_;
};

// Triangles beside each triangle, across its three edges; more where more share
// an edge.
std::vector<std::vector<int>> Neighbours(const TriangleMesh& mesh) {
  std::map<std::pair<int, int>, std::vector<int>> at_edge;
  const int count = static_cast<int>(mesh.triangles.size());
  for (int t = 0; t < count; ++t) {
    for (int k = 0; k < 3; ++k) {
      const int a = mesh.triangles[t][k], b = mesh.triangles[t][(k + 1) % 3];
      at_edge[std::minmax(a, b)].push_back(t);
    }
  }
  std::vector<std::vector<int>> beside(mesh.triangles.size());
  for (const auto& [edge, triangles] : at_edge) {
    for (const int t : triangles) {
      for (const int other : triangles) {
        if (other != t) beside[t].push_back(other);
      }
    }
  }
  return beside;
}

struct Chart {
  std::vector<int> triangles;
  Point low, high;  // bounds in the plane
  Point place;      // of `low` in the picture
};

class ChartMaker {
 public:
  explicit ChartMaker(TriangleMesh* mesh)
      : mesh_(*mesh), seen_(mesh->triangles.size()) {
    double area = 0.0;
    for (size_t t = 0; t < seen_.size(); ++t) {
      const Eigen::Vector3d n = Normal(t);
      area += 0.5 * n.norm();
      axis_.push_back(NearestAxis(n));
      for (int k = 0; k < 3; ++k) {
        seen_[t][k] = Seen(mesh_.vertices[mesh_.triangles[t][k]], axis_[t]);
      }
    }
    side_ = std::sqrt(area);
  }

  // Takes triangles of one axis from neighbour to neighbour; what would overlap
  // is left for another chart.
  std::vector<Chart> Grow() const {
    const std::vector<std::vector<int>> beside = Neighbours(mesh_);
    std::vector<Chart> charts;
    std::vector<bool> taken(seen_.size(), false);
    for (size_t first = 0; first < seen_.size(); ++first) {
      if (taken[first]) continue;
      charts.emplace_back();
      CoveredCells covered(side_ > 0.0 ? side_ / kCells : 1.0);
      std::vector<int> front = {static_cast<int>(first)};
      for (size_t next = 0; next < front.size(); ++next) {
        const int t = front[next];
        if (taken[t] || !covered.Cover(seen_[t])) continue;
        taken[t] = true;
        charts.back().triangles.push_back(t);
        for (const int other : beside[t]) {
          if (!taken[other] && axis_[other] == axis_[first]) {
            front.push_back(other);
          }
        }
      }
      SetBounds(&charts.back());
    }
    return charts;
  }

  // The largest scale at which the charts fit into the picture, side by side in
  // rows, the highest first.
  double Pack(std::vector<Chart>* charts) const {
    std::stable_sort(charts->begin(), charts->end(),
                     [](const Chart& a, const Chart& b) {
                       return a.high.y() - a.low.y() > b.high.y() - b.low.y();
                     });
    // Many small charts need more room for gaps than there is.
    double gap = kGap;
    while (static_cast<double>(charts->size()) * gap * gap > 0.25) gap *= 0.5;
    double low = 0.0, high = side_ > 0.0 ? 2.0 / side_ : 1.0;
    constexpr int kHalvings = 40;
    for (int i = 0; i < kHalvings; ++i) {
      const double scale = 0.5 * (low + high);
      (PlaceAt(scale, gap, charts) ? low : high) = scale;
    }
    CHECK(PlaceAt(low, gap, charts));
    return low;
  }

  void Write(const std::vector<Chart>& charts, double scale,
             TriangleMesh* mesh) const {
    mesh->texture.resize(seen_.size());
    for (const Chart& chart : charts) {
      for (const int t : chart.triangles) {
        for (int k = 0; k < 3; ++k) {
          const Point uv = chart.place + scale * (seen_[t][k] - chart.low);
          mesh->texture[t][k] = uv.cast<float>();
        }
      }
    }
  }

 private:
  // Twice the area long.
  Eigen::Vector3d Normal(size_t t) const {
    Eigen::Vector3d p[3];
    for (int k = 0; k < 3; ++k) {
      p[k] = mesh_.vertices[mesh_.triangles[t][k]].cast<double>();
    }
    return (p[1] - p[0]).cross(p[2] - p[0]);
  }

  void SetBounds(Chart* chart) const {
    chart->low = chart->high = seen_[chart->triangles[0]][0];
    for (const int t : chart->triangles) {
      for (const Point& p : seen_[t]) {
        chart->low = chart->low.cwiseMin(p);
        chart->high = chart->high.cwiseMax(p);
      }
    }
  }

  static bool PlaceAt(double scale, double gap, std::vector<Chart>* charts) {
    double x = gap, y = gap, row = 0.0;
    for (Chart& chart : *charts) {
      const Point size = scale * (chart.high - chart.low);
      if (x + size.x() + gap > 1.0) {
        x = gap;
        y += row + gap;
        row = 0.0;
      }
      if (x + size.x() + gap > 1.0 || y + size.y() + gap > 1.0) return false;
      chart.place = Point(x, y);
      x += size.x() + gap;
      row = std::max(row, size.y());
    }
    return true;
  }

  const TriangleMesh& mesh_;
  std::vector<int> axis_;      // of each triangle
  std::vector<Corners> seen_;  // along it
  double side_ = 0.0;          // of a square of the mesh's area
};

}  // namespace

void AddCharts(TriangleMesh* mesh) {
  const ChartMaker maker(mesh);
  std::vector<Chart> charts = maker.Grow();
  const double scale = maker.Pack(&charts);
  maker.Write(charts, scale, mesh);
}

int CountCharts(const TriangleMesh& mesh) {
  const std::vector<std::vector<int>> beside = Neighbours(mesh);
  const auto meet = [&](int t, int other) {
    int shared = 0;
    for (int k = 0; k < 3; ++k) {
      for (int j = 0; j < 3; ++j) {
        shared += mesh.triangles[t][k] == mesh.triangles[other][j] &&
                  mesh.texture[t][k] == mesh.texture[other][j];
      }
    }
    return shared >= 2;
  };
  std::vector<bool> reached(mesh.triangles.size(), false);
  int count = 0;
  for (size_t first = 0; first < reached.size(); ++first) {
    if (reached[first]) continue;
    ++count;
    std::vector<int> front = {static_cast<int>(first)};
    reached[first] = true;
    while (!front.empty()) {
      const int t = front.back();
      front.pop_back();
      for (const int other : beside[t]) {
        if (reached[other] || !meet(t, other)) continue;
        reached[other] = true;
        front.push_back(other);
      }
    }
  }
  return count;
}

}  // namespace ibrdf
