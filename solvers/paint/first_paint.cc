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
// Steps of this much are paint's: all of what no shading explains.
constexpr double kAnyStep = 0.005;
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

// What an image says by itself: its light, and what that makes of a white
// matte object.
struct ImageShading {
  FirstPaint paint;
  UnpaintedRadiance unpainted;
};

// FitAlbedo of a matte object of those shadings, its mean 0 in each channel.
std::vector<double> PaintOf(
    const std::vector<ShadingPoint>& points,
    const std::vector<const Observations*>& images,
    const std::vector<const UnpaintedRadiance*>& unpainted,
    const std::vector<NeighbourPair>& neighbours,
    const AlbedoFitOptions& options) {
  std::vector<Observations> matte;
  for (size_t k = 0; k < images.size(); ++k) {
    matte.push_back(WithoutHighlights(points, *images[k], unpainted[k]->matte));
  }
  std::vector<PaintedImage> painted;
  for (size_t k = 0; k < images.size(); ++k) {
    painted.push_back({unpainted[k], &matte[k]});
  }
  std::vector<double> log_albedo =
      FitAlbedo(painted, neighbours, InViews(options, points));
  Eigen::Map<Eigen::Matrix3Xd> a(log_albedo.data(), 3,
                                 static_cast<Eigen::Index>(points.size()));
  const Eigen::Vector3d mean = a.rowwise().mean();
  a.colwise() -= mean;
  return log_albedo;
}

// The paint under SmoothShading in place of the image's, where it has fewer
// colours.
void TakeIfSimpler(const std::vector<ShadingPoint>& points,
                   const Observations& observed,
                   const std::vector<NeighbourPair>& neighbours,
                   ImageShading* out) {
  UnpaintedRadiance other;
  other.matte = SmoothShading(points, observed, neighbours);
  other.gloss = out->unpainted.gloss;
  AlbedoFitOptions options;
  options.edge = options.chroma_edge = kAnyStep;
  options.edge_by_turn = 0.0;
  std::vector<double> paint =
      PaintOf(points, {&observed}, {&other}, neighbours, options);
  if (ColourEntropy(points, observed, paint) + kFewerColours >
      ColourEntropy(points, observed, out->paint.log_albedo)) {
    return;
  }
  out->unpainted = std::move(other);
  out->paint.log_albedo = std::move(paint);
  out->paint.options = options;
}

ImageShading ShadingOf(const std::vector<ShadingPoint>& points,
                       const Observations& observed,
                       const std::vector<NeighbourPair>& neighbours) {
  ImageShading out;
  out.paint.light = FindShadingLight(points, observed);
  const ShadingLight light = out.paint.light.value_or(ShadingLight());
  out.paint.natural_light = light.strength < kStrongLamp;
  out.paint.options.chroma_drifts = out.paint.natural_light;
  out.unpainted.gloss.assign(3 * points.size(), 0.0);
  for (const ShadingPoint& point : points) {
    const Eigen::Array3d irradiance =
        Irradiance(light, point.normal.cast<double>());
    out.unpainted.matte.insert(out.unpainted.matte.end(), irradiance.begin(),
                               irradiance.end());
  }
  out.paint.log_albedo = PaintOf(points, {&observed}, {&out.unpainted},
                                 neighbours, out.paint.options);
  if (out.paint.natural_light) {
    TakeIfSimpler(points, observed, neighbours, &out);
  }
  return out;
}

// Gives each image the paint that all show. Shading that no light's model has
// is mostly gone from the median of several lights.
void ShareThePaint(const std::vector<ShadingPoint>& points,
                   const std::vector<const Observations*>& images,
                   const std::vector<NeighbourPair>& neighbours,
                   std::vector<ImageShading>* shadings) {
  AlbedoFitOptions options = UnderKnownShading();
  options.chroma_drifts = true;
  std::vector<const UnpaintedRadiance*> unpainted;
  for (const ImageShading& shading : *shadings) {
    options.chroma_drifts &= shading.paint.options.chroma_drifts;
    unpainted.push_back(&shading.unpainted);
  }
  const std::vector<double> log_albedo =
      PaintOf(points, images, unpainted, neighbours, options);
  for (ImageShading& shading : *shadings) {
    shading.paint.log_albedo = log_albedo;
    shading.paint.options = options;
  }
}

}  // namespace

std::vector<FirstPaint> FindFirstPaints(
    const std::vector<ShadingPoint>& points,
    const std::vector<const Observations*>& images,
    const std::vector<NeighbourPair>& neighbours) {
  if (points.empty()) return std::vector<FirstPaint>(images.size());
  std::vector<ImageShading> shadings;
  for (const Observations* observed : images) {
    shadings.push_back(ShadingOf(points, *observed, neighbours));
  }
  if (images.size() > 1) ShareThePaint(points, images, neighbours, &shadings);
  std::vector<FirstPaint> out;
  for (size_t k = 0; k < images.size(); ++k) {
    ImageShading& shading = shadings[k];
    shading.paint.deviation = DeviationAtLikeNormals(
        points, *images[k], shading.unpainted, shading.paint.log_albedo);
    out.push_back(std::move(shading.paint));
  }
  return out;
}

std::vector<double> FirstPaintUnder(
    const std::vector<ShadingPoint>& points, const Observations& observed,
    const std::vector<NeighbourPair>& neighbours, std::vector<double> shading) {
  UnpaintedRadiance unpainted;
  unpainted.matte = std::move(shading);
  unpainted.gloss.assign(3 * points.size(), 0.0);
  return PaintOf(points, {&observed}, {&unpainted}, neighbours,
                 AlbedoFitOptions());
}

}  // namespace ibrdf
