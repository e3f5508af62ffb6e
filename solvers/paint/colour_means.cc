#include "ibrdf/solvers/paint/colour_means.h"

#include <algorithm>
#include <cmath>
#include <numeric>

namespace ibrdf {
namespace {

// Cells are this wide, in lengths; the kernel reaches so many.
constexpr double kCellWidth = 0.5;
constexpr int kReach = 6;
constexpr int kLuminanceBins = 64;

double Kernel(int x, int y) {
  return std::exp(-0.5 * kCellWidth * kCellWidth * (x * x + y * y));
}

// The sums of a column's bins, with their neighbours'.
Eigen::ArrayXd Blurred(const Eigen::ArrayXd& bins) {
  if (bins.size() == 1) return bins;
  Eigen::ArrayXd out = Eigen::ArrayXd::Zero(bins.size());
  for (int d = -kReach; d <= kReach; ++d) {
    const Eigen::Index from = std::max(d, 0), shift = -d;
    const Eigen::Index count = bins.size() - std::abs(d);
    out.segment(from, count) +=
        Kernel(d, 0) * bins.segment(from + shift, count);
  }
  return out;
}

// Cells of luminance [points] about its mean.
std::vector<int> BinsOf(const std::vector<double>& luminance, double length) {
  const double count = std::max(static_cast<double>(luminance.size()), 1.0);
  const double mean =
      std::accumulate(luminance.begin(), luminance.end(), 0.0) / count;
  std::vector<int> bins;
  bins.reserve(luminance.size());
  for (const double v : luminance) {
    const double cell = std::floor((v - mean) / (kCellWidth * length));
    constexpr double kHalf = kLuminanceBins / 2;
    bins.push_back(
        static_cast<int>(std::clamp(cell + kHalf, 0.0, 2.0 * kHalf - 1.0)));
  }
  return bins;
}

}  // namespace

ColourMeans::ColourMeans(std::vector<Eigen::Array2d> chroma, double length) {
  const double width = kCellWidth * length;
  cells_.reserve(chroma.size());
  for (const Eigen::Array2d& c : chroma) {
    cells_.emplace_back(static_cast<int>(std::floor(c[0] / width)),
                        static_cast<int>(std::floor(c[1] / width)));
  }
}

std::vector<double> ColourMeans::OfLikeChroma(
    const std::vector<double>& values,
    const std::vector<double>& weights) const {
  return Of(values, weights, std::vector<int>(cells_.size(), 0), 1);
}

std::vector<double> ColourMeans::OfLikeColour(
    const std::vector<double>& values, const std::vector<double>& weights,
    const std::vector<double>& luminance, double luminance_length) const {
  return Of(values, weights, BinsOf(luminance, luminance_length),
            kLuminanceBins);
}

std::vector<double> ColourMeans::Of(const std::vector<double>& values,
                                    const std::vector<double>& weights,
                                    const std::vector<int>& bins,
                                    int num_bins) const {
  std::map<Cell, Column> columns;
  for (size_t i = 0; i < cells_.size(); ++i) {
    Column& column = columns[cells_[i]];
    if (column.weights.size() == 0) {
      column.weights = column.values = Eigen::ArrayXd::Zero(num_bins);
    }
    column.weights[bins[i]] += weights[i];
    column.values[bins[i]] += weights[i] * values[i];
  }
  for (auto& [cell, column] : columns) {
    column.weights = Blurred(column.weights);
    column.values = Blurred(column.values);
  }
  std::map<Cell, Column> near;
  std::vector<double> means(cells_.size());
  for (size_t i = 0; i < cells_.size(); ++i) {
    auto known = near.find(cells_[i]);
    if (known == near.end()) {
      known = near.emplace(cells_[i], Near(columns, cells_[i])).first;
    }
    const double weight = known->second.weights[bins[i]];
    means[i] = weight > 0.0 ? known->second.values[bins[i]] / weight : 0.0;
  }
  return means;
}

ColourMeans::Column ColourMeans::Near(const std::map<Cell, Column>& columns,
                                      const Cell& at) {
  const Eigen::Index num_bins = columns.begin()->second.weights.size();
  Column out = {Eigen::ArrayXd::Zero(num_bins), Eigen::ArrayXd::Zero(num_bins)};
  for (int x = -kReach; x <= kReach; ++x) {
    for (int y = -kReach; y <= kReach; ++y) {
      const auto other = columns.find({at.first + x, at.second + y});
      if (other == columns.end()) continue;
      out.weights += Kernel(x, y) * other->second.weights;
      out.values += Kernel(x, y) * other->second.values;
    }
  }
  return out;
}

}  // namespace ibrdf
