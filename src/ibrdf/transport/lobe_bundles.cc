#include "ibrdf/transport/lobe_bundles.h"

#include <glog/logging.h>

#include <algorithm>
#include <numeric>

#include "ibrdf/base/pi.h"

namespace ibrdf {
namespace {

constexpr int kWidthSteps = 2048;

class Cutter {
 public:
  Cutter(const std::vector<Eigen::Vector3f>& directions,
         const std::vector<float>& weights, LobeBundles* out)
      : directions_(directions), weights_(weights), out_(*out) {}

  void Cut(std::vector<int>::iterator begin, std::vector<int>::iterator end,
           int count) {
    if (count == 1) return Close(begin, end);
    Eigen::Vector3f low = Eigen::Vector3f::Constant(2.0f), high = -low;
    double all = 0.0;
    for (auto i = begin; i != end; ++i) {
      low = low.cwiseMin(directions_[*i]);
      high = high.cwiseMax(directions_[*i]);
      all += weights_[*i];
    }
    int axis = 0;
    (high - low).maxCoeff(&axis);
    std::sort(begin, end, [&](int a, int b) {
      const float x = directions_[a][axis], y = directions_[b][axis];
      return x < y || (x == y && a < b);
    });
    auto middle = begin;
    for (double sum = 0.0; middle != end && sum + weights_[*middle] <= all / 2;
         ++middle) {
      sum += weights_[*middle];
    }
    Cut(begin, middle, count / 2);
    Cut(middle, end, count / 2);
  }

 private:
  void Close(std::vector<int>::iterator begin, std::vector<int>::iterator end) {
    constexpr float kLeast = 1e-30f;  // so that weights of 0 have a mean
    Eigen::Vector3f sum = Eigen::Vector3f::Zero();
    for (auto i = begin; i != end; ++i) {
      out_.of[*i] = static_cast<int>(out_.means.size());
      sum += std::max(weights_[*i], kLeast) * directions_[*i];
    }
    const float largest = sum.cwiseAbs().maxCoeff();
    out_.means.push_back(largest > 0.0f ? (sum / largest).normalized() : sum);
  }

  const std::vector<Eigen::Vector3f>& directions_;
  const std::vector<float>& weights_;
  LobeBundles& out_;
};

}  // namespace

double LobeHalfWidth(const BrdfFunction& brdf) {
  const auto value = [&](double theta_h) {
    return brdf(theta_h, kPi / 9, kPi / 2).mean();
  };
  const double half = 0.5 * value(0.0);
  for (int i = 1; i < kWidthSteps; ++i) {
    // Narrow steps near the normal.
    const double x = static_cast<double>(i) / kWidthSteps;
    if (value(x * x * kPi / 2) < half) return x * x * kPi / 2;
  }
  return kPi / 2;
}

LobeBundles BundleDirections(const std::vector<Eigen::Vector3f>& directions,
                             const std::vector<float>& weights, int count) {
  CHECK_EQ(directions.size(), weights.size());
  CHECK(count > 0 && (count & (count - 1)) == 0);
  LobeBundles out;
  out.of.assign(directions.size(), 0);
  std::vector<int> order(directions.size());
  std::iota(order.begin(), order.end(), 0);
  Cutter(directions, weights, &out).Cut(order.begin(), order.end(), count);
  return out;
}

}  // namespace ibrdf
