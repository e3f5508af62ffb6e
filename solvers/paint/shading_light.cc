#include "ibrdf/solvers/paint/shading_light.h"

#include <algorithm>
#include <cmath>

#include "ibrdf/base/pi.h"
#include "ibrdf/solvers/paint/chroma_plane.h"
#include "ibrdf/solvers/paint/like_colours.h"

namespace ibrdf {
namespace {

constexpr double kMinCosine = 0.2;
// Colours are alike within this deviation of log chroma. First to find a lamp
// by luminance; then wider, as the lamp's colour moves a paint's chroma between
// light and shade.
constexpr double kLikeColour = 0.06, kLikePaint = 0.15;
// What shadows, bounces and a paint's own variation make of log luminance and
// log chroma is beyond these.
constexpr double kRobustLuminance = 0.15, kRobustChroma = 0.05;
// The lamp must explain this share of what it costs to have none.
constexpr double kLeastExplained = 0.1;
constexpr int kDirections = 300;
constexpr double kStrengths[] = {1.0, 4.0, 16.0, 64.0};
// Beyond it the room is black; and deviation of the lamp's log chroma, a prior
// as strong as so many pairs.
constexpr double kMostStrength = 100.0, kChromaStd = 0.2, kPriorPairs = 20.0;
// Half the width, in cosine, in which a lamp sets.
constexpr double kSoftness = 0.015;
constexpr double kFirstStep = 0.1, kLastStep = 0.003;

// What takes part: normals, log radiances and pairs of like colour.
struct Shading {
  std::vector<Eigen::Vector3d> normals;
  std::vector<Eigen::Array3d> log_radiance;
  std::vector<ColourPair> pairs;
};

Shading Facing(const std::vector<ShadingPoint>& points,
               const Observations& observed) {
  Shading all;
  for (size_t i = 0; i < points.size(); ++i) {
    const Eigen::Vector3d n = points[i].normal.cast<double>();
    if (!observed.valid[i] || n.dot(points[i].wo.cast<double>()) < kMinCosine) {
      continue;
    }
    all.normals.push_back(n);
    all.log_radiance.push_back(
        Eigen::Map<const Eigen::Array3d>(&observed.radiance[3 * i]).log());
  }
  return all;
}

// Pairs whose colours under the light at hand differ little, and the pixels
// that they hold.
Shading PixelsOfLikeColour(const Shading& all, const ShadingLight& light,
                           double like) {
  Shading used;
  std::vector<Eigen::Array2d> chroma;
  for (size_t i = 0; i < all.normals.size(); ++i) {
    chroma.push_back(ChromaPlane(all.log_radiance[i] -
                                 Irradiance(light, all.normals[i]).log()));
  }
  std::vector<int> place(all.normals.size(), -1);
  const auto take = [&](int i) {
    if (place[i] < 0) {
      place[i] = static_cast<int>(used.normals.size());
      used.normals.push_back(all.normals[i]);
      used.log_radiance.push_back(all.log_radiance[i]);
    }
    return place[i];
  };
  for (const ColourPair& pair : PairsOfLikeColour(chroma, like)) {
    const int a = take(pair.first), b = take(pair.second);
    used.pairs.push_back({a, b, pair.weight});
  }
  return used;
}

// with_chroma: of both, else of luminance alone.
double Cost(const Shading& shading, const ShadingLight& light,
            bool with_chroma) {
  std::vector<Eigen::Array3d> left;
  left.reserve(shading.normals.size());
  for (size_t i = 0; i < shading.normals.size(); ++i) {
    left.push_back(shading.log_radiance[i] -
                   Irradiance(light, shading.normals[i]).log());
  }
  double cost = 0.0;
  for (const ColourPair& pair : shading.pairs) {
    const Eigen::Array3d r = left[pair.first] - left[pair.second];
    const double luminance = r.mean();
    double misfit = std::log1p(luminance * luminance /
                               (kRobustLuminance * kRobustLuminance));
    if (with_chroma) {
      misfit += std::log1p((r - luminance).square().sum() /
                           (kRobustChroma * kRobustChroma));
    }
    cost += pair.weight * misfit;
  }
  return cost + 0.5 * kPriorPairs * light.chroma.square().sum() /
                    (kChromaStd * kChromaStd);
}

// Spread evenly over the sphere.
std::vector<Eigen::Vector3d> Directions() {
  std::vector<Eigen::Vector3d> out;
  const double golden = kPi * (1.0 + std::sqrt(5.0));
  for (int k = 0; k < kDirections; ++k) {
    const double z = 1.0 - 2.0 * (k + 0.5) / kDirections;
    const double radius = std::sqrt(1.0 - z * z);
    out.emplace_back(radius * std::cos(golden * k),
                     radius * std::sin(golden * k), z);
  }
  return out;
}

// The light after a step along one of its five parameters.
ShadingLight Stepped(const ShadingLight& light, int parameter, double step) {
  ShadingLight next = light;
  const Eigen::Vector3d axis = light.direction.unitOrthogonal();
  if (parameter == 0) next.direction += step * axis;
  if (parameter == 1) next.direction += step * light.direction.cross(axis);
  if (parameter == 2) {
    next.strength =
        std::min(light.strength * std::exp(5.0 * step), kMostStrength);
  }
  if (parameter >= 3) next.chroma[parameter - 3] += step;
  next.direction.normalize();
  return next;
}

// Steps while they gain, ever smaller ones.
ShadingLight Improve(const Shading& shading, ShadingLight best) {
  double cost = Cost(shading, best, true);
  for (double step = kFirstStep; step > kLastStep; step *= 0.5) {
    for (bool gained = true; gained;) {
      gained = false;
      for (int k = 0; k < 10; ++k) {
        const ShadingLight next =
            Stepped(best, k / 2, k % 2 == 0 ? step : -step);
        const double of_next = Cost(shading, next, true);
        if (of_next >= cost) continue;
        best = next;
        cost = of_next;
        gained = true;
      }
    }
  }
  return best;
}

}  // namespace

Eigen::Array3d Irradiance(const ShadingLight& light,
                          const Eigen::Vector3d& normal) {
  const double cosine = normal.dot(light.direction);
  const double lit = 0.5 * (cosine + std::hypot(cosine, 2.0 * kSoftness));
  return 1.0 + light.strength * lit * FromChromaPlane(light.chroma).exp();
}

std::optional<ShadingLight> FindShadingLight(
    const std::vector<ShadingPoint>& points, const Observations& observed) {
  const Shading all = Facing(points, observed);
  const Shading alike = PixelsOfLikeColour(all, ShadingLight(), kLikeColour);
  if (alike.pairs.size() < kFewestColourPairs) return std::nullopt;
  const double flat = Cost(alike, ShadingLight(), false);
  ShadingLight best;
  double least = flat;
  for (const Eigen::Vector3d& direction : Directions()) {
    for (const double strength : kStrengths) {
      ShadingLight light;
      light.direction = direction;
      light.strength = strength;
      const double cost = Cost(alike, light, false);
      if (cost >= least) continue;
      least = cost;
      best = light;
    }
  }
  if (!(least < (1.0 - kLeastExplained) * flat)) return std::nullopt;
  return Improve(PixelsOfLikeColour(all, best, kLikePaint), best);
}

}  // namespace ibrdf
