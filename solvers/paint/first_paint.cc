#include "ibrdf/solvers/paint/first_paint.h"

#include <Eigen/Core>
#include <algorithm>
#include <array>
#include <cmath>
#include <map>
#include <utility>

#include "ibrdf/base/median.h"
#include "ibrdf/base/pi.h"
#include "ibrdf/solvers/observation/normal_bins.h"
#include "ibrdf/solvers/paint/albedo_fit.h"
#include "ibrdf/solvers/paint/smooth_shading.h"
#include "ibrdf/solvers/priors/directional_lights.h"

namespace ibrdf {
namespace {

constexpr int kMostHighlights = 3;
// A lamp of this ShadingLight::strength makes the light of one colour.
constexpr double kStrongLamp = 5.0;
// Bins of like normals: of the disc of visible ones, and of points in each.
constexpr int kBinsAcross = 24;
constexpr size_t kFewestOfBin = 8;
constexpr double kLeastCosine = 0.2;
// About a highlight's middle, of mirrored directions: where its light shows.
constexpr double kHighlight = 15.0 * kDegree, kRim = 25.0 * kDegree;
// A highlight is by so much brighter than the median of its rim and than the
// object's brightest paint, and no larger share of the object.
constexpr double kContrast = 1.3, kMostOfObject = 0.03;
// Nats of ColourEntropy by which paint is simpler. Two that differ by less are
// as simple, and the light of one lamp and a room holds where there are
// shadows.
constexpr double kFewerColours = 0.1;
// So many of the object's points are no brighter than its brightest paint.
constexpr double kBrightest = 0.95;

double SumAt(const std::vector<double>& radiance, size_t point) {
  return radiance[3 * point] + radiance[3 * point + 1] +
         radiance[3 * point + 2];
}

// Brighter than so much of the object, one is no paint of it.
double BrightestPaint(const std::vector<double>& unshaded) {
  std::vector<double> sums;
  for (size_t i = 0; i < unshaded.size() / 3; ++i) {
    const double sum = SumAt(unshaded, i);
    if (std::isfinite(sum)) sums.push_back(sum);
  }
  if (sums.empty()) return 0.0;
  const auto at =
      sums.begin() + static_cast<ptrdiff_t>(kBrightest * (sums.size() - 1));
  std::nth_element(sums.begin(), at, sums.end());
  return *at;
}

// The points about a highlight that are brighter than any paint; empty where
// they are too many to be one.
std::vector<size_t> HighlightOf(const Eigen::Vector3d& light,
                                const std::vector<ShadingPoint>& points,
                                const std::vector<double>& unshaded,
                                double brightest) {
  std::vector<size_t> near;
  std::vector<double> rim;
  for (size_t i = 0; i < points.size(); ++i) {
    const Eigen::Vector3d n = points[i].normal.cast<double>();
    const Eigen::Vector3d wo = points[i].wo.cast<double>();
    const double cosine = light.dot(2.0 * n.dot(wo) * n - wo);
    const double sum = SumAt(unshaded, i);
    if (cosine < std::cos(kRim) || !std::isfinite(sum)) continue;
    if (cosine < std::cos(kHighlight)) {
      rim.push_back(sum);
    } else {
      near.push_back(i);
    }
  }
  if (rim.empty()) return {};
  const double bright =
      kContrast * std::max(UpperMedian(std::move(rim)), brightest);
  near.erase(
      std::remove_if(near.begin(), near.end(),
                     [&](size_t i) { return SumAt(unshaded, i) <= bright; }),
      near.end());
  const bool large = static_cast<double>(near.size()) >
                     kMostOfObject * static_cast<double>(points.size());
  return large ? std::vector<size_t>() : near;
}

// The image without its highlights. shading: of a matte object [points * 3].
Observations WithoutHighlights(const std::vector<ShadingPoint>& points,
                               const Observations& observed,
                               const std::vector<double>& shading) {
  std::vector<double> unshaded = observed.radiance;
  for (size_t i = 0; i < unshaded.size(); ++i) unshaded[i] /= shading[i];
  const double brightest = BrightestPaint(unshaded);
  Observations out = observed;
  for (const Eigen::Vector3d& light :
       FindDirectionalLights(points, unshaded, kMostHighlights)) {
    for (const size_t i : HighlightOf(light, points, unshaded, brightest)) {
      out.valid[i] = 0;
    }
  }
  out.num_valid =
      static_cast<int>(std::count(out.valid.begin(), out.valid.end(), char{1}));
  return out.num_valid > 0 ? out : observed;
}

// What no light explains: log luminance between image and painted matte object
// about the median of each bin of normals. A deviation from the median of
// absolutes.
double DeviationAtLikeNormals(const std::vector<ShadingPoint>& points,
                              const Observations& observed,
                              const UnpaintedRadiance& unpainted,
                              const std::vector<double>& log_albedo) {
  std::map<std::array<int, 3>, std::vector<double>> bins;  // of each view
  for (size_t i = 0; i < points.size(); ++i) {
    const auto normal = NormalInView(points[i], kLeastCosine);
    if (!observed.valid[i] || !normal) continue;
    double left = 0.0;
    for (size_t k = 3 * i; k < 3 * i + 3; ++k) {
      left +=
          std::log(observed.radiance[k] / unpainted.matte[k]) - log_albedo[k];
    }
    const Eigen::Vector2i bin =
        (*normal * (0.5 * kBinsAcross)).array().floor().cast<int>();
    bins[{points[i].view, bin.x(), bin.y()}].push_back(left / 3.0);
  }
  std::vector<double> deviations;
  for (const auto& [bin, left] : bins) {
    if (left.size() < kFewestOfBin) continue;
    const double middle = UpperMedian(left);
    for (const double l : left) deviations.push_back(std::abs(l - middle));
  }
  return deviations.empty()
             ? 0.0
             : kDeviationOverMad * UpperMedian(std::move(deviations));
}

// FitAlbedo of a matte object in these images, its mean 0 in each channel. What
// drifts is left to the search, which weighs it against the light.
std::vector<double> PaintOf(const std::vector<ShadingPoint>& points,
                            const std::vector<PaintedImage>& images,
                            const std::vector<NeighbourPair>& neighbours,
                            AlbedoFitOptions options) {
  options.luminance_drifts = false;
  std::vector<Observations> matte;
  for (const auto& [unpainted, observed] : images) {
    matte.push_back(WithoutHighlights(points, *observed, unpainted->matte));
  }
  std::vector<PaintedImage> of_matte;
  for (size_t k = 0; k < images.size(); ++k) {
    of_matte.push_back({images[k].unpainted, &matte[k]});
  }
  std::vector<double> log_albedo =
      FitAlbedo(of_matte, neighbours, InViews(options, points));
  Eigen::Map<Eigen::Matrix3Xd> a(log_albedo.data(), 3,
                                 static_cast<Eigen::Index>(points.size()));
  const Eigen::Vector3d mean = a.rowwise().mean();
  a.colwise() -= mean;
  return log_albedo;
}

// The paint under SmoothShading in place of that of `out`, where it has fewer
// colours.
void TakeIfSimpler(const std::vector<ShadingPoint>& points,
                   const Observations& observed,
                   const std::vector<NeighbourPair>& neighbours,
                   FirstPaint* out) {
  UnpaintedRadiance other;
  other.matte = SmoothShading(points, observed, neighbours);
  other.gloss = out->shading.gloss;
  AlbedoFitOptions options = OfPaintThatFades();
  options.reach = AlbedoFitOptions().reach;
  std::vector<double> paint =
      PaintOf(points, {{&other, &observed}}, neighbours, options);
  if (ColourEntropy(points, observed, paint) + kFewerColours >
      ColourEntropy(points, observed, out->log_albedo)) {
    return;
  }
  out->shading = std::move(other);
  out->log_albedo = std::move(paint);
  out->options = options;
}

}  // namespace

FirstPaint FindFirstPaint(const std::vector<ShadingPoint>& points,
                          const Observations& observed,
                          const std::vector<NeighbourPair>& neighbours) {
  FirstPaint out;
  if (points.empty()) return out;
  out.light = FindShadingLight(points, observed);
  const ShadingLight light = out.light.value_or(ShadingLight());
  out.natural_light = light.strength < kStrongLamp;
  out.options.chroma_drifts = out.natural_light;
  std::vector<double>& matte = out.shading.matte;
  out.shading.gloss.assign(3 * points.size(), 0.0);
  for (const ShadingPoint& point : points) {
    const Eigen::Array3d irradiance =
        Irradiance(light, point.normal.cast<double>());
    matte.insert(matte.end(), irradiance.begin(), irradiance.end());
  }
  out.log_albedo =
      PaintOf(points, {{&out.shading, &observed}}, neighbours, out.options);
  if (out.natural_light) TakeIfSimpler(points, observed, neighbours, &out);
  out.deviation =
      DeviationAtLikeNormals(points, observed, out.shading, out.log_albedo);
  return out;
}

SharedPaint FindSharedPaint(const std::vector<ShadingPoint>& points,
                            const std::vector<const Observations*>& observed,
                            const std::vector<FirstPaint>& of_images,
                            const std::vector<NeighbourPair>& neighbours) {
  SharedPaint out;
  // Shading that no light's model has is mostly gone from the median.
  out.options = UnderKnownShading();
  out.options.luminance_drifts = true;
  out.options.chroma_drifts = true;
  std::vector<PaintedImage> images;
  for (size_t k = 0; k < observed.size(); ++k) {
    out.options.chroma_drifts &= of_images[k].options.chroma_drifts;
    images.push_back({&of_images[k].shading, observed[k]});
  }
  out.log_albedo = PaintOf(points, images, neighbours, out.options);
  return out;
}

std::vector<double> FirstPaintUnder(
    const std::vector<ShadingPoint>& points, const Observations& observed,
    const std::vector<NeighbourPair>& neighbours,
    const AlbedoFitOptions& options, std::vector<double> shading) {
  UnpaintedRadiance unpainted;
  unpainted.matte = std::move(shading);
  unpainted.gloss.assign(3 * points.size(), 0.0);
  return PaintOf(points, {{&unpainted, &observed}}, neighbours, options);
}

}  // namespace ibrdf
