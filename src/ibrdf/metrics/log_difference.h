// Sums of log differences, shared by the metrics.
#pragma once
#include <array>
#include <cmath>
#include <cstddef>
#include <vector>

namespace ibrdf {

// The floor of maps and images, over the largest value of the reference.
inline constexpr double kRelativeFloor = 1e-6;

// log(max(estimate, 0) + floor) - log(max(reference, 0) + floor), natural.
inline double LogDifference(double estimate, double reference, double floor) {
  return std::log(std::fmax(estimate, 0.0) + floor) -
         std::log(std::fmax(reference, 0.0) + floor);
}

// Weighted differences of three channels, summed in the order they were added.
class LogDifferences {
 public:
  void Reserve(size_t count) {
    weights_.reserve(count);
    for (std::vector<double>& d : differences_) d.reserve(count);
  }

  // weight > 0, the same for the three channels.
  void Add(const std::array<double, 3>& differences, double weight) {
    weights_.push_back(weight);
    for (size_t c = 0; c < 3; ++c) differences_[c].push_back(differences[c]);
  }

  bool empty() const { return weights_.empty(); }

  // Root of the weighted mean square over all channels; `aligned` takes the
  // weighted mean of each channel off first, which is the best scale where the
  // floor does not matter. Not empty.
  double Rms(bool aligned) const {
    double weight = 0.0, squares = 0.0;
    for (const double w : weights_) weight += w;
    for (const std::vector<double>& d : differences_) {
      double mean = 0.0;
      if (aligned) {
        for (size_t i = 0; i < d.size(); ++i) mean += weights_[i] * d[i];
        mean /= weight;
      }
      for (size_t i = 0; i < d.size(); ++i) {
        squares += weights_[i] * (d[i] - mean) * (d[i] - mean);
      }
    }
    return std::sqrt(squares / (3.0 * weight));
  }

 private:
  std::vector<double> weights_;
  std::array<std::vector<double>, 3> differences_;
};

}  // namespace ibrdf
