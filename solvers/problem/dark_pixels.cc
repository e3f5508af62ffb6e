#include "ibrdf/solvers/problem/dark_pixels.h"

#include <algorithm>
#include <cmath>
#include <vector>

#include "ibrdf/base/median.h"
#include "ibrdf/base/pi.h"
#include "ibrdf/light/environment_map.h"
#include "ibrdf/transport/quadrature.h"

namespace ibrdf {
namespace {

// Irradiance over the largest of the object. Below the first there is no light;
// below the second, or a texel's height in radians if that is less, it is not
// known to a factor.
constexpr double kNoLight = 1e-3;
constexpr double kMostPenumbra = 0.05;
// What the weakest texels that are left out may give together.
constexpr double kLeftOut = 0.1 * kNoLight;
// Points at which the largest irradiance is looked for.
constexpr size_t kProbes = 256;
// Stray light is measured from so many points at least.
constexpr size_t kLeastPoints = 8;
// Stray light differs over the object at least by this share.
constexpr double kLeastDeviation = 0.1;
constexpr double kLeastOfOthers = 0.01;  // of the other channels' deviation
constexpr double kFloorSpreads = 3.0;
// Of the lit pixels' radiance: what no camera tells from black.
constexpr double kBlack = 1e-6;

// The texels of a map that light anything, the strongest first.
class Lights {
 public:
  Lights(const Image& map, const TransportOptions& transport);

  // Irradiance of a point, all channels together; it may stop once it is above
  // `enough`.
  double Irradiance(const ShadingPoint& point, double enough) const;
  // Whether parts of the object, which may light it, are in a point's sky.
  bool SeesObject(const ShadingPoint& point) const {
    return visibility_ != nullptr && visibility_->Hidden(point) != nullptr;
  }

 private:
  struct Source {
    Eigen::Vector3d direction;  // unit
    double power;               // radiance times solid angle
    GridRange range;            // of the visibility's grid
  };

  const Visibility* const visibility_;
  double texel_;  // height, radians
  std::vector<Source> sources_;
};

Lights::Lights(const Image& map, const TransportOptions& transport)
    : visibility_(transport.visibility.get()), texel_(kPi / map.height) {
  double total = 0.0;
  for (int row = 0; row < map.height; ++row) {
    const double solid_angle = TexelSolidAngle(row, map.height, map.width);
    for (int column = 0; column < map.width; ++column) {
      const float* rgb =
          map.rgb.data() + 3 * (size_t{1} * row * map.width + column);
      double radiance = 0.0;
      for (int c = 0; c < 3; ++c) radiance += std::max(rgb[c], 0.0f);
      if (!(radiance > 0.0)) continue;
      Source source;
      source.direction =
          MapDirection(row + 0.5, column + 0.5, map.height, map.width);
      source.power = radiance * solid_angle;
      if (visibility_ != nullptr) {
        source.range =
            visibility_->grid().RangeOf(row, column, map.height, map.width);
      }
      total += source.power;
      sources_.push_back(source);
    }
  }
  std::stable_sort(
      sources_.begin(), sources_.end(),
      [](const Source& a, const Source& b) { return a.power > b.power; });
  double rest = 0.0;
  while (!sources_.empty() && rest + sources_.back().power < kLeftOut * total) {
    rest += sources_.back().power;
    sources_.pop_back();
  }
}

double Lights::Irradiance(const ShadingPoint& point, double enough) const {
  const Eigen::Vector3d n = point.normal.cast<double>().normalized();
  const uint64_t* const hidden =
      visibility_ != nullptr ? visibility_->Hidden(point) : nullptr;
  double sum = 0.0;
  for (const Source& source : sources_) {
    // A transport's light is linear between texels, and reaches as far.
    double cosine = MeanClippedCosine(n.dot(source.direction), texel_);
    if (cosine <= 0.0) continue;
    if (hidden != nullptr) {
      cosine *= visibility_->grid().VisibleShare(hidden, n, source.range);
    }
    sum += source.power * cosine;
    if (sum > enough) break;
  }
  return sum;
}

// A channel's values at the points of this lighting, less what is no number.
std::vector<double> ValuesOf(const Image& image,
                             const std::vector<ShadingPoint>& points,
                             const std::vector<Lighting>& lighting, Lighting of,
                             int channel) {
  std::vector<double> values;
  for (size_t i = 0; i < points.size(); ++i) {
    const double v = image.rgb[size_t{3} * points[i].pixel + channel];
    if (lighting[i] == of && std::isfinite(v)) values.push_back(v);
  }
  return values;
}

}  // namespace

std::vector<Lighting> FindLighting(const std::vector<ShadingPoint>& points,
                                   const Image& map,
                                   const TransportOptions& transport) {
  const Lights lights(map, transport);
  const size_t step = points.size() / kProbes + 1;
  double largest = 0.0;
  for (size_t i = 0; i < points.size(); i += step) {
    largest = std::max(largest, lights.Irradiance(points[i], HUGE_VAL));
  }
  const double penumbra = largest * std::min(kPi / map.height, kMostPenumbra);
  const bool bounces = transport.patches != nullptr;
  std::vector<Lighting> lighting(points.size(), Lighting::kLit);
  bool any = false;
  for (size_t i = 0; i < points.size(); ++i) {
    if (bounces && lights.SeesObject(points[i])) continue;
    const double irradiance = lights.Irradiance(points[i], penumbra);
    if (irradiance > penumbra) continue;
    const bool none = !(irradiance > kNoLight * largest);
    lighting[i] = none ? Lighting::kNone : Lighting::kPenumbra;
    any |= none;
  }
  if (!any) lighting.assign(points.size(), Lighting::kLit);
  return lighting;
}

StrayLight MeasureStrayLight(const Image& image,
                             const std::vector<ShadingPoint>& points,
                             const std::vector<Lighting>& lighting) {
  StrayLight stray;
  for (int c = 0; c < 3; ++c) {
    std::vector<double> values =
        ValuesOf(image, points, lighting, Lighting::kNone, c);
    if (values.size() < kLeastPoints) return {};
    const std::vector<double> lit =
        ValuesOf(image, points, lighting, Lighting::kLit, c);
    const double black = lit.empty() ? 0.0 : kBlack * UpperMedian(lit);
    const double median = UpperMedian(values);
    stray.ambient[c] = median > black ? median : 0.0;
    for (double& v : values) v = std::abs(v - stray.ambient[c]);
    stray.spread[c] = kDeviationOverMad * UpperMedian(std::move(values));
  }
  if (!(stray.ambient > 0.0).any()) return {};
  stray.deviation = stray.spread.max(kLeastDeviation * stray.ambient);
  stray.deviation =
      stray.deviation.max(kLeastOfOthers * stray.deviation.maxCoeff());
  return stray;
}

bool IsBelowFloor(const Eigen::Array3d& radiance, const StrayLight& stray) {
  return (radiance < stray.ambient + kFloorSpreads * stray.spread).all();
}

}  // namespace ibrdf
