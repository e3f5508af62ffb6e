#include "ibrdf/solvers/paint/first_paint.h"

#include <Eigen/Core>
#include <algorithm>
#include <cmath>
#include <map>
#include <utility>

#include "ibrdf/base/pi.h"
#include "ibrdf/solvers/observation/normal_bins.h"
#include "ibrdf/solvers/paint/albedo_fit.h"
#include "ibrdf/solvers/priors/directional_lights.h"

namespace ibrdf {
namespace {

constexpr int kMostHighlights = 3;
// Bins of like normals: of the disc of visible ones, and of points in each.
constexpr int kBinsAcross = 24;
constexpr size_t kFewestOfBin = 8;
constexpr double kLeastCosine = 0.2;
// Of a normal distribution, over the median of its absolute values.
constexpr double kDeviationOfMedian = 1.4826;
// About a highlight's middle, of mirrored directions: where its light shows.
constexpr double kHighlight = 15.0 * kDegree, kRim = 25.0 * kDegree;
// A highlight is by so much brighter than the median of its rim, and no larger
// share of the object.
constexpr double kContrast = 1.3, kMostOfObject = 0.03;
// Of log radiance from pixel to pixel, at this share of the edge of paint.
constexpr double kSharpStep = 0.15, kSharpShare = 0.5;

double Median(std::vector<double>* values) {
  const auto middle = values->begin() + values->size() / 2;
  std::nth_element(values->begin(), middle, values->end());
  return *middle;
}

// Whether radiance steps at the edge of the points that are set, as paint does
// and a highlight, whose flank is soft, does not.
bool HasSharpEdge(const std::vector<char>& set,
                  const std::vector<double>& radiance,
                  const std::vector<NeighbourPair>& neighbours) {
  const auto log_sum = [&](int i) {
    return std::log(radiance[3 * i] + radiance[3 * i + 1] +
                    radiance[3 * i + 2]);
  };
  double sharp = 0.0, all = 0.0;
  for (const NeighbourPair& pair : neighbours) {
    if (set[pair.first] == set[pair.second]) continue;
    const double step = std::abs(log_sum(pair.first) - log_sum(pair.second));
    if (!std::isfinite(step)) continue;
    all += 1.0;
    if (step > kSharpStep) sharp += 1.0;
  }
  return sharp > kSharpShare * all;
}

// The points about each highlight, and which of them are brighter than most.
std::vector<char> Highlights(const std::vector<ShadingPoint>& points,
                             const std::vector<double>& unshaded,
                             const std::vector<NeighbourPair>& neighbours) {
  std::vector<char> highlights(points.size(), 0);
  for (const Eigen::Vector3d& light :
       FindDirectionalLights(points, unshaded, kMostHighlights)) {
    std::vector<size_t> near;
    std::vector<double> luminance, rim;
    for (size_t i = 0; i < points.size(); ++i) {
      const Eigen::Vector3d n = points[i].normal.cast<double>();
      const Eigen::Vector3d wo = points[i].wo.cast<double>();
      const double cosine = light.dot(2.0 * n.dot(wo) * n - wo);
      const double sum =
          unshaded[3 * i] + unshaded[3 * i + 1] + unshaded[3 * i + 2];
      if (cosine < std::cos(kRim) || !std::isfinite(sum)) continue;
      if (cosine < std::cos(kHighlight)) {
        rim.push_back(sum);
      } else {
        near.push_back(i);
        luminance.push_back(sum);
      }
    }
    if (near.empty() || rim.empty()) continue;
    const double bright = kContrast * Median(&rim);
    const auto count = std::count_if(luminance.begin(), luminance.end(),
                                     [&](double l) { return l > bright; });
    // What is large is paint.
    if (count > kMostOfObject * static_cast<double>(points.size())) continue;
    std::vector<char> found(points.size(), 0);
    for (size_t k = 0; k < near.size(); ++k) {
      if (luminance[k] > bright) found[near[k]] = 1;
    }
    if (HasSharpEdge(found, unshaded, neighbours)) continue;
    for (size_t i = 0; i < found.size(); ++i) highlights[i] |= found[i];
  }
  return highlights;
}

// The image without its highlights. shading: of a matte object [points * 3].
Observations WithoutHighlights(const std::vector<ShadingPoint>& points,
                               const Observations& observed,
                               const std::vector<double>& shading,
                               const std::vector<NeighbourPair>& neighbours) {
  std::vector<double> unshaded = observed.radiance;
  for (size_t i = 0; i < unshaded.size(); ++i) unshaded[i] /= shading[i];
  const std::vector<char> highlights = Highlights(points, unshaded, neighbours);
  Observations out = observed;
  out.num_valid = 0;
  for (size_t i = 0; i < points.size(); ++i) {
    if (highlights[i] != 0) out.valid[i] = 0;
    out.num_valid += out.valid[i];
  }
  return out.num_valid > 0 ? out : observed;
}

// Of log luminance between image and painted matte object, about the median of
// each bin of normals: what no light explains. A deviation from the median of
// absolutes.
double DeviationAtLikeNormals(const std::vector<ShadingPoint>& points,
                              const Observations& observed,
                              const UnpaintedRadiance& unpainted,
                              const std::vector<double>& log_albedo) {
  std::map<std::pair<int, int>, std::vector<double>> bins;
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
    bins[{bin.x(), bin.y()}].push_back(left / 3.0);
  }
  std::vector<double> deviations;
  for (auto& [bin, left] : bins) {
    if (left.size() < kFewestOfBin) continue;
    const double middle = Median(&left);
    for (const double l : left) deviations.push_back(std::abs(l - middle));
  }
  return deviations.empty() ? 0.0 : kDeviationOfMedian * Median(&deviations);
}

}  // namespace

FirstPaint FindFirstPaint(const std::vector<ShadingPoint>& points,
                          const Observations& observed,
                          const std::vector<NeighbourPair>& neighbours) {
  FirstPaint out;
  out.light = FindShadingLight(points, observed);
  const ShadingLight light = out.light.value_or(ShadingLight());
  UnpaintedRadiance unpainted;
  unpainted.gloss.assign(3 * points.size(), 0.0);
  for (const ShadingPoint& point : points) {
    const Eigen::Array3d irradiance =
        Irradiance(light, point.normal.cast<double>());
    unpainted.matte.insert(unpainted.matte.end(), irradiance.begin(),
                           irradiance.end());
  }
  out.log_albedo = FitAlbedo(
      unpainted,
      WithoutHighlights(points, observed, unpainted.matte, neighbours),
      neighbours, AlbedoFitOptions());
  Eigen::Map<Eigen::Matrix3Xd> a(out.log_albedo.data(), 3,
                                 static_cast<Eigen::Index>(points.size()));
  const Eigen::Vector3d mean = a.rowwise().mean();
  a.colwise() -= mean;
  out.deviation =
      DeviationAtLikeNormals(points, observed, unpainted, out.log_albedo);
  return out;
}

}  // namespace ibrdf
