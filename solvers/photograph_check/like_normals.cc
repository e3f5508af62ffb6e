#include "ibrdf/solvers/photograph_check/like_normals.h"

#include <Eigen/Core>
#include <Eigen/Eigenvalues>
#include <Eigen/Geometry>
#include <algorithm>
#include <cmath>
#include <cstddef>
#include <limits>
#include <map>

namespace ibrdf {
namespace {
using Iterator = std::vector<NormalSample>::iterator;

constexpr std::ptrdiff_t kMostOfCell = 12;
// Normals closer than this are the same: no slope can be told.
constexpr double kSameNormals = 1e-5;

class Cells {
 public:
  Cells(const std::vector<NormalSample>& samples, std::ptrdiff_t most,
        LikeNormalsSpread* spread)
      : samples_(static_cast<double>(samples.size())),
        size_(ObjectSize(samples)),
        most_(most),
        spread_(spread) {}

  // Halves by the median of the wider axis until a cell is small enough.
  void Divide(Iterator begin, Iterator end) {
    if (end - begin <= most_) {
      AddCell(begin, end);
      return;
    }
    Eigen::Vector2d low = begin->normal, high = begin->normal;
    for (Iterator s = begin; s != end; ++s) {
      low = low.cwiseMin(s->normal);
      high = high.cwiseMax(s->normal);
    }
    const int axis = high.x() - low.x() >= high.y() - low.y() ? 0 : 1;
    const Iterator middle = begin + (end - begin) / 2;
    std::nth_element(begin, middle, end,
                     [&](const NormalSample& a, const NormalSample& b) {
                       return a.normal[axis] != b.normal[axis]
                                  ? a.normal[axis] < b.normal[axis]
                                  : a.point < b.point;
                     });
    Divide(begin, middle);
    Divide(middle, end);
  }

  void Finish() {
    const auto count = static_cast<double>(spread_->pixels);
    if (spread_->pixels == 0) return;
    spread_->log_radiance = sum_radiance_ / count;
    spread_->log_colour = sum_colour_ / count;
    spread_->share = count / samples_;
  }

 private:
  // Whether the cell's pixels lie at different places.
  bool HasPlaces(Iterator begin, Iterator end) const {
    Eigen::Vector2d low = begin->position, high = begin->position;
    for (Iterator s = begin; s != end; ++s) {
      low = low.cwiseMin(s->position);
      high = high.cwiseMax(s->position);
    }
    return (high - low).norm() >= kOtherPlace * size_;
  }

  void AddCell(Iterator begin, Iterator end) {
    const auto count = static_cast<int>(end - begin);
    Eigen::Vector2d mean = Eigen::Vector2d::Zero();
    Eigen::Array3d mean_log = Eigen::Array3d::Zero();
    for (Iterator s = begin; s != end; ++s) {
      mean += s->normal / count;
      mean_log += s->log_radiance / count;
    }
    Eigen::Matrix2d moments = Eigen::Matrix2d::Zero();
    Eigen::Matrix<double, 2, 3> products = Eigen::Matrix<double, 2, 3>::Zero();
    for (Iterator s = begin; s != end; ++s) {
      const Eigen::Vector2d n = s->normal - mean;
      moments += n * n.transpose();
      products += n * (s->log_radiance - mean_log).matrix().transpose();
    }
    // Least squares in the directions in which the normals differ.
    const Eigen::SelfAdjointEigenSolver<Eigen::Matrix2d> solver(moments);
    Eigen::Matrix<double, 2, 3> slope = Eigen::Matrix<double, 2, 3>::Zero();
    int freedom = count - 1;
    for (int k = 0; k < 2; ++k) {
      const double value = solver.eigenvalues()[k];
      if (value <= count * kSameNormals * kSameNormals) continue;
      const Eigen::Vector2d axis = solver.eigenvectors().col(k);
      slope += axis * (axis.transpose() * products) / value;
      --freedom;
    }
    if (freedom <= 0) return;
    const bool places = HasPlaces(begin, end);
    const double scale = std::sqrt(count / static_cast<double>(freedom));
    for (Iterator s = begin; s != end; ++s) {
      const Eigen::Array3d r =
          scale * (s->log_radiance - mean_log -
                   (slope.transpose() * (s->normal - mean)).array());
      const Eigen::Vector2d colour(r[0] - r[1], r[2] - r[1]);
      spread_->colour_of_point[s->point] = static_cast<float>(colour.norm());
      if (!places) continue;
      sum_radiance_ += r.abs().mean();
      sum_colour_ += colour.cwiseAbs().mean();
      ++spread_->pixels;
    }
  }

  double samples_, size_;
  std::ptrdiff_t most_;  // samples of a cell
  LikeNormalsSpread* spread_;
  double sum_radiance_ = 0.0, sum_colour_ = 0.0;
};

LikeNormalsSpread SpreadInCells(std::vector<NormalSample> samples,
                                size_t points, std::ptrdiff_t most) {
  LikeNormalsSpread spread;
  spread.colour_of_point.assign(points,
                                std::numeric_limits<float>::quiet_NaN());
  if (samples.empty()) return spread;
  Cells cells(samples, most, &spread);
  // Like normals of two views do not reflect like light.
  for (Iterator begin = samples.begin(); begin != samples.end();) {
    const Iterator end = std::stable_partition(
        begin, samples.end(),
        [view = begin->view](const NormalSample& s) { return s.view == view; });
    cells.Divide(begin, end);
    begin = end;
  }
  cells.Finish();
  return spread;
}

// The deviation in cells of no extent, from that in cells and in cells twice as
// large: what differs between places is the same in both, and the variance of
// what changes with the normal at least doubles.
double AtNoExtent(double cells, double twice) {
  return std::sqrt(std::max(2.0 * cells * cells - twice * twice, 0.0));
}

// The largest angle between a point's direction to the viewer and that of the
// first point of its view.
double ViewAngle(const std::vector<ShadingPoint>& points) {
  std::map<int, Eigen::Vector3d> first;  // by view
  double angle = 0.0;
  for (const ShadingPoint& point : points) {
    const Eigen::Vector3d wo = point.wo.cast<double>();
    const Eigen::Vector3d& other = first.emplace(point.view, wo).first->second;
    angle = std::max(angle, std::atan2(wo.cross(other).norm(), wo.dot(other)));
  }
  return angle;
}

}  // namespace

LikeNormalsSpread SpreadOfLikeNormals(const std::vector<NormalSample>& samples,
                                      const std::vector<ShadingPoint>& points) {
  LikeNormalsSpread spread = SpreadInCells(samples, points.size(), kMostOfCell);
  const LikeNormalsSpread twice =
      SpreadInCells(samples, points.size(), 2 * kMostOfCell);
  spread.view_angle = ViewAngle(points);
  spread.log_radiance = std::min(
      spread.log_radiance, AtNoExtent(spread.log_radiance, twice.log_radiance));
  spread.log_colour = std::min(spread.log_colour,
                               AtNoExtent(spread.log_colour, twice.log_colour));
  return spread;
}

}  // namespace ibrdf
