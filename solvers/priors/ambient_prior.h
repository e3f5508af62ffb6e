// What is known of stray light before the reflectance is.
#pragma once
#include <Eigen/Core>

namespace ibrdf {

// Normal per channel, cut to radiance >= 0: the mean is what pixels show that
// the known light does not reach, the deviation how much they differ.
struct AmbientPrior {
  Eigen::Array3d mean = Eigen::Array3d::Zero();
  // 0 in all channels: the ambient term is the mean. Else > 0 in all.
  Eigen::Array3d deviation = Eigen::Array3d::Zero();

  bool unknown() const { return (deviation > 0.0).all(); }
  // 1/2 sum ((a - mean) / deviation)^2, nats; 0 where it is not unknown.
  double Cost(const Eigen::Array3d& ambient) const {
    if (!unknown()) return 0.0;
    return 0.5 * ((ambient - mean) / deviation).square().sum();
  }
};

}  // namespace ibrdf
