#include "solvers/joint/edge_prior.h"

#include <glog/logging.h>

#include <cmath>

#include "ibrdf/light/environment_map.h"

namespace ibrdf {
namespace {

constexpr double kPi = 3.14159265358979323846;

}  // namespace

EdgePrior::EdgePrior(int height, int width, double scale, double delta)
    : height_(height), width_(width), delta_(delta) {
  CHECK_GT(scale, 0.0);
  CHECK_GT(delta, 0.0);
  const double row_angle = kPi / height;
  const double equator = TexelSolidAngle(height / 2, height, width);
  for (int r = 0; r < height; ++r) {
    const double column_angle =
        2 * kPi / width * std::sin((r + 0.5) * row_angle);
    share_.push_back(TexelSolidAngle(r, height, width) / equator);
    along_.push_back(1.0 / (scale * scale * column_angle));
    down_.push_back(1.0 / (scale * scale * row_angle));
  }
}

// f(texel, its neighbour, share, 1 / (scale^2 angle)), always in this order.
template <typename Function>
void EdgePrior::ForEachEdge(const Function& f) const {
  for (int r = 0; r < height_; ++r) {
    const size_t row = static_cast<size_t>(r) * width_;
    for (int x = 0; x < width_; ++x) {
      f(row + x, row + (x + 1) % width_, share_[r], along_[r]);
      if (r + 1 < height_) f(row + x, row + width_ + x, share_[r], down_[r]);
    }
  }
}

double EdgePrior::Evaluate(const float* log_map, float* gradient) {
  double sum = 0.0;
  if (gradient != nullptr) weights_.clear();
  ForEachEdge([&](size_t a, size_t b, double share, double inverse_square) {
    double d[3], t2 = 0.0;
    for (int c = 0; c < 3; ++c) {
      d[c] = static_cast<double>(log_map[b + c * Plane()]) -
             log_map[a + c * Plane()];
      t2 += d[c] * d[c] * inverse_square;
    }
    const double root = std::sqrt(t2 + delta_ * delta_);
    sum += share * t2 / (root + delta_);
    if (gradient == nullptr) return;
    const double weight = share * inverse_square / root;
    weights_.push_back(static_cast<float>(weight));
    for (int c = 0; c < 3; ++c) {
      gradient[b + c * Plane()] += static_cast<float>(weight * d[c]);
      gradient[a + c * Plane()] -= static_cast<float>(weight * d[c]);
    }
  });
  return sum;
}

void EdgePrior::AddProduct(const float* v, float* out) const {
  CHECK(!weights_.empty()) << "no gradient yet";
  size_t edge = 0;
  ForEachEdge([&](size_t a, size_t b, double, double) {
    const float weight = weights_[edge++];
    for (int c = 0; c < 3; ++c) {
      const float d = weight * (v[b + c * Plane()] - v[a + c * Plane()]);
      out[b + c * Plane()] += d;
      out[a + c * Plane()] -= d;
    }
  });
}

}  // namespace ibrdf
