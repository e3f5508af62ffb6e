// Ever narrower lobes: values of the BRDF and radiance near the mirror
// direction.
#include <algorithm>
#include <cmath>
#include <random>
#include <vector>

#include "experiments/validation/stability/naive_brdf.h"
#include "experiments/validation/stability/sweeps.h"
#include "ibrdf/brdf/cook_torrance.h"
#include "ibrdf/geometry/half_diff.h"
#include "ibrdf/transport/transport.h"
#include "tests/support/render_testing.h"

namespace ibrdf {
namespace stability {
namespace {

using Vector3 = Eigen::Matrix<Real, 3, 1>;

constexpr int kPairs = 300;
constexpr double kF0 = 0.9;

CookTorrance Mirror(double roughness) {
  CookTorrance brdf;
  brdf.diffuse.setZero();
  brdf.specular.setOnes();
  brdf.roughness.setConstant(roughness);
  brdf.f0.setConstant(kF0);
  return brdf;
}

// The arguments are unit directions, z > 0; the tangent from the half-vector's
// components.
Real PreciseCookTorrance(const Vector3& wi, const Vector3& wo, Real m) {
  const Vector3 h = (wi + wo).normalized();
  const Real cos_h = h.z(), cos_d = h.dot(wi);
  const Real tan2 = (h.x() * h.x() + h.y() * h.y()) / (cos_h * cos_h);
  const Real D = std::exp(-tan2 / (m * m)) /
                 (Real(3.14159265358979323846L) * m * m * std::pow(cos_h, 4));
  const Real f0 = kF0;
  const Real F = f0 + (1 - f0) * std::pow(1 - cos_d, 5);
  const Real G = std::min(
      {Real(1), 2 * cos_h * wi.z() / cos_d, 2 * cos_h * wo.z() / cos_d});
  return D * F * G / (4 * wi.z() * wo.z());
}

void AddValues(double roughness, unsigned seed, SweepTable* table) {
  std::mt19937_64 rng(seed);
  std::uniform_real_distribution<double> unit(0.0, 1.0);
  const CookTorrance brdf = Mirror(roughness);
  std::vector<double> ours, naive;
  for (int i = 0; i < kPairs; ++i) {
    const double theta_h = std::atan(2.0 * roughness * unit(rng));
    const HalfDiff angles{std::min(theta_h, 0.2), 1.2 * unit(rng),
                          3.14 * unit(rng)};
    Eigen::Vector3d wi, wo;
    FromHalfDiff(angles, &wi, &wo);
    wi.normalize();
    wo.normalize();
    const Real reference = PreciseCookTorrance(
        wi.cast<Real>().normalized(), wo.cast<Real>().normalized(), roughness);
    const HalfDiff a = ToHalfDiff(wi, wo);
    ours.push_back(RelativeError(
        brdf.Evaluate(a.theta_h, a.theta_d, a.phi_d)[0], reference));
    const Eigen::Vector3f wi_float = wi.cast<float>().normalized();
    const Eigen::Vector3f wo_float = wo.cast<float>().normalized();
    naive.push_back(RelativeError(
        NaiveCookTorrance(wi_float, wo_float, static_cast<float>(roughness),
                          static_cast<float>(kF0)),
        reference));
  }
  table->Add("roughness", roughness, "BRDF", kOurs, ours);
  table->Add("roughness", roughness, "BRDF", kNaive, naive);
}

// int f L cos over half-vectors drawn from Beckmann's distribution by their
// quantiles: the integrand is smooth however narrow the lobe.
Real PreciseRadiance(const ShadingPoint& point, const Image& map, Real m) {
  constexpr int kRings = 200, kAzimuths = 256;
  const Vector3 n = point.normal.cast<Real>().normalized();
  const Vector3 wo = point.wo.cast<Real>().normalized();
  const Vector3 t = n.unitOrthogonal(), b = n.cross(t);
  Real sum = 0;
  for (int i = 0; i < kRings; ++i) {
    const Real tangent = m * std::sqrt(-std::log((i + Real(0.5)) / kRings));
    const Real cos_h = 1 / std::sqrt(1 + tangent * tangent);
    for (int k = 0; k < kAzimuths; ++k) {
      const Real phi = 2 * Real(3.14159265358979323846L) * k / kAzimuths;
      const Vector3 h =
          cos_h * (n + tangent * (std::cos(phi) * t + std::sin(phi) * b));
      const Real cos_d = h.dot(wo), cos_o = n.dot(wo);
      const Vector3 wi = 2 * cos_d * h - wo;
      const Real cos_i = n.dot(wi);
      if (cos_d <= 0 || cos_i <= 0) continue;
      const Real F = kF0 + (1 - Real(kF0)) * std::pow(1 - cos_d, 5);
      const Real G = std::min(
          {Real(1), 2 * cos_h * cos_i / cos_d, 2 * cos_h * cos_o / cos_d});
      sum += F * G * cos_d / (cos_o * cos_h) *
             Real(LookUpMap(map, wi.cast<double>())[0]);
    }
  }
  return sum / (kRings * kAzimuths);
}

// One direction for each texel, as differentiable renderers of environment maps
// have it.
float NaiveRadiance(const ShadingPoint& point, const Image& map, float m) {
  const Eigen::Vector3f n = point.normal.normalized();
  const Eigen::Vector3f t = n.unitOrthogonal(), b = n.cross(t);
  const Eigen::Vector3f wo(point.wo.dot(t), point.wo.dot(b), point.wo.dot(n));
  float L_o = 0.0f;
  for (int y = 0; y < map.height; ++y) {
    const auto area =
        static_cast<float>(TexelSolidAngle(y, map.height, map.width));
    for (int x = 0; x < map.width; ++x) {
      const Eigen::Vector3f d =
          MapDirection(y + 0.5, x + 0.5, map.height, map.width).cast<float>();
      const Eigen::Vector3f wi(d.dot(t), d.dot(b), d.dot(n));
      if (wi.z() <= 0.0f) continue;
      L_o += NaiveCookTorrance(wi, wo, m, static_cast<float>(kF0)) *
             map.At(x, y)[0] * wi.z() * area;
    }
  }
  return L_o;
}

}  // namespace

void SweepRoughness(const SweepOptions& options, SweepTable* table) {
  const Image map = testing::SmoothMap(32, 64);
  std::vector<ShadingPoint> points;
  for (int i = 0; i < 24; ++i) {
    points.push_back(testing::PointAt(0.05 + 1.05 * i / 23.0, 2.4 * i));
  }
  const Transport transport(points, map.height, map.width, TransportOptions());
  for (const double roughness : {0.5, 0.3, 0.2, 0.1, 0.05, 0.03, 0.02, 0.01,
                                 0.005, 0.003, 1e-3, 3e-4, 1e-4}) {
    AddValues(roughness, options.seed, table);
    const BrdfGrid grid = BrdfGrid::FromFunction(Mirror(roughness).Function(),
                                                 TransportOptions().grid);
    std::vector<double> L_o(3 * points.size()), ours, naive;
    transport.Render(grid, map.rgb.data(), L_o.data());
    for (size_t i = 0; i < points.size(); ++i) {
      const Real reference = PreciseRadiance(points[i], map, roughness);
      ours.push_back(RelativeError(L_o[3 * i], reference));
      naive.push_back(RelativeError(
          NaiveRadiance(points[i], map, static_cast<float>(roughness)),
          reference));
    }
    table->Add("roughness", roughness, "radiance", kOurs, ours);
    table->Add("roughness", roughness, "radiance", kNaive, naive);
  }
}

}  // namespace stability
}  // namespace ibrdf
