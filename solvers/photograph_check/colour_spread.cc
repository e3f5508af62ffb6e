#include "ibrdf/solvers/photograph_check/colour_spread.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <utility>

#include "ibrdf/base/pi.h"
#include "ibrdf/solvers/photograph_check/like_normals.h"

namespace ibrdf {
namespace {

const double kCellWidth = std::sin(2.0 * kPi / 180.0);
// Of the object's size, the square root of its pixels.
constexpr double kNear = 0.03;
constexpr double kLeastFar = 4.0, kLeastNear = 1.5;  // pixels
constexpr size_t kFewestPairs = 100;
constexpr double kLeastShare = 0.02;
// Below it the object is grey, and bounces do not move its colour.
constexpr double kGrey = 0.05;
// Standard deviation over mean absolute deviation of normal errors, and of one
// pixel over that of a difference of two.
const double kDeviation = std::sqrt(kPi / 2.0) / std::sqrt(2.0);

double Median(std::vector<double> values) {
  const auto middle = values.begin() + static_cast<long>(values.size() / 2);
  std::nth_element(values.begin(), middle, values.end());
  return *middle;
}

Eigen::Vector2d MedianColour(const std::vector<NormalSample>& samples) {
  std::vector<double> red, blue;
  for (const NormalSample& sample : samples) {
    red.push_back(sample.LogColour().x());
    blue.push_back(sample.LogColour().y());
  }
  return {Median(std::move(red)), Median(std::move(blue))};
}

// Mean |difference| of pairs across a direction, or, of grey objects, along
// both axes.
class MeanDifference {
 public:
  explicit MeanDifference(const Eigen::Vector2d& own)
      : grey_(own.norm() < kGrey), across_(-own.y(), own.x()) {
    if (!grey_) across_.normalize();
  }

  void Add(const Eigen::Vector2d& difference) {
    sum_ += grey_ ? difference.cwiseAbs().mean()
                  : std::abs(across_.dot(difference));
    ++count_;
  }
  size_t count() const { return count_; }
  double Deviation() const {
    return count_ == 0 ? 0.0 : kDeviation * sum_ / static_cast<double>(count_);
  }

 private:
  bool grey_;
  Eigen::Vector2d across_;
  double sum_ = 0.0;
  size_t count_ = 0;
};

// Samples by cell of the disc of normals, in image order within each; cells are
// consecutive.
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
    cells.emplace_back(index(n.y()) * across + index(n.x()), i);
  }
  std::sort(cells.begin(), cells.end());
  return cells;
}

}  // namespace

ColourSpread SpreadOfColours(const std::vector<NormalSample>& samples) {
  ColourSpread spread;
  if (samples.empty()) return spread;
  spread.own = MedianColour(samples);
  const double size = std::sqrt(static_cast<double>(samples.size()));
  const double far_from = std::max(kOtherPlace * size, kLeastFar);
  const double near_to = std::max(kNear * size, kLeastNear);
  MeanDifference far(spread.own), near(spread.own);
  std::vector<bool> has_far(samples.size(), false);
  const std::vector<std::pair<int, size_t>> cells = SortIntoCells(samples);
  for (size_t begin = 0; begin < cells.size();) {
    size_t end = begin;
    while (end < cells.size() && cells[end].first == cells[begin].first) ++end;
    const size_t count = end - begin;
    // Steps in the cell's list, which runs in image order: neighbours, and what
    // is far from them.
    for (const size_t step :
         {size_t{1}, size_t{2}, count / 5, count / 3, count / 2}) {
      if (step == 0 || step >= count) continue;
      for (size_t k = 0; k < count; ++k) {
        const size_t i = cells[begin + k].second;
        const size_t j = cells[begin + (k + step) % count].second;
        const double distance =
            (samples[i].position - samples[j].position).norm();
        const Eigen::Vector2d difference =
            samples[i].LogColour() - samples[j].LogColour();
        if (distance >= far_from) {
          far.Add(difference);
          has_far[i] = has_far[j] = true;
        } else if (distance <= near_to) {
          near.Add(difference);
        }
      }
    }
    begin = end;
  }
  spread.pairs = far.count();
  spread.share =
      static_cast<double>(std::count(has_far.begin(), has_far.end(), true)) /
      static_cast<double>(samples.size());
  spread.far = far.Deviation();
  spread.near = near.Deviation();
  spread.excess = std::sqrt(
      std::max(spread.far * spread.far - spread.near * spread.near, 0.0));
  spread.observable = far.count() >= kFewestPairs &&
                      near.count() >= kFewestPairs &&
                      spread.share >= kLeastShare;
  return spread;
}

bool SaysSeveralMaterials(const ColourSpread& spread) {
  return spread.observable && spread.excess > kSeveralMaterials;
}

}  // namespace ibrdf
