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
constexpr double kHighlight = 15.0 * kDegree;
// A highlight is by so much brighter than the median about it, and no larger
// share of the object.
constexpr double kContrast = 1.3, kMostOfObject = 0.03;

// The points about each highlight, and which of them are brighter than most.
std::vector<char> Highlights(const std::vector<ShadingPoint>& points,
                             const std::vector<double>& unshaded) {
  std::vector<char> highlights(points.size(), 0);
  for (const Eigen::Vector3d& light :
       FindDirectionalLights(points, unshaded, kMostHighlights)) {
    std::vector<size_t> around;
    std::vector<double> luminance;
    for (size_t i = 0; i < points.size(); ++i) {
      const Eigen::Vector3d n = points[i].normal.cast<double>();
      const Eigen::Vector3d wo = points[i].wo.cast<double>();
      const double cosine = light.dot(2.0 * n.dot(wo) * n - wo);
      const double sum =
          unshaded[3 * i] + unshaded[3 * i + 1] + unshaded[3 * i + 2];
      if (cosine < std::cos(kHighlight) || !std::isfinite(sum)) continue;
      around.push_back(i);
      luminance.push_back(sum);
    }
    if (around.empty()) continue;
    std::vector<double> sorted = luminance;
    const auto middle = sorted.begin() + sorted.size() / 2;
    std::nth_element(sorted.begin(), middle, sorted.end());
    const double bright = kContrast * *middle;
    const auto count = std::count_if(luminance.begin(), luminance.end(),
                                     [&](double l) { return l > bright; });
    // What is large is paint.
    if (count > kMostOfObject * static_cast<double>(points.size())) continue;
    for (size_t k = 0; k < around.size(); ++k) {
      if (luminance[k] > bright) highlights[around[k]] = 1;
    }
  }
  return highlights;
}

// The image without its highlights. shading: of a matte object [points * 3].
Observations WithoutHighlights(const std::vector<ShadingPoint>& points,
                               const Observations& observed,
                               const std::vector<double>& shading) {
  std::vector<double> unshaded = observed.radiance;
  for (size_t i = 0; i < unshaded.size(); ++i) unshaded[i] /= shading[i];
  const std::vector<char> highlights = Highlights(points, unshaded);
  Observations out = observed;
  out.num_valid = 0;
  for (size_t i = 0; i < points.size(); ++i) {
    if (highlights[i] != 0) out.valid[i] = 0;
    out.num_valid += out.valid[i];
  }
  return out.num_valid > 0 ? out : observed;
}

double Median(std::vector<double>* values) {
  const auto middle = values->begin() + values->size() / 2;
  std::nth_element(values->begin(), middle, values->end());
  return *middle;
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
  out.log_albedo =
      FitAlbedo(unpainted, WithoutHighlights(points, observed, unpainted.matte),
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
