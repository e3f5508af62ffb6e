#include <glog/logging.h>

#include <Eigen/Geometry>
#include <algorithm>
#include <cmath>
#include <string>

#include "ibrdf/base/parallel_for.h"
#include "ibrdf/scene/face_viewer.h"
#include "ibrdf/scene/scene.h"

namespace ibrdf {
namespace {

// Normal at a continuous position: bilinear between the set pixels around it,
// inside where the pixel that holds the position is set.
bool NormalAt(const Image& normals, double x, double y,
              Eigen::Vector3d* normal) {
  const int px = std::min(static_cast<int>(x), normals.width - 1);
  const int py = std::min(static_cast<int>(y), normals.height - 1);
  const Eigen::Map<const Eigen::Vector3f> own(normals.At(px, py));
  if (own.isZero()) return false;
  const double x0 = std::floor(x - 0.5), y0 = std::floor(y - 0.5);
  const double fx = x - 0.5 - x0, fy = y - 0.5 - y0;
  Eigen::Vector3d sum = Eigen::Vector3d::Zero();
  for (int corner = 0; corner < 4; ++corner) {
    const int dx = corner & 1, dy = corner >> 1;
    const int cx = std::clamp(static_cast<int>(x0) + dx, 0, normals.width - 1);
    const int cy = std::clamp(static_cast<int>(y0) + dy, 0, normals.height - 1);
    const Eigen::Map<const Eigen::Vector3f> n(normals.At(cx, cy));
    sum += (dx ? fx : 1.0 - fx) * (dy ? fy : 1.0 - fy) * n.cast<double>();
  }
  *normal = sum.norm() > 1e-6 ? Eigen::Vector3d(sum.normalized())
                              : Eigen::Vector3d(own.cast<double>());
  return true;
}

// Whether the camera's frame is the world's.
bool LooksAlongZ(const Camera& camera) {
  constexpr double kRounding = 1e-9;
  return (AxesOf(camera).world_from_camera - Eigen::Matrix3d::Identity())
             .cwiseAbs()
             .maxCoeff() < kRounding;
}

Status CheckSizes(const Scene& scene, const Camera& camera, int width,
                  int height, const Mask& mask) {
  const Image& normals = scene.normal_map();
  const auto size = [](int w, int h) {
    return std::to_string(w) + " x " + std::to_string(h);
  };
  if (!mask.empty() && (mask.width != width || mask.height != height)) {
    return InvalidInput("mask", "expected the image's size " +
                                    size(width, height) + ", found " +
                                    size(mask.width, mask.height));
  }
  if (!IsValidCamera(camera)) {
    return InvalidInput("camera",
                        "expected fov_degrees in (0, 180), from apart from to, "
                        "up not parallel to the view; a rotation and focal "
                        "lengths > 0");
  }
  if (normals.empty()) return Status();
  if (!LooksAlongZ(camera)) {
    return InvalidInput("camera",
                        "expected a view along -z with y up: normals are in "
                        "the camera's frame");
  }
  if (normals.width != width || normals.height != height) {
    return InvalidInput("normals", "expected the image's size " +
                                       size(width, height) + ", found " +
                                       size(normals.width, normals.height));
  }
  return Status();
}

// What a position of the image, in pixels, sees; false: nothing. Sets what the
// position decides of the point.
bool SeePoint(const Scene& scene, const Camera& camera, double x, double y,
              int width, int height, ShadingPoint* point) {
  const Ray ray = CameraRay(camera, x, y, width, height);
  const Eigen::Vector3d wo = -ray.direction;
  const Image& normals = scene.normal_map();
  SurfaceHit hit{};
  if (!normals.empty()) {
    Eigen::Vector3d normal;
    if (!NormalAt(normals, x, y, &normal)) return false;
    hit.normal = FaceViewer(normal, wo, wo);
  } else if (!scene.Intersect(ray, camera.type == CameraType::kOrthographic,
                              &hit)) {
    return false;
  }
  point->normal = hit.normal.cast<float>();
  point->wo = wo.cast<float>();
  point->position = hit.position;
  point->texture = hit.texture;
  return true;
}

}  // namespace

StatusOr<std::vector<ShadingPoint>> FindShadingPoints(
    const Scene& scene, const Camera& camera, int width, int height,
    const Mask& mask, int samples_per_side, int num_threads) {
  CHECK(width > 0 && height > 0 && samples_per_side > 0);
  IBRDF_RETURN_IF_ERROR(CheckSizes(scene, camera, width, height, mask));
  std::vector<std::vector<ShadingPoint>> rows(height);
  const int s = samples_per_side;
  ParallelFor(height, num_threads, [&](int64_t y, int) {
    for (int x = 0; x < width; ++x) {
      ShadingPoint point{};
      point.pixel = static_cast<int>(y) * width + x;
      point.coverage = 1.0f / static_cast<float>(s * s);
      if (!mask.empty() && mask.inside[point.pixel] == 0) continue;
      for (int k = 0; k < s * s; ++k) {
        if (SeePoint(scene, camera, x + (k % s + 0.5) / s,
                     static_cast<double>(y) + (k / s + 0.5) / s, width, height,
                     &point)) {
          rows[y].push_back(point);
        }
      }
    }
  });
  std::vector<ShadingPoint> points;
  for (const std::vector<ShadingPoint>& row : rows) {
    points.insert(points.end(), row.begin(), row.end());
  }
  if (points.empty()) {
    return InvalidInput("geometry",
                        mask.inside.empty()
                            ? "no pixel sees the object"
                            : "no pixel inside the mask sees the object");
  }
  for (size_t i = 0; i < points.size(); ++i) {
    points[i].index = static_cast<int>(i);
  }
  return points;
}

std::vector<ShadingPoint> SpreadPoints(const std::vector<ShadingPoint>& points,
                                       size_t most) {
  const size_t count = std::min(points.size(), most);
  std::vector<ShadingPoint> out;
  for (size_t k = 0; k < count; ++k) {
    out.push_back(points[(2 * k + 1) * points.size() / (2 * count)]);
  }
  return out;
}

}  // namespace ibrdf
