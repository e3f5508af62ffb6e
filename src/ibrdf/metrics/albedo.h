// Directional albedo of a BRDF, and white-furnace figures.
#pragma once
#include <Eigen/Core>
#include <vector>

#include "ibrdf/brdf/brdf_grid.h"
#include "ibrdf/brdf/flow_brdf.h"

namespace ibrdf {

struct AlbedoOptions {
  int theta_nodes = 96;  // Gauss-Legendre, along theta_h
  // Midpoints, along phi_h in [0, 2 pi): isotropy alone does not make the two
  // sides of the plane of view mirror images.
  int phi_nodes = 128;
};

// Nodes and weights for the albedo of one view angle, a(wo) = int f_r
// cos(theta_i) dwi. The light directions are taken by their half-vector,
// dwi = 4 cos(theta_d) dwh. Those above the horizon are theta_h < bound(phi_h),
// so that no node is lost and the rule is spectral for a smooth f_r; nodes
// crowd as t^3 towards the mirror direction, theta_h = 0. Weights are scaled
// by one factor so that they sum to pi: a Lambertian surface is exact.
class AlbedoRule {
 public:
  // theta_o: radians, in [0, pi/2).
  explicit AlbedoRule(double theta_o, const AlbedoOptions& options = {});

  const std::vector<HalfDiff>& angles() const { return angles_; }
  // Unit, in the local frame whose first axis lies below the view.
  const std::vector<Eigen::Vector3d>& directions() const { return directions_; }
  const std::vector<double>& weights() const { return weights_; }  // sr
  const std::vector<double>& cos_i() const { return cos_i_; }
  // What the weights were multiplied by: 1 for a perfect rule, which tests hold
  // it to.
  double correction() const { return correction_; }

  Eigen::Array3d Albedo(const BrdfBatch& brdf) const;

 private:
  std::vector<HalfDiff> angles_;
  std::vector<Eigen::Vector3d> directions_;
  std::vector<double> weights_, cos_i_;
  double correction_ = 1.0;
};

// The parts of a white furnace: constant light of radiance 1 from everywhere,
// in which radiance seen is the directional albedo; a BRDF that keeps energy
// stays at or below 1.
struct FurnaceFigures {
  std::vector<Eigen::Array3d> albedo;  // at FurnaceRules::kViewDegrees
  Eigen::Array3d largest;              // over all views of the rules
  Eigen::Array3d hemispherical;        // int a cos(theta_o) dwo / pi
  int views = 0;                       // times channels of which
  int above_one = 0;                   // exceed 1 by more than kSlack
};

// The rules of all views, to be shared between BRDFs.
class FurnaceRules {
 public:
  static constexpr int kNumViews = 5;
  static constexpr double kViewDegrees[kNumViews] = {0, 30, 60, 75, 85};
  // Views looked at for the largest albedo: 0, 5 ... 85 degrees. Beyond, tables
  // hold next to no measurement.
  static constexpr int kLastViewDegrees = 85;
  static constexpr double kSlack = 1e-6;  // rounding of a white surface

  explicit FurnaceRules(const AlbedoOptions& options = {});
  FurnaceFigures Measure(const BrdfBatch& brdf) const;

 private:
  std::vector<AlbedoRule> views_;       // every 5 degrees
  std::vector<AlbedoRule> hemisphere_;  // Gauss-Legendre in cos(theta_o)
  std::vector<double> hemisphere_weights_;
};

// Hemispherical albedo of the matte part of a BRDF, by few nodes.
Eigen::Array3d MatteAlbedo(const BrdfGrid& matte);

}  // namespace ibrdf
