#include "ibrdf/light/procedural_sky.h"

#include <glog/logging.h>

#include <algorithm>
#include <cmath>
#include <vector>

#include "ibrdf/base/pi.h"
#include "ibrdf/light/environment_map.h"

namespace ibrdf {
namespace {

// Beyond so many radii the sun's profile exp(-x^4) is below 1e-7.
constexpr double kSunReach = 2.0;
// Samples across the sun's radius in the average over a texel.
constexpr double kSamplesPerRadius = 4.0;

const Eigen::Array3d kSunColour(1.0, 0.93, 0.80);
const Eigen::Array3d kZenithColour(0.45, 0.75, 1.30);
const Eigen::Array3d kHorizonColour(1.15, 1.10, 1.00);
const Eigen::Array3d kGroundColour(1.00, 0.85, 0.65);
const Eigen::Array3d kWallColour(0.55, 0.45, 0.40);
const Eigen::Array3d kWindowColour(1.60, 1.05, 0.45);

// 0 below, 1 above, half a unit of `softness` wide on either side.
double Step(double x, double softness) {
  return 1.0 / (1.0 + std::exp(-std::clamp(4.0 * x / softness, -60.0, 60.0)));
}

double WrappedDifference(double a, double b) {
  return std::remainder(a - b, 2.0 * kPi);
}

// An ellipse with soft edges on the sphere, in degrees.
struct Cloud {
  double phi, elevation, half_width, half_height, cover;
};
constexpr Cloud kClouds[] = {
    {15, 34, 24, 7, 0.8},   {38, 42, 13, 5, 0.6},  {112, 20, 30, 5, 0.7},
    {170, 48, 18, 10, 0.9}, {205, 26, 26, 6, 0.6}, {262, 56, 20, 9, 0.7},
    {300, 30, 22, 8, 0.8},  {335, 66, 16, 8, 0.5},
};

struct Building {
  double phi, half_width, height;
};
constexpr Building kBuildings[] = {
    {5, 7, 12},   {24, 5, 20},  {48, 9, 9},   {95, 6, 16},   {118, 10, 24},
    {150, 8, 11}, {215, 6, 28}, {232, 9, 15}, {280, 12, 10}, {322, 7, 22},
};
// A lit front on every second building.
constexpr double kWindowElevation = 0.55;  // of the building's height

double CloudCover(double phi, double elevation) {
  double clear = 1.0;
  for (const Cloud& c : kClouds) {
    const double x = WrappedDifference(phi, c.phi * kDegree) *
                     std::cos(elevation) / (c.half_width * kDegree);
    const double y =
        (elevation - c.elevation * kDegree) / (c.half_height * kDegree);
    // A ripple along the cloud keeps it from being an ellipse.
    const double r = x * x + y * y + 0.25 * std::sin(5.0 * x + 2.0 * y);
    clear *= 1.0 - c.cover * std::exp(-r * std::sqrt(r * r + 0.1));
  }
  return std::clamp(1.0 - clear, 0.0, 1.0);
}

// A direction as the sky sees it; angles in radians.
struct SkyView {
  Eigen::Vector3d direction;
  double elevation, phi, to_sun;
  double ground_irradiance;  // W/m^2
};

constexpr double kSoft = 1.5 * kDegree;

double GroundIrradiance(const SkyOptions& options) {
  return kPi * options.zenith_radiance +
         options.sun_irradiance *
             std::max(std::cos(options.sun_theta_degrees * kDegree), 0.0);
}

// The clear sky and the sun's glow.
Eigen::Array3d ClearSky(const SkyOptions& options, const SkyView& view) {
  const double height = std::max(view.direction.y(), 0.0);
  const double horizon = std::exp(-height / (0.12 + 0.25 * options.haze));
  const double glow_width = (8.0 + 20.0 * options.haze) * kDegree;
  const double glow =
      0.15 * options.sun_irradiance * std::exp(-view.to_sun / glow_width);
  return options.zenith_radiance *
             ((1.0 - 0.5 * options.haze) * kZenithColour * (1.0 - horizon) +
              (1.2 + 1.3 * options.haze) * kHorizonColour * horizon) +
         glow * kSunColour;
}

void AddClouds(const SkyOptions& options, const SkyView& view,
               Eigen::Array3d* sky) {
  const double cover =
      options.clouds * CloudCover(view.phi, std::max(view.elevation, 0.0));
  const double lit = 0.6 + 0.9 * std::pow(0.5 + 0.5 * std::cos(view.to_sun), 3);
  const Eigen::Array3d cloud =
      lit * (options.zenith_radiance * 1.6 + 0.12 * options.sun_irradiance) *
      Eigen::Array3d(1.05, 1.0, 0.97);
  *sky += cover * (cloud - *sky);
}

Eigen::Array3d Ground(const SkyOptions& options, const SkyView& view) {
  const Eigen::Vector3d& direction = view.direction;
  // Broad fields and paths on the ground.
  const double texture = 1.0 +
                         0.35 * std::sin(3.0 * direction.x() + 1.0) *
                             std::cos(4.0 * direction.z()) +
                         0.15 * std::sin(9.0 * direction.x() * direction.z());
  return (0.01 + options.ground_albedo * texture) * view.ground_irradiance /
         kPi * kGroundColour;
}

void AddBuilding(const SkyOptions& options, const SkyView& view,
                 const Building& building, bool has_windows,
                 Eigen::Array3d* radiance) {
  const double top = building.height * options.skyline * kDegree;
  const double across =
      building.half_width * kDegree -
      std::abs(WrappedDifference(view.phi, building.phi * kDegree));
  // Facing the sun: a wall is lit by what comes from the other side.
  const double facing =
      0.5 - 0.5 * std::cos((building.phi - options.sun_phi_degrees) * kDegree);
  const Eigen::Array3d wall =
      (0.15 + 0.5 * facing) * view.ground_irradiance / kPi * kWallColour;
  const double inside =
      Step(across, kSoft) * Step(top - view.elevation, kSoft) *
      Step(view.elevation, kSoft) * std::min(options.skyline * 4.0, 1.0);
  *radiance += inside * (wall - *radiance);
  if (!has_windows) return;
  const double window =
      inside *
      std::exp(-std::pow((view.elevation - kWindowElevation * top) /
                             (0.2 * top + 0.5 * kDegree),
                         2)) *
      Step(across - 0.4 * building.half_width * kDegree, kSoft);
  *radiance +=
      window * 2.0 * options.zenith_radiance * options.skyline * kWindowColour;
}

}  // namespace

Eigen::Array3d SkyRadiance(const SkyOptions& options,
                           const Eigen::Vector3d& direction) {
  const Eigen::Vector3d sun = MapDirection(options.sun_theta_degrees,
                                           options.sun_phi_degrees, 180, 360);
  const SkyView view = {direction,
                        std::asin(std::clamp(direction.y(), -1.0, 1.0)),
                        std::atan2(direction.x(), direction.z()),
                        std::acos(std::clamp(direction.dot(sun), -1.0, 1.0)),
                        GroundIrradiance(options)};
  Eigen::Array3d sky = ClearSky(options, view);
  AddClouds(options, view, &sky);
  const Eigen::Array3d ground = Ground(options, view);
  Eigen::Array3d radiance =
      ground + Step(view.elevation, kSoft) * (sky - ground);
  for (size_t b = 0; b < std::size(kBuildings); ++b) {
    AddBuilding(options, view, kBuildings[b], b % 2 == 0, &radiance);
  }
  return radiance;
}

Image RenderSky(const SkyOptions& options, int height, int width) {
  CHECK(height > 0 && width > 0);
  Image map(width, height);
  const Eigen::Vector3d sun = MapDirection(options.sun_theta_degrees,
                                           options.sun_phi_degrees, 180, 360);
  const double radius = options.sun_radius_degrees * kDegree;
  const double step = kPi / height;
  const int fine = std::max(
      1, static_cast<int>(std::ceil(step * kSamplesPerRadius / radius)));
  std::vector<double> share(map.num_pixels(), 0.0);  // mean of the profile
  double total = 0.0;
  for (int r = 0; r < height; ++r) {
    for (int c = 0; c < width; ++c) {
      const Eigen::Vector3d w = MapDirection(r + 0.5, c + 0.5, height, width);
      const Eigen::Array3d L = SkyRadiance(options, w);
      for (int k = 0; k < 3; ++k) map.At(c, r)[k] = static_cast<float>(L[k]);
      // A texel's corners are within its longer side of its centre.
      const double extent = std::max(step, 2.0 * kPi / width);
      if (std::acos(std::clamp(w.dot(sun), -1.0, 1.0)) >
          kSunReach * radius + extent) {
        continue;
      }
      const int across = fine * std::max(1, (2 * height + width - 1) / width);
      double sum = 0.0, weights = 0.0;
      for (int y = 0; y < fine; ++y) {
        const double row = r + (y + 0.5) / fine;
        const double weight = std::sin(kPi * row / height);
        for (int x = 0; x < across; ++x) {
          const Eigen::Vector3d v =
              MapDirection(row, c + (x + 0.5) / across, height, width);
          // The chord is precise where the cosine is not.
          const double angle =
              2.0 * std::asin(std::min(0.5 * (v - sun).norm(), 1.0));
          sum += weight * std::exp(-std::pow(angle / radius, 4));
          weights += weight;
        }
      }
      const size_t texel = static_cast<size_t>(r) * width + c;
      share[texel] = sum / weights;
      total += share[texel] * TexelSolidAngle(r, height, width);
    }
  }
  CHECK_GT(total, 0.0);
  for (size_t t = 0; t < share.size(); ++t) {
    for (int k = 0; k < 3; ++k) {
      map.rgb[3 * t + k] += static_cast<float>(
          share[t] * options.sun_irradiance * kSunColour[k] / total);
    }
  }
  return map;
}

}  // namespace ibrdf
