#include "ibrdf/metrics/albedo.h"

#include <glog/logging.h>

#include <algorithm>
#include <cmath>

#include "ibrdf/base/gauss_legendre.h"
#include "ibrdf/base/pi.h"

namespace ibrdf {
namespace {

constexpr int kStepDegrees = 5;
constexpr int kHemisphereNodes = 8;

}  // namespace

AlbedoRule::AlbedoRule(double theta_o, const AlbedoOptions& options) {
  CHECK(theta_o >= 0.0 && theta_o < kPi / 2);
  const double cos_o = std::cos(theta_o), sin_o = std::sin(theta_o);
  const Eigen::Vector3d wo(sin_o, 0.0, cos_o);
  std::vector<double> t, dt;
  GaussLegendre(options.theta_nodes, &t, &dt);
  double sum = 0.0;
  for (int j = 0; j < options.phi_nodes; ++j) {
    const double dphi = 2.0 * kPi / options.phi_nodes;
    const double phi = dphi * (j + 0.5);
    // cos(theta_i) is proportional to cos(2 theta_h - delta).
    const double delta = std::atan2(sin_o * std::cos(phi), cos_o);
    const double bound = 0.5 * (delta + kPi / 2);
    for (int i = 0; i < options.theta_nodes; ++i) {
      const double theta_h = bound * t[i] * t[i] * t[i];
      const double dtheta = 3.0 * bound * t[i] * t[i] * dt[i];
      const double sin_h = std::sin(theta_h);
      const Eigen::Vector3d h(sin_h * std::cos(phi), sin_h * std::sin(phi),
                              std::cos(theta_h));
      const double cos_d = wo.dot(h);
      const Eigen::Vector3d wi = 2.0 * cos_d * h - wo;
      if (wi.z() <= 0.0 || cos_d <= 0.0) continue;  // by rounding
      angles_.push_back(ToHalfDiff(wi, wo));
      directions_.push_back(wi);
      cos_i_.push_back(wi.z());
      weights_.push_back(wi.z() * 4.0 * cos_d * sin_h * dtheta * dphi);
      sum += weights_.back();
    }
  }
  correction_ = kPi / sum;
  for (double& w : weights_) w *= correction_;
}

Eigen::Array3d AlbedoRule::Albedo(const BrdfBatch& brdf) const {
  const std::vector<Eigen::Array3d> f = brdf(angles_);
  Eigen::Array3d sum = Eigen::Array3d::Zero();
  for (size_t i = 0; i < f.size(); ++i) sum += weights_[i] * f[i];
  return sum;
}

FurnaceRules::FurnaceRules(const AlbedoOptions& options) {
  for (int degrees = 0; degrees <= kLastViewDegrees; degrees += kStepDegrees) {
    views_.emplace_back(degrees * kPi / 180.0, options);
  }
  // int a cos dw / pi = int_0^1 a 2 mu dmu, mu = cos(theta_o).
  std::vector<double> mu;
  GaussLegendre(kHemisphereNodes, &mu, &hemisphere_weights_);
  for (size_t i = 0; i < mu.size(); ++i) {
    hemisphere_weights_[i] *= 2.0 * mu[i];
    hemisphere_.emplace_back(std::acos(mu[i]), options);
  }
}

FurnaceFigures FurnaceRules::Measure(const BrdfBatch& brdf) const {
  FurnaceFigures figures;
  figures.largest.setZero();
  figures.hemispherical.setZero();
  int next = 0;
  for (size_t i = 0; i < views_.size(); ++i) {
    const Eigen::Array3d albedo = views_[i].Albedo(brdf);
    if (next < kNumViews &&
        kViewDegrees[next] == static_cast<double>(i) * kStepDegrees) {
      figures.albedo.push_back(albedo);
      ++next;
    }
    figures.largest = figures.largest.max(albedo);
    figures.views += 3;
    figures.above_one += static_cast<int>((albedo > 1.0 + kSlack).count());
  }
  for (size_t i = 0; i < hemisphere_.size(); ++i) {
    figures.hemispherical +=
        hemisphere_weights_[i] * hemisphere_[i].Albedo(brdf);
  }
  return figures;
}

Eigen::Array3d MatteAlbedo(const BrdfGrid& matte) {
  constexpr AlbedoOptions kNodes = {24, 32};
  return FurnaceRules(kNodes)
      .Measure(BatchOf([&](double theta_h, double theta_d, double phi_d) {
        return matte.Evaluate(theta_h, theta_d, phi_d);
      }))
      .hemispherical;
}

}  // namespace ibrdf
