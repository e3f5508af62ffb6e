#include "ibrdf/solvers/report/brdf_sphere.h"

#include <glog/logging.h>

#include <Eigen/Geometry>
#include <algorithm>
#include <cmath>
#include <utility>

#include "ibrdf/base/parallel_for.h"
#include "ibrdf/base/pi.h"
#include "ibrdf/geometry/camera.h"
#include "ibrdf/geometry/half_diff.h"
#include "ibrdf/light/environment_map.h"
#include "ibrdf/render/reference_renderer.h"
#include "ibrdf/scene/scene.h"
#include "ibrdf/solvers/estimation/pixel_renders.h"
#include "ibrdf/transport/transport.h"

namespace ibrdf {
namespace {

constexpr size_t kPointsAtOnce = 1024;

std::vector<ShadingPoint> SpherePoints(int size, int samples_per_side) {
  CHECK_GT(size, 1);
  CHECK_GT(samples_per_side, 0);
  StatusOr<std::vector<ShadingPoint>> points = FindShadingPoints(
      Scene::UnitSphere(), Camera(), size, size, Mask(), samples_per_side);
  CHECK(points.ok()) << points.status().message();
  return *std::move(points);
}

double SmoothStep(double begin, double end, double x) {
  const double t = std::clamp((x - begin) / (end - begin), 0.0, 1.0);
  return t * t * (3.0 - 2.0 * t);
}

// Radiance of ProceduralSky in a unit direction.
Eigen::Array3d SkyRadiance(const Eigen::Vector3d& d) {
  const double azimuth = std::atan2(d.x(), d.z());
  const double up = d.y();
  const Eigen::Array3d zenith(0.18, 0.36, 0.80), horizon(0.85, 0.90, 1.0);
  const Eigen::Array3d ground(0.16, 0.12, 0.08), hill(0.07, 0.09, 0.05);

  Eigen::Array3d sky = zenith + (horizon - zenith) * std::exp(-4.0 * up);
  const double clouds = std::sin(3.0 * azimuth + 9.0 * up) +
                        std::sin(7.0 * azimuth - 14.0 * up + 1.0) +
                        0.7 * std::sin(13.0 * azimuth + 21.0 * up + 2.0);
  // No clouds near the zenith, where azimuth has no meaning.
  const double cover =
      SmoothStep(0.6, 1.8, clouds) * (1.0 - SmoothStep(0.5, 0.8, up));
  sky += cover * (Eigen::Array3d(1.5, 1.45, 1.4) - sky);

  static const Eigen::Vector3d sun =
      Eigen::Vector3d(-0.55, 0.6, 0.6).normalized();
  const double from_sun = std::acos(std::clamp(d.dot(sun), -1.0, 1.0));
  const double disk = std::exp(-0.5 * std::pow(from_sun / 0.06, 2));
  const double glow = std::exp(-0.5 * std::pow(from_sun / 0.35, 2));
  sky += 60.0 * disk * Eigen::Array3d(1.0, 0.93, 0.80) +
         0.6 * glow * Eigen::Array3d(1.0, 0.95, 0.85);

  const double skyline = 0.07 + 0.05 * std::sin(2.0 * azimuth + 0.5) +
                         0.03 * std::sin(5.0 * azimuth);
  const double below = 1.0 - SmoothStep(skyline - 0.02, skyline + 0.02, up);
  const Eigen::Array3d land =
      hill + SmoothStep(0.0, 0.25, -up) * (ground - hill);
  return sky + below * (land - sky);
}

Eigen::Array3d RadianceAt(const ShadingPoint& point, const BrdfFunction& brdf,
                          const std::vector<DirectionalLight>& lights) {
  const Eigen::Vector3d n = point.normal.cast<double>().normalized();
  // The BRDF is isotropic: any tangents do.
  Eigen::Matrix3d local_from_world;
  local_from_world.row(0) = n.unitOrthogonal();
  local_from_world.row(1) = n.cross(local_from_world.row(0).transpose());
  local_from_world.row(2) = n;
  const Eigen::Vector3d wo =
      local_from_world * point.wo.cast<double>().normalized();
  Eigen::Array3d radiance = Eigen::Array3d::Zero();
  for (const DirectionalLight& light : lights) {
    const Eigen::Vector3d wi = local_from_world * light.direction.normalized();
    if (wi.z() <= 0.0) continue;
    const HalfDiff angles = ToHalfDiff(wi, wo);
    radiance += brdf(angles.theta_h, angles.theta_d, angles.phi_d) *
                light.irradiance * wi.z();
  }
  return radiance;
}

}  // namespace

std::vector<DirectionalLight> StudioLights() {
  const auto light = [](double x, double y, double z, double strength) {
    return DirectionalLight{Eigen::Vector3d(x, y, z).normalized(),
                            Eigen::Array3d::Constant(strength * kPi)};
  };
  return {light(-0.5, 0.6, 0.7, 1.0), light(0.9, 0.1, 0.5, 0.35),
          light(0.35, 0.55, -0.75, 0.6)};
}

Image ProceduralSky(int height, int width) {
  Image map(width, height);
  for (int row = 0; row < height; ++row) {
    for (int column = 0; column < width; ++column) {
      const Eigen::Array3d radiance =
          SkyRadiance(MapDirection(row + 0.5, column + 0.5, height, width));
      for (int c = 0; c < 3; ++c) {
        map.At(column, row)[c] = static_cast<float>(radiance[c]);
      }
    }
  }
  return map;
}

Image RenderBrdfSphere(const BrdfFunction& brdf,
                       const std::vector<DirectionalLight>& lights, int size,
                       int samples_per_side, int num_threads) {
  const std::vector<ShadingPoint> points = SpherePoints(size, samples_per_side);
  std::vector<double> L_o(3 * points.size());
  const auto chunks = static_cast<int64_t>(points.size() / kPointsAtOnce + 1);
  ParallelFor(chunks, num_threads, [&](int64_t chunk, int) {
    const size_t begin = static_cast<size_t>(chunk) * kPointsAtOnce;
    const size_t end = std::min(begin + kPointsAtOnce, points.size());
    for (size_t i = begin; i < end; ++i) {
      Eigen::Map<Eigen::Array3d>(L_o.data() + 3 * i) =
          RadianceAt(points[i], brdf, lights);
    }
  });
  return PixelMeans(points, L_o.data(), size, size);
}

std::vector<Image> RenderBrdfSpheres(const std::vector<BrdfGrid>& brdfs,
                                     const Image& map, int size,
                                     int num_threads) {
  if (brdfs.empty()) return {};
  const std::vector<ShadingPoint> points = SpherePoints(size, 1);
  TransportOptions options;
  options.grid = brdfs.front().shape;
  options.num_threads = num_threads;
  options.quadrature.near_rings = 14;
  options.quadrature.near_ring_samples = 36;
  options.quadrature.far_width = 32;
  // In such wide cells a sun would leave a ring where the two rules meet.
  const BrightTexels light = SplitBrightTexels(map);
  options.bright = SampleBrightTexels(light.texels, map.height, map.width, 2);
  std::vector<std::vector<double>> L_o(brdfs.size());
  std::vector<PixelRender> renders;
  for (size_t k = 0; k < brdfs.size(); ++k) {
    renders.push_back({{&brdfs[k]}, light.rest.rgb.data(), &L_o[k]});
  }
  RenderPoints(points, {map.width, map.height}, options, renders);
  std::vector<Image> images;
  for (const std::vector<double>& radiance : L_o) {
    images.push_back(PixelMeans(points, radiance.data(), size, size));
  }
  return images;
}

Mask BrdfSphereMask(int size) {
  CHECK_GT(size, 1);
  const auto place = [size](int at) { return 2.0 * (at + 0.5) / size - 1.0; };
  Mask mask(size, size, 0);
  for (int y = 0; y < size; ++y) {
    for (int x = 0; x < size; ++x) {
      const double square = place(x) * place(x) + place(y) * place(y);
      mask.inside[static_cast<size_t>(y) * size + x] = square < 1.0 ? 1 : 0;
    }
  }
  return mask;
}

}  // namespace ibrdf
