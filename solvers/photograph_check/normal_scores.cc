#include "ibrdf/solvers/photograph_check/normal_scores.h"

#include <Eigen/Core>
#include <algorithm>
#include <cmath>
#include <cstdint>
#include <limits>

namespace ibrdf {
namespace {

constexpr double kNone = std::numeric_limits<double>::quiet_NaN();
// Outward directions are slopes of the mask, averaged over this far.
constexpr int kRadius = 3;
constexpr int kFewestOnOutline = 20;
// Pixels that say something of the curl; steps in the normals that are creases
// or edges of parts in front of others.
constexpr int kFewestInside = 50;
constexpr float kCrease = 0.3f;
// Normals at an outline may look away by this much from rounding alone.
constexpr float kLooksAway = -0.02f;

class NormalField {
 public:
  NormalField(const Image& normals, const Mask& mask) : normals_(normals) {
    inside_.resize(normals.num_pixels());
    for (size_t i = 0; i < inside_.size(); ++i) {
      const float* n = &normals.rgb[3 * i];
      inside_[i] =
          mask.Holds(i) && (n[0] != 0.0f || n[1] != 0.0f || n[2] != 0.0f);
    }
  }

  int width() const { return normals_.width; }
  int height() const { return normals_.height; }
  bool Inside(int x, int y) const {
    return inside_[static_cast<size_t>(y) * normals_.width + x] != 0;
  }
  Eigen::Map<const Eigen::Vector3f> At(int x, int y) const {
    return Eigen::Map<const Eigen::Vector3f>(normals_.At(x, y));
  }

 private:
  const Image& normals_;
  std::vector<uint8_t> inside_;
};

double ShareAway(const NormalField& field) {
  size_t all = 0, away = 0;
  for (int y = 0; y < field.height(); ++y) {
    for (int x = 0; x < field.width(); ++x) {
      if (!field.Inside(x, y)) continue;
      ++all;
      away += field.At(x, y).z() < kLooksAway;
    }
  }
  return all == 0 ? kNone
                  : static_cast<double>(away) / static_cast<double>(all);
}

bool OnOutline(const NormalField& field, int x, int y) {
  return field.Inside(x, y) &&
         (!field.Inside(x - 1, y) || !field.Inside(x + 1, y) ||
          !field.Inside(x, y - 1) || !field.Inside(x, y + 1));
}

// Out of the mask, y up; zero where it is as much inside on all sides.
Eigen::Vector2f Outwards(const NormalField& field, int x, int y) {
  Eigen::Vector2f out = Eigen::Vector2f::Zero();
  for (int dy = -kRadius; dy <= kRadius; ++dy) {
    for (int dx = -kRadius; dx <= kRadius; ++dx) {
      if (!field.Inside(x + dx, y + dy)) {
        out += Eigen::Vector2f(static_cast<float>(dx), static_cast<float>(-dy));
      }
    }
  }
  return out;
}

// What touches the image's edge is cut off there and has no outline.
double OutlineDisagreement(const NormalField& field) {
  double sum = 0.0;
  int count = 0;
  for (int y = kRadius; y < field.height() - kRadius; ++y) {
    for (int x = kRadius; x < field.width() - kRadius; ++x) {
      if (!OnOutline(field, x, y)) continue;
      const Eigen::Vector2f out = Outwards(field, x, y);
      if (out.norm() < 1.0f) continue;
      sum += out.normalized().dot(field.At(x, y).head<2>());
      ++count;
    }
  }
  return count < kFewestOnOutline ? kNone : 0.5 * (1.0 - sum / count);
}

bool IsSmooth(const Eigen::Vector3f& step) {
  return step.cwiseAbs().maxCoeff() < kCrease;
}

double CurlDisagreement(const NormalField& field) {
  double sum = 0.0, parts = 0.0;
  int count = 0;
  for (int y = 1; y + 1 < field.height(); ++y) {
    for (int x = 1; x + 1 < field.width(); ++x) {
      if (!field.Inside(x, y) || !field.Inside(x - 1, y) ||
          !field.Inside(x + 1, y) || !field.Inside(x, y - 1) ||
          !field.Inside(x, y + 1)) {
        continue;
      }
      const Eigen::Vector3f dx =
          0.5f * (field.At(x + 1, y) - field.At(x - 1, y));
      const Eigen::Vector3f dy =
          0.5f * (field.At(x, y - 1) - field.At(x, y + 1));
      if (!IsSmooth(dx) || !IsSmooth(dy)) continue;
      // n . curl n of a field that does not depend on z.
      const Eigen::Vector3f n = field.At(x, y);
      const float a = n.x() * dy.z() - n.z() * dy.x();
      const float b = n.z() * dx.y() - n.y() * dx.z();
      sum += std::abs(a + b);
      parts += std::abs(a) + std::abs(b);
      ++count;
    }
  }
  constexpr double kFlat = 1e-6;  // rounding
  return count < kFewestInside || parts <= kFlat * count ? kNone : sum / parts;
}

}  // namespace

NormalScore ScoreNormals(const Image& normals, const Mask& mask) {
  const NormalField field(normals, mask);
  NormalScore score;
  score.away = ShareAway(field);
  score.outline = OutlineDisagreement(field);
  score.curl = CurlDisagreement(field);
  double sum = 0.0;
  int count = 0;
  for (const double part : {score.away, score.outline, score.curl}) {
    if (std::isnan(part)) continue;
    sum += part;
    ++count;
  }
  score.disagreement = count == 0 ? 0.0 : sum / count;
  return score;
}

std::vector<NormalScore> RankNormalHypotheses(const Image& normals,
                                              const Mask& mask) {
  std::vector<NormalScore> scores;
  for (int k = 0; k < kNumNormalHypotheses; ++k) {
    const auto hypothesis = static_cast<NormalHypothesis>(k);
    scores.push_back(ScoreNormals(UnderHypothesis(normals, hypothesis), mask));
    scores.back().hypothesis = hypothesis;
  }
  std::stable_sort(scores.begin(), scores.end(),
                   [](const NormalScore& a, const NormalScore& b) {
                     return a.disagreement < b.disagreement;
                   });
  return scores;
}

}  // namespace ibrdf
