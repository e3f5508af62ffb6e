#include "ibrdf/solvers/photograph_check/normal_hypotheses.h"

#include <Eigen/Core>
#include <algorithm>
#include <cmath>

namespace ibrdf {
namespace {

Eigen::Vector3d Changed(const Eigen::Vector3d& n, NormalHypothesis hypothesis) {
  const double sum = n.sum();
  switch (hypothesis) {
    case NormalHypothesis::kAsGiven:
      return n;
    case NormalHypothesis::kXFlipped:
      return {-n.x(), n.y(), n.z()};
    case NormalHypothesis::kYFlipped:
      return {n.x(), -n.y(), n.z()};
    case NormalHypothesis::kBothFlipped:
      return {-n.x(), -n.y(), n.z()};
    case NormalHypothesis::kSwapped:
      return {n.y(), n.x(), n.z()};
    case NormalHypothesis::kOpenCv:
      return {n.x(), -n.y(), -n.z()};
    case NormalHypothesis::kWasEncoded: {
      // n is along (m + 1) / 2, so m = 2 t n - 1 of length 1.
      const double t = 0.5 * (sum + std::sqrt(std::max(sum * sum - 2.0, 0.0)));
      return (2.0 * t * n - Eigen::Vector3d::Ones()).normalized();
    }
    case NormalHypothesis::kWasFloat: {
      // n is along 2 m - 1, so m = (t n + 1) / 2 of length 1, with t > 0.
      const double t = std::sqrt(sum * sum + 1.0) - sum;
      return (0.5 * (t * n + Eigen::Vector3d::Ones())).normalized();
    }
  }
  return n;
}

}  // namespace

const char* NameOf(NormalHypothesis hypothesis) {
  static constexpr const char* kNames[kNumNormalHypotheses] = {
      "as given",     "x flipped",    "y flipped",    "x and y flipped",
      "x, y swapped", "y, z negated", "0..1 encoded", "float, not 0..1"};
  return kNames[static_cast<int>(hypothesis)];
}

const char* AdviceFor(NormalHypothesis hypothesis) {
  static constexpr const char* kAdvice[kNumNormalHypotheses] = {
      "",
      "negate x in the file (x is right)",
      "negate y in the file (y is up)",
      "negate x and y in the file (x is right, y is up)",
      "swap x and y in the file",
      "the other geometry.frame of opengl and opencv",
      "geometry.encoding: unit_0_1",
      "geometry.encoding: float"};
  return kAdvice[static_cast<int>(hypothesis)];
}

Image UnderHypothesis(const Image& normals, NormalHypothesis hypothesis) {
  Image out(normals.width, normals.height);
  for (size_t i = 0; i < normals.num_pixels(); ++i) {
    const Eigen::Map<const Eigen::Vector3f> n(&normals.rgb[3 * i]);
    if (n.isZero()) continue;
    Eigen::Map<Eigen::Vector3f>(&out.rgb[3 * i]) =
        Changed(n.cast<double>(), hypothesis).cast<float>();
  }
  return out;
}

}  // namespace ibrdf
