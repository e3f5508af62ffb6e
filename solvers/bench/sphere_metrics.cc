#include "ibrdf/solvers/bench/sphere_metrics.h"

#include <glog/logging.h>

#include <algorithm>
#include <cmath>
#include <vector>

#include "ibrdf/brdf/cook_torrance.h"
#include "ibrdf/brdf/sample_merl.h"
#include "ibrdf/light/environment_map.h"
#include "ibrdf/metrics/image_metrics.h"
#include "ibrdf/render/reference_batch.h"
#include "ibrdf/render/reference_renderer.h"

namespace ibrdf {
namespace {

constexpr int kMirrorSize = 128;
constexpr int kSmoothSize = 40;
constexpr int kRelitSize = 64;

std::vector<ShadingPoint> SpherePoints(int size, int samples_per_side) {
  StatusOr<std::vector<ShadingPoint>> points = FindShadingPoints(
      Scene::UnitSphere(), Camera(), size, size, Mask(), samples_per_side);
  CHECK(points.ok()) << points.status().message();
  return *std::move(points);
}

Image RenderMirror(const Image& map) {
  const std::vector<ShadingPoint> points = SpherePoints(kMirrorSize, 2);
  std::vector<double> L_o;
  for (const ShadingPoint& p : points) {
    const Eigen::Vector3d n = p.normal.cast<double>().normalized();
    const Eigen::Vector3d wo = p.wo.cast<double>().normalized();
    const Eigen::Array3d L = LookUpMap(map, 2.0 * n.dot(wo) * n - wo);
    L_o.insert(L_o.end(), {L[0], L[1], L[2]});
  }
  return PixelMeans(points, L_o.data(), kMirrorSize, kMirrorSize);
}

Status CheckFinite(const char* name, const Image& map) {
  const bool finite = std::all_of(map.rgb.begin(), map.rgb.end(),
                                  [](float v) { return std::isfinite(v); });
  return finite ? OkStatus() : InvalidInput(name, "expected finite radiance");
}

// e: not yet scaled.
StatusOr<SphereMetrics> ComparePictures(Image e, const Image& r) {
  Mask mask(r.width, r.height, 0);
  for (const ShadingPoint& p : SpherePoints(r.width, 1)) {
    mask.inside[p.pixel] = 255;
  }
  double ee = 0.0, er = 0.0;
  for (size_t k = 0; k < r.rgb.size(); ++k) {
    if (mask.inside[k / 3] == 0) continue;
    ee += static_cast<double>(e.rgb[k]) * e.rgb[k];
    er += static_cast<double>(e.rgb[k]) * r.rgb[k];
  }
  const double scale = ee > 0.0 ? std::max(er / ee, 0.0) : 0.0;
  double squares = 0.0, log_squares = 0.0;
  size_t count = 0;
  for (size_t k = 0; k < r.rgb.size(); ++k) {
    e.rgb[k] = static_cast<float>(scale * e.rgb[k]);
    if (mask.inside[k / 3] == 0) continue;
    const double a = std::max(e.rgb[k], 0.0f), b = std::max(r.rgb[k], 0.0f);
    squares += (a - b) * (a - b);
    log_squares += std::pow(std::log1p(a) - std::log1p(b), 2);
    ++count;
  }
  const StatusOr<ImageMetrics> image = CompareImages(e, r, mask);
  if (!image.ok()) return image.status();
  SphereMetrics metrics;
  metrics.log_rmse = std::sqrt(log_squares / static_cast<double>(count));
  metrics.rmse = std::sqrt(squares / static_cast<double>(count));
  metrics.dssim = image->dssim;
  return metrics;
}

}  // namespace

std::string SphereName(Sphere sphere) {
  switch (sphere) {
    case Sphere::kDiffuse:
      return "diffuse";
    case Sphere::kGlossy:
      return "glossy";
    case Sphere::kMirror:
      break;
  }
  return "mirror";
}

SphereGallery::SphereGallery(int num_threads)
    : num_threads_(num_threads), tables_(kNumSpheres - 1) {
  CookTorrance diffuse;
  diffuse.diffuse = Eigen::Array3d::Ones();
  diffuse.specular = Eigen::Array3d::Zero();
  tables_.Set(0, SampleMerl(diffuse.Function()));
  CookTorrance glossy;
  glossy.diffuse = Eigen::Array3d::Constant(0.2);
  glossy.specular = Eigen::Array3d::Ones();
  glossy.roughness = Eigen::Array3d::Constant(0.15);
  glossy.f0 = Eigen::Array3d::Constant(0.04);
  tables_.Set(1, SampleMerl(glossy.Function()));
}

SphereGallery::Pictures SphereGallery::Render(const Image& map) const {
  ReferenceOptions options;
  options.near_rings /= 4;
  options.near_ring_samples /= 4;
  options.far_width = 64;
  options.num_threads = num_threads_;
  const std::vector<ShadingPoint> points = SpherePoints(kSmoothSize, 1);
  std::vector<double> L_o(3 * tables_.count() * points.size());
  ReferenceBatch(tables_, {&map}, options).Render(points, L_o.data());
  Pictures pictures;
  pictures[0] = RenderMirror(map);
  for (int m = 0; m < tables_.count(); ++m) {
    pictures[m + 1] = PixelMeans(points, &L_o[3 * m * points.size()],
                                 kSmoothSize, kSmoothSize);
  }
  return pictures;
}

StatusOr<SphereMetrics> CompareMirrors(const Image& estimate,
                                       const Image& reference) {
  IBRDF_RETURN_IF_ERROR(CheckFinite("estimate", estimate));
  IBRDF_RETURN_IF_ERROR(CheckFinite("reference", reference));
  return ComparePictures(RenderMirror(estimate), RenderMirror(reference));
}

StatusOr<SphereMetrics> CompareRelit(const MerlTable& estimate,
                                     const MerlTable& reference,
                                     const Image& map, int num_threads) {
  IBRDF_RETURN_IF_ERROR(CheckFinite("map", map));
  MerlTableStack tables(2);
  tables.Set(0, estimate);
  tables.Set(1, reference);
  ReferenceOptions options;
  options.far_width = 64;
  options.num_threads = num_threads;
  const std::vector<ShadingPoint> points = SpherePoints(kRelitSize, 1);
  const size_t size = 3 * points.size();
  std::vector<double> L_o(2 * size);
  ReferenceBatch(tables, {&map}, options).Render(points, L_o.data());
  return ComparePictures(
      PixelMeans(points, L_o.data(), kRelitSize, kRelitSize),
      PixelMeans(points, &L_o[size], kRelitSize, kRelitSize));
}

StatusOr<std::array<SphereMetrics, kNumSpheres>> SphereGallery::Compare(
    const Image& estimate, const Image& reference) const {
  IBRDF_RETURN_IF_ERROR(CheckFinite("estimate", estimate));
  IBRDF_RETURN_IF_ERROR(CheckFinite("reference", reference));
  const Pictures e = Render(estimate), r = Render(reference);
  std::array<SphereMetrics, kNumSpheres> metrics;
  for (int k = 0; k < kNumSpheres; ++k) {
    const StatusOr<SphereMetrics> one = ComparePictures(e[k], r[k]);
    if (!one.ok()) return one.status();
    metrics[k] = *one;
  }
  return metrics;
}

}  // namespace ibrdf
