#include "ibrdf/solvers/marginal/directional_responses.h"

#include <Eigen/Geometry>
#include <algorithm>

#include "ibrdf/geometry/half_diff.h"
#include "ibrdf/solvers/priors/directional_lights.h"

namespace ibrdf {
namespace {

constexpr double kMinCosine = 1e-3;

}  // namespace

DirectionalLightResponses::DirectionalLightResponses(
    const NormalBins& bins, const BrdfGridShape& grid,
    const Visibility* visibility,
    const std::vector<Eigen::Vector3d>& directions)
    : num_directional_lights_(static_cast<int>(directions.size())),
      first_(bins.first) {
  taps_.reserve(bins.points.size() * directions.size());
  for (const ShadingPoint& point : bins.points) {
    const Eigen::Vector3d n = point.normal.cast<double>();
    const uint64_t* const hidden =
        visibility != nullptr ? visibility->Hidden(point) : nullptr;
    // Isotropic: any frame about the normal.
    const auto turn =
        Eigen::Quaterniond::FromTwoVectors(n, Eigen::Vector3d::UnitZ());
    Eigen::Vector3d wo = turn * point.wo.cast<double>();
    wo[2] = std::max(wo[2], kMinCosine);
    for (const Eigen::Vector3d& direction : directions) {
      Taps& taps = taps_.emplace_back();
      const double cosine = n.dot(direction);
      if (!(cosine > kMinCosine)) continue;
      double scale = cosine * kDirectionalLightSolidAngle;
      if (hidden != nullptr) {
        scale *= visibility->grid().VisibleAlong(hidden, n, direction);
      }
      const HalfDiff x = ToHalfDiff(turn * direction, wo);
      const BrdfGridTaps found =
          GridTaps(grid, ToUnitCube(x.theta_h, x.theta_d, x.phi_d));
      for (int i = 0; i < 8; ++i) {
        taps.node[i] = found.node[i];
        taps.weight[i] = static_cast<float>(scale * found.weight[i]);
      }
    }
  }
}

RowMatrix DirectionalLightResponses::Of(const float* field) const {
  const auto num_bins = static_cast<Eigen::Index>(first_.size()) - 1;
  RowMatrix out = RowMatrix::Zero(num_bins, num_directional_lights_);
  for (Eigen::Index i = 0; i < num_bins; ++i) {
    for (int p = first_[i]; p < first_[i + 1]; ++p) {
      for (int k = 0; k < num_directional_lights_; ++k) {
        const Taps& taps = taps_[size_t{1} * p * num_directional_lights_ + k];
        for (int j = 0; j < 8; ++j) {
          out(i, k) +=
              static_cast<double>(taps.weight[j]) * field[taps.node[j]];
        }
      }
    }
    out.row(i) /= first_[i + 1] - first_[i];
  }
  return out;
}

void DirectionalLightResponses::AddGradient(const Matrix& adjoint,
                                            float* gradient) const {
  for (Eigen::Index i = 0; i < adjoint.rows(); ++i) {
    for (int p = first_[i]; p < first_[i + 1]; ++p) {
      for (int k = 0; k < num_directional_lights_; ++k) {
        const Taps& taps = taps_[size_t{1} * p * num_directional_lights_ + k];
        const float share =
            adjoint(i, k) / static_cast<float>(first_[i + 1] - first_[i]);
        for (int j = 0; j < 8; ++j) {
          gradient[taps.node[j]] += share * taps.weight[j];
        }
      }
    }
  }
}

}  // namespace ibrdf
