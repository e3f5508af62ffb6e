#include "ibrdf/solvers/paint/shading_light.h"

#include <algorithm>
#include <cmath>
#include <random>

#include "ibrdf/base/pi.h"
#include "ibrdf/solvers/paint/chroma_plane.h"

namespace ibrdf {
namespace {

constexpr double kMinCosine = 0.2;
// Colours are alike within this deviation of log chroma; of pairs, those that
// differ by less than 1.5 of it take part.
constexpr double kColourLength = 0.06;
constexpr size_t kPairs = 5000, kFewestPairs = 200, kTries = 400000;
// Of log luminance: what shadows, bounces and a paint's own variation make is
// beyond it.
constexpr double kRobust = 0.15;
// The lamp must explain this share of what it costs to have none.
constexpr double kLeastExplained = 0.25;
constexpr int kDirections = 300;
constexpr double kStrengths[] = {1.0, 4.0, 16.0, 64.0};
// Half the width, in cosine, in which a lamp sets.
constexpr double kSoftness = 0.015;
constexpr double kFirstStep = 0.1, kLastStep = 0.005;

struct Pair {
  int first, second;
  double weight;
};

// What takes part: normals, log luminances and pairs of like colour.
struct Shading {
  std::vector<Eigen::Vector3d> normals;
  std::vector<double> luminance;
  std::vector<Pair> pairs;
};

Shading PairsOfLikeColour(const std::vector<ShadingPoint>& points,
                          const Observations& observed) {
  Shading all;
  std::vector<Eigen::Array2d> chroma;
  for (size_t i = 0; i < points.size(); ++i) {
    const Eigen::Vector3d n = points[i].normal.cast<double>();
    if (!observed.valid[i] || n.dot(points[i].wo.cast<double>()) < kMinCosine) {
      continue;
    }
    const Eigen::Array3d log_radiance =
        Eigen::Map<const Eigen::Array3d>(&observed.radiance[3 * i]).log();
    all.normals.push_back(n);
    all.luminance.push_back(log_radiance.mean());
    chroma.push_back(ChromaPlane(log_radiance));
  }
  if (all.normals.empty()) return all;
  std::mt19937_64 bits(1);
  const auto draw = [&] {
    return static_cast<int>(bits() % all.normals.size());
  };
  for (size_t k = 0; k < kTries && all.pairs.size() < kPairs; ++k) {
    const int first = draw(), second = draw();
    const double distance = (chroma[first] - chroma[second]).matrix().norm();
    if (first == second || distance > 1.5 * kColourLength) continue;
    const double lengths = distance / kColourLength;
    all.pairs.push_back({first, second, std::exp(-0.5 * lengths * lengths)});
  }
  return all;
}

// The part of the pixels that pairs hold.
Shading Compact(const Shading& all) {
  Shading used;
  std::vector<int> place(all.normals.size(), -1);
  const auto take = [&](int i) {
    if (place[i] < 0) {
      place[i] = static_cast<int>(used.normals.size());
      used.normals.push_back(all.normals[i]);
      used.luminance.push_back(all.luminance[i]);
    }
    return place[i];
  };
  for (const Pair& pair : all.pairs) {
    const int first = take(pair.first);
    used.pairs.push_back({first, take(pair.second), pair.weight});
  }
  return used;
}

double Cost(const Shading& shading, const ShadingLight& light) {
  std::vector<double> left;
  left.reserve(shading.normals.size());
  for (size_t i = 0; i < shading.normals.size(); ++i) {
    const double cosine = shading.normals[i].dot(light.direction);
    const double lit = 0.5 * (cosine + std::hypot(cosine, 2.0 * kSoftness));
    left.push_back(shading.luminance[i] - std::log1p(light.strength * lit));
  }
  double cost = 0.0;
  for (const Pair& pair : shading.pairs) {
    const double r = (left[pair.first] - left[pair.second]) / kRobust;
    cost += pair.weight * std::log1p(r * r);
  }
  return cost;
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

// Steps along the tangent plane and in log strength while they gain.
ShadingLight Improve(const Shading& shading, ShadingLight best, double cost) {
  for (double step = kFirstStep; step > kLastStep; step *= 0.5) {
    for (bool gained = true; gained;) {
      gained = false;
      for (int k = 0; k < 6; ++k) {
        ShadingLight next = best;
        const double by = k % 2 == 0 ? step : -step;
        const Eigen::Vector3d axis = best.direction.unitOrthogonal();
        if (k / 2 == 0) next.direction += by * axis;
        if (k / 2 == 1) next.direction += by * best.direction.cross(axis);
        if (k / 2 == 2) next.strength *= std::exp(5.0 * by);
        next.direction.normalize();
        const double of_next = Cost(shading, next);
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

std::optional<ShadingLight> FindShadingLight(
    const std::vector<ShadingPoint>& points, const Observations& observed) {
  const Shading shading = Compact(PairsOfLikeColour(points, observed));
  if (shading.pairs.size() < kFewestPairs) return std::nullopt;
  const double flat = Cost(shading, ShadingLight());
  ShadingLight best;
  double least = flat;
  for (const Eigen::Vector3d& direction : Directions()) {
    for (const double strength : kStrengths) {
      const ShadingLight light = {direction, strength};
      const double cost = Cost(shading, light);
      if (cost >= least) continue;
      least = cost;
      best = light;
    }
  }
  if (!(least < (1.0 - kLeastExplained) * flat)) return std::nullopt;
  return Improve(shading, best, least);
}

}  // namespace ibrdf
