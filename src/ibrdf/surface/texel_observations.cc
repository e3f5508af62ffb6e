#include "ibrdf/surface/texel_observations.h"

#include <glog/logging.h>

#include <Eigen/Geometry>
#include <algorithm>
#include <cmath>
#include <string>
#include <utility>

#include "ibrdf/base/parallel_for.h"
#include "ibrdf/light/environment_map.h"

namespace ibrdf {
namespace {

// A share of the surface's size: rays start off it by what floats resolve
// there.
constexpr double kRayOffset = 1e-5;
// A pixel is on a silhouette where it or a neighbour is off the other's tangent
// plane by more than so many of their distances in the picture.
constexpr double kJump = 1.0;

// The same camera without angles and points to look at, which take time.
Camera Posed(const Camera& camera, int width, int height) {
  const CameraAxes axes = AxesOf(camera);
  const PixelGrid grid = PixelGridOf(camera, width, height);
  Camera posed = camera;
  posed.world_from_camera = Eigen::Matrix4d::Identity();
  posed.world_from_camera->topLeftCorner<3, 3>() = axes.world_from_camera;
  posed.world_from_camera->topRightCorner<3, 1>() = axes.centre;
  if (camera.type == CameraType::kPerspective) {
    posed.focal_pixels = grid.side.cwiseInverse();
    posed.centre_pixels = grid.centre;
  }
  return posed;
}

double SizeOf(const SurfaceAtlas& atlas) {
  Eigen::Vector3d low = atlas.texels[0].position, high = low;
  for (const SurfaceTexel& t : atlas.texels) {
    low = low.cwiseMin(t.position);
    high = high.cwiseMax(t.position);
  }
  return (high - low).norm();
}

bool IsRadiance(const float* rgb) {
  for (int c = 0; c < 3; ++c) {
    if (!(rgb[c] >= 0.0f && std::isfinite(rgb[c]))) return false;
  }
  return true;
}

// What the centres of pixels see.
struct PixelHit {
  bool met = false;
  Eigen::Vector3d place;
  Eigen::Vector3d normal;
  Eigen::Vector3d view;  // along the ray
};

std::vector<PixelHit> CastPixels(const Scene& scene, const ObservedView& view,
                                 int num_threads) {
  const int width = view.radiance.width, height = view.radiance.height;
  std::vector<PixelHit> hits(view.radiance.num_pixels());
  ParallelFor(height, num_threads, [&](int64_t y, int) {
    for (int x = 0; x < width; ++x) {
      const Ray ray = CameraRay(view.camera, x + 0.5,
                                static_cast<double>(y) + 0.5, width, height);
      PixelHit& hit = hits[static_cast<size_t>(y) * width + x];
      SurfaceHit surface;
      hit.met = scene.Intersect(
          ray, view.camera.type == CameraType::kOrthographic, &surface);
      if (!hit.met) continue;
      hit.place = ray.origin + surface.distance * ray.direction;
      hit.normal = surface.normal;
      hit.view = ray.direction;
    }
  });
  return hits;
}

// Whether two neighbours are of one smooth surface: `other` is near the plane
// that touches it at `hit`.
bool Continues(const PixelHit& hit, const PixelHit& other) {
  if (!other.met) return false;
  const Eigen::Vector3d step = other.place - hit.place;
  const double along = step.dot(hit.view);
  const double across = (step - along * hit.view).norm();
  const double off = std::abs(step.dot(hit.normal));
  return off <= kJump * across;
}

// Bilinear between four samples; false where one is none.
bool SamplePixels(const ObservedView& view, const ImagePoint& at, float* rgb) {
  const int width = view.radiance.width, height = view.radiance.height;
  const double x0 = std::floor(at.x - 0.5), y0 = std::floor(at.y - 0.5);
  if (!(x0 >= 0.0 && y0 >= 0.0 && x0 + 1.0 < width && y0 + 1.0 < height)) {
    return false;
  }
  const double fx = at.x - 0.5 - x0, fy = at.y - 0.5 - y0;
  double sum[3] = {0.0, 0.0, 0.0};
  for (int corner = 0; corner < 4; ++corner) {
    const int dx = corner & 1, dy = corner >> 1;
    const size_t i =
        (static_cast<size_t>(y0) + dy) * width + static_cast<size_t>(x0) + dx;
    if (view.samples.inside[i] == 0) return false;
    const double weight = (dx ? fx : 1.0 - fx) * (dy ? fy : 1.0 - fy);
    for (int c = 0; c < 3; ++c) sum[c] += weight * view.radiance.rgb[3 * i + c];
  }
  for (int c = 0; c < 3; ++c) rgb[c] = static_cast<float>(sum[c]);
  return true;
}

}  // namespace

StatusOr<TexelObserver> TexelObserver::Make(const Scene& scene,
                                            SurfaceAtlas atlas,
                                            std::vector<ObservedView> views,
                                            Image prefiltered,
                                            const ObserverOptions& options) {
  CHECK(!atlas.texels.empty() && !prefiltered.empty());
  if (views.empty()) return InvalidInput("views", "expected one or more");
  for (size_t i = 0; i < views.size(); ++i) {
    const ObservedView& view = views[i];
    const std::string name = "view " + std::to_string(i);
    if (!IsValidCamera(view.camera)) {
      return InvalidInput(name, "expected a valid camera");
    }
    if (view.radiance.empty() ||
        (!view.samples.empty() &&
         (view.samples.width != view.radiance.width ||
          view.samples.height != view.radiance.height))) {
      return InvalidInput(name, "expected an image, and a mask of its size");
    }
  }
  return TexelObserver(scene, std::move(atlas), std::move(views),
                       std::move(prefiltered), options);
}

TexelObserver::TexelObserver(const Scene& scene, SurfaceAtlas atlas,
                             std::vector<ObservedView> views, Image prefiltered,
                             const ObserverOptions& options)
    : scene_(scene),
      atlas_(std::move(atlas)),
      views_(std::move(views)),
      prefiltered_(std::move(prefiltered)),
      options_(options),
      offset_(kRayOffset * SizeOf(atlas_)) {
  for (ObservedView& view : views_) {
    view.camera = Posed(view.camera, view.radiance.width, view.radiance.height);
    KeepSamples(&view);
  }
}

void TexelObserver::KeepSamples(ObservedView* view) const {
  const int width = view->radiance.width, height = view->radiance.height;
  const std::vector<PixelHit> hits =
      CastPixels(scene_, *view, options_.num_threads);
  Mask kept(width, height, 0);
  ParallelFor(height, options_.num_threads, [&](int64_t row, int) {
    const int y = static_cast<int>(row);
    for (int x = 0; x < width; ++x) {
      const size_t i = static_cast<size_t>(y) * width + x;
      if (!view->samples.Holds(i) || !hits[i].met ||
          !IsRadiance(&view->radiance.rgb[3 * i])) {
        continue;
      }
      bool inside = true;
      for (int v = std::max(y - 1, 0); v <= std::min(y + 1, height - 1); ++v) {
        for (int u = std::max(x - 1, 0); u <= std::min(x + 1, width - 1); ++u) {
          const PixelHit& other = hits[static_cast<size_t>(v) * width + u];
          inside =
              inside && Continues(hits[i], other) && Continues(other, hits[i]);
        }
      }
      kept.inside[i] = inside ? 1 : 0;
    }
  });
  view->samples = std::move(kept);
}

std::vector<int> TexelObserver::ViewsAbove(
    const SurfaceTexel& texel, std::vector<Eigen::Vector3f>* directions) const {
  std::vector<int> seen;
  for (int k = 0; k < num_views(); ++k) {
    const Camera& camera = views_[k].camera;
    const CameraAxes axes = AxesOf(camera);
    const Eigen::Vector3d to_camera =
        camera.type == CameraType::kPerspective
            ? Eigen::Vector3d((axes.centre - texel.position).normalized())
            : Eigen::Vector3d(axes.world_from_camera.col(2));
    const Eigen::Vector3f w = to_camera.cast<float>();
    directions->push_back(w);
    if (w.dot(texel.normal) > options_.least_cosine) seen.push_back(k);
  }
  return seen;
}

Eigen::Vector3d TexelObserver::RayStart(const SurfaceTexel& texel) const {
  return texel.position + offset_ * texel.normal.cast<double>();
}

void TexelObserver::ObserveTexel(const SurfaceTexel& texel, int row,
                                 TexelObservations* out) const {
  std::vector<Eigen::Vector3f> directions;
  const std::vector<int> above = ViewsAbove(texel, &directions);
  const Eigen::Vector3f n = texel.normal;
  const Eigen::Vector3d start = RayStart(texel);
  std::vector<Eigen::Vector3f> rays;
  for (const int k : above) rays.push_back(directions[k]);
  if (options_.shadowed_light) {
    for (const int k : above) {
      rays.push_back(2.0f * n.dot(directions[k]) * n - directions[k]);
    }
  }
  std::vector<uint8_t> hidden(rays.size(), 0);
  if (scene_.CastsShadows() && !rays.empty()) {
    scene_.Occluded(start, rays, hidden.data());
  }
  const size_t first = static_cast<size_t>(row) * out->num_views;
  for (int k = 0; k < out->num_views; ++k) {
    float* const w = &out->directions[3 * (first + k)];
    w[0] = directions[k].dot(texel.tangent);
    w[1] = directions[k].dot(texel.bitangent);
    w[2] = directions[k].dot(n);
  }
  for (size_t i = 0; i < above.size(); ++i) {
    const int k = above[i];
    const size_t at = first + k;
    if (!options_.shadowed_light || hidden[above.size() + i] == 0) {
      const Eigen::Vector3f& w = directions[k];
      const Eigen::Vector3f mirror = 2.0f * n.dot(w) * n - w;
      Eigen::Map<Eigen::Array3f>(&out->incoming[3 * at]) =
          LookUpMap(prefiltered_, mirror.cast<double>()).cast<float>();
    }
    if (hidden[i] != 0) continue;
    out->visible[at] = 1;
    const ObservedView& view = views_[k];
    const std::optional<ImagePoint> pixel = ProjectPoint(
        view.camera, texel.position, view.radiance.width, view.radiance.height);
    if (pixel && SamplePixels(view, *pixel, &out->outgoing[3 * at])) {
      out->weight[at] = 1.0f;
    }
  }
}

TexelObservations TexelObserver::Observe(int64_t begin, int64_t end) const {
  CHECK(0 <= begin && begin <= end &&
        end <= static_cast<int64_t>(atlas_.texels.size()));
  TexelObservations out;
  out.num_texels = static_cast<int>(end - begin);
  out.num_views = num_views();
  const size_t samples =
      static_cast<size_t>(out.num_texels) * static_cast<size_t>(out.num_views);
  for (std::vector<float>* values :
       {&out.directions, &out.outgoing, &out.incoming}) {
    values->assign(3 * samples, 0.0f);
  }
  out.weight.assign(samples, 0.0f);
  out.visible.assign(samples, 0);
  ParallelFor(out.num_texels, options_.num_threads, [&](int64_t i, int) {
    ObserveTexel(atlas_.texels[begin + i], static_cast<int>(i), &out);
  });
  return out;
}

}  // namespace ibrdf
