#include "ibrdf/solvers/photograph_check/colour_spread.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <utility>

#include "ibrdf/base/median.h"
#include "ibrdf/base/pi.h"
#include "ibrdf/solvers/photograph_check/like_normals.h"

namespace ibrdf {
namespace {

const double kCellWidth = std::sin(2.0 * kPi / 180.0);
// A share of the object's size, the square root of its pixels.
constexpr double kNear = 0.03;
constexpr double kLeastFar = 4.0, kLeastNear = 1.5;  // pixels
constexpr size_t kFewestPairs = 100;
constexpr double kLeastShare = 0.02;
// Most that shares of bounced light deviate from pixel to pixel.
constexpr double kBounced = 0.25;
// Standard deviation over mean absolute deviation of normal errors, and of one
// pixel over that of a difference of two.
const double kDeviation = std::sqrt(kPi / 2.0) / std::sqrt(2.0);

Eigen::Vector2d MedianColour(const std::vector<NormalSample>& samples) {
  std::vector<double> red, blue;
  for (const NormalSample& sample : samples) {
    red.push_back(sample.LogColour().x());
    blue.push_back(sample.LogColour().y());
  }
  return {UpperMedian(std::move(red)), UpperMedian(std::move(blue))};
}

// Mean |difference| of pairs across and along a direction.
class MeanDifference {
 public:
  explicit MeanDifference(const Eigen::Vector2d& own)
      : along_(own.norm() > 0.0 ? Eigen::Vector2d(own.normalized())
                                : Eigen::Vector2d::UnitX()) {}

  void Add(const Eigen::Vector2d& difference) {
    sum_along_ += std::abs(along_.dot(difference));
    sum_across_ +=
        std::abs(along_.x() * difference.y() - along_.y() * difference.x());
    ++count_;
  }
  size_t count() const { return count_; }
  ColourDeviation Deviation() const {
    if (count_ == 0) return {};
    const double scale = kDeviation / static_cast<double>(count_);
    return {scale * sum_across_, scale * sum_along_};
  }

 private:
  Eigen::Vector2d along_;
  double sum_across_ = 0.0, sum_along_ = 0.0;
  size_t count_ = 0;
};

double Beyond(double far, double near) {
  return std::sqrt(std::max(far * far - near * near, 0.0));
}

// Samples by view and cell of the disc of normals, in image order within each;
// cells are consecutive.
std::vector<std::pair<int, size_t>> SortIntoCells(
    const std::vector<NormalSample>& samples) {
  const int across = static_cast<int>(2.0 / kCellWidth) + 1;
  const auto index = [&](double x) {
    return std::clamp(static_cast<int>((x + 1.0) / kCellWidth), 0, across - 1);
  };
  std::vector<std::pair<int, size_t>> cells;
  cells.reserve(samples.size());
  for (size_t i = 0; i < samples.size(); ++i) {
    const Eigen::Vector2d& n = samples[i].normal;
    const int row = samples[i].view * across + index(n.y());
    cells.emplace_back(row * across + index(n.x()), i);
  }
  std::sort(cells.begin(), cells.end());
  return cells;
}

// Calls pair(i, j) for some pairs of samples of one cell: neighbours in its
// list, which runs in image order, and what is far from them there.
template <typename Function>
void ForEachLikePair(const std::vector<NormalSample>& samples, Function pair) {
  const std::vector<std::pair<int, size_t>> cells = SortIntoCells(samples);
  for (size_t begin = 0; begin < cells.size();) {
    size_t end = begin;
    while (end < cells.size() && cells[end].first == cells[begin].first) ++end;
    const size_t count = end - begin;
    for (const size_t step :
         {size_t{1}, size_t{2}, count / 5, count / 3, count / 2}) {
      if (step == 0 || step >= count) continue;
      for (size_t k = 0; k < count; ++k) {
        pair(cells[begin + k].second, cells[begin + (k + step) % count].second);
      }
    }
    begin = end;
  }
}

}  // namespace

ColourSpread SpreadOfColours(const std::vector<NormalSample>& samples) {
  ColourSpread spread;
  if (samples.empty()) return spread;
  spread.own = MedianColour(samples);
  const double size = ObjectSize(samples);
  const double far_from = std::max(kOtherPlace * size, kLeastFar);
  const double near_to = std::max(kNear * size, kLeastNear);
  MeanDifference far(spread.own), near(spread.own);
  std::vector<bool> has_far(samples.size(), false);
  ForEachLikePair(samples, [&](size_t i, size_t j) {
    const double distance = (samples[i].position - samples[j].position).norm();
    const Eigen::Vector2d difference =
        samples[i].LogColour() - samples[j].LogColour();
    if (distance >= far_from) {
      far.Add(difference);
      has_far[i] = has_far[j] = true;
    } else if (distance <= near_to) {
      near.Add(difference);
    }
  });
  spread.pairs = far.count();
  spread.share =
      static_cast<double>(std::count(has_far.begin(), has_far.end(), true)) /
      static_cast<double>(samples.size());
  spread.far = far.Deviation();
  spread.near = near.Deviation();
  spread.excess = std::max(Beyond(spread.far.across, spread.near.across),
                           Beyond(spread.far.along, spread.near.along) -
                               kBounced * spread.own.norm());
  spread.excess = std::max(spread.excess, 0.0);
  spread.observable = far.count() >= kFewestPairs &&
                      near.count() >= kFewestPairs &&
                      spread.share >= kLeastShare;
  return spread;
}

bool SaysSeveralMaterials(const ColourSpread& spread) {
  return spread.observable && spread.excess > kSeveralMaterials;
}

}  // namespace ibrdf
