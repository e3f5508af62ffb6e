// Lobes, maps and a slow quadrature shared by the renderer's tests.
#pragma once
#include <Eigen/Geometry>
#include <algorithm>
#include <cmath>
#include <random>
#include <vector>

#include "ibrdf/base/pi.h"
#include "ibrdf/brdf/brdf_grid.h"
#include "ibrdf/geometry/half_diff.h"
#include "ibrdf/light/environment_map.h"
#include "ibrdf/scene/scene.h"
#include "ibrdf/transport/transport.h"

namespace ibrdf {
namespace testing {

inline BrdfFunction Lambertian(double albedo) {
  return [albedo](double, double, double) {
    return Eigen::Array3d(Eigen::Array3d::Constant(albedo / kPi));
  };
}

// Diffuse floor and a Gaussian of slopes of standard deviation `degrees`.
inline BrdfFunction Glossy(double diffuse, double specular, double degrees) {
  const double width = degrees * kPi / 180;
  return [=](double theta_h, double theta_d, double) {
    const double slope = std::tan(std::min(theta_h, 1.5)) / width;
    const double peak = 1.0 / (2.0 * kPi * width * width);
    const double fresnel = 0.8 + 0.2 * std::pow(1.0 - std::cos(theta_d), 5.0);
    const double f = diffuse / kPi +
                     specular * fresnel * peak * std::exp(-0.5 * slope * slope);
    return Eigen::Array3d(f, 0.8 * f, 0.5 * f);
  };
}

inline Image ConstantMap(int height, int width, float value) {
  Image map(width, height);
  std::fill(map.rgb.begin(), map.rgb.end(), value);
  return map;
}

inline Image SmoothMap(int height, int width) {
  Image map(width, height);
  for (int r = 0; r < height; ++r) {
    for (int c = 0; c < width; ++c) {
      const Eigen::Vector3d d = MapDirection(r + 0.5, c + 0.5, height, width);
      float* L = map.At(c, r);
      L[0] = static_cast<float>(std::exp(1.5 * d.y() + 0.5 * d.x()));
      L[1] = static_cast<float>(1.0 + 0.8 * std::sin(2.0 * d.x() + d.z()));
      L[2] = static_cast<float>(0.3 + d.z() * d.z());
    }
  }
  return map;
}

inline Image RandomMap(int height, int width, unsigned seed) {
  std::mt19937 rng(seed);
  std::normal_distribution<float> g;
  Image map(width, height);
  for (float& v : map.rgb) v = std::exp(g(rng));
  return map;
}

// A point seen along -z whose normal makes `theta` with the view.
inline ShadingPoint PointAt(double theta, double azimuth) {
  ShadingPoint p{};
  p.normal =
      Eigen::Vector3d(std::sin(theta) * std::cos(azimuth),
                      std::sin(theta) * std::sin(azimuth), std::cos(theta))
          .cast<float>();
  p.wo = Eigen::Vector3f::UnitZ();
  p.pixel = 0;
  p.coverage = 1.0f;
  return p;
}

// Seen from +z, normals at these angles (degrees) from where a surface mirrors
// `light` (unit): the peak of a lobe and beside it.
inline std::vector<ShadingPoint> PointsAroundTheHighlight(
    const Eigen::Vector3d& light, const std::vector<double>& degrees) {
  const Eigen::Vector3d half = (light + Eigen::Vector3d::UnitZ()).normalized();
  const Eigen::Vector3d aside = half.unitOrthogonal();
  std::vector<ShadingPoint> points;
  for (const double angle : degrees) {
    const double theta = angle * kPi / 180;
    points.push_back(PointAt(0.0, 0.0));
    points.back().normal =
        (std::cos(theta) * half + std::sin(theta) * aside).cast<float>();
  }
  return points;
}

// Poles, the view's own direction, grazing views, several wo.
inline std::vector<ShadingPoint> PolarAndGrazingPoints() {
  std::vector<ShadingPoint> points;
  for (const Eigen::Vector3d& wo :
       {Eigen::Vector3d(0, 0, 1), Eigen::Vector3d(0, 1, 0),
        Eigen::Vector3d(0, -1, 0), Eigen::Vector3d(-0.6, 0.3, -0.7)}) {
    for (const double degrees : {0.0, 1e-4, 30.0, 60.0, 85.0, 89.9}) {
      const Eigen::Vector3d o = wo.normalized(), t = o.unitOrthogonal();
      const double theta = degrees * kPi / 180, phi = 1.0 + degrees;
      ShadingPoint p = PointAt(0.0, 0.0);
      p.wo = o.cast<float>();
      p.normal =
          (std::cos(theta) * o +
           std::sin(theta) * (std::cos(phi) * t + std::sin(phi) * o.cross(t)))
              .cast<float>();
      points.push_back(p);
    }
  }
  return points;
}

inline std::vector<ShadingPoint> SpherePoints(int size) {
  return FindShadingPoints(Scene::UnitSphere(), Camera(), size, size, Mask(), 1)
      .value();
}

// Half-vector quadrature over the whole hemisphere, with no partition, no cells
// and its own geometry: the slow independent answer.
inline Eigen::Array3d BruteForceRadiance(const ShadingPoint& point,
                                         const BrdfFunction& brdf,
                                         const Image& map, int rings,
                                         int samples) {
  const Eigen::Vector3d n = point.normal.cast<double>().normalized();
  const Eigen::Vector3d wo = point.wo.cast<double>().normalized();
  const Eigen::Vector3d t = n.unitOrthogonal();
  const Eigen::Vector3d b = n.cross(t);
  const Eigen::Vector3d local_wo(wo.dot(t), wo.dot(b), wo.dot(n));
  Eigen::Array3d sum = Eigen::Array3d::Zero();
  for (int i = 0; i < rings; ++i) {
    const double inner = std::pow(static_cast<double>(i) / rings, 3) * kPi / 2;
    const double outer = std::pow((i + 1.0) / rings, 3) * kPi / 2;
    const double theta = 0.5 * (inner + outer);
    const double solid_angle =
        (std::cos(inner) - std::cos(outer)) * 2 * kPi / samples;
    for (int k = 0; k < samples; ++k) {
      const double phi = 2 * kPi * (k + 0.5) / samples;
      const Eigen::Vector3d h(std::sin(theta) * std::cos(phi),
                              std::sin(theta) * std::sin(phi), std::cos(theta));
      const double oh = h.dot(local_wo);
      const Eigen::Vector3d wi = 2 * oh * h - local_wo;
      if (oh <= 0 || wi.z() <= 0) continue;
      const HalfDiff a = ToHalfDiff(wi, local_wo);
      const Eigen::Vector3d world = wi.x() * t + wi.y() * b + wi.z() * n;
      sum += 4 * oh * wi.z() * solid_angle *
             brdf(a.theta_h, a.theta_d, a.phi_d) * LookUpMap(map, world);
    }
  }
  return sum;
}

// Radiance [points, 3] by Transport.
inline std::vector<double> Direct(const std::vector<ShadingPoint>& points,
                                  const BrdfGrid& grid, const Image& map) {
  TransportOptions options;
  options.grid = grid.shape;
  std::vector<double> L_o(3 * points.size());
  Transport(points, map.height, map.width, options)
      .Render(grid, map.rgb.data(), L_o.data());
  return L_o;
}

}  // namespace testing
}  // namespace ibrdf
