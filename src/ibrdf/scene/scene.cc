#include "ibrdf/scene/scene.h"

#include <embree3/rtcore.h>
#include <glog/logging.h>

#include <Eigen/Geometry>
#include <algorithm>
#include <cmath>
#include <limits>
#include <string>
#include <utility>

#include "ibrdf/base/pi.h"
#include "ibrdf/scene/face_viewer.h"

namespace ibrdf {
namespace {

bool IntersectSphere(const Ray& ray, const Eigen::Vector3d& center,
                     double radius, bool from_infinity, SurfaceHit* hit) {
  // In the frame of the unit sphere.
  const Eigen::Vector3d origin = (ray.origin - center) / radius;
  const double b = origin.dot(ray.direction);
  const Eigen::Vector3d closest = origin - b * ray.direction;
  const double half_squared = 1.0 - closest.squaredNorm();
  if (!(half_squared > 0.0)) return false;
  const double half = std::sqrt(half_squared);
  double t = -b - half;
  if (t <= 0.0 && !from_infinity) t = -b + half;
  if (t <= 0.0 && !from_infinity) return false;
  const Eigen::Vector3d point = origin + t * ray.direction;
  const Eigen::Vector3d normal = point.normalized();
  hit->distance = radius * t;
  hit->normal = FaceViewer(normal, normal, -ray.direction);
  hit->position = center + radius * point;
  hit->texture = SphereTexture(normal);
  return true;
}

// Start of a shadow ray off the surface, in units of the bounding sphere's
// radius: a hundred times what float resolves there.
constexpr double kShadowOffset = 1e-5;
// The lift is at most this share of a triangle's longest edge: facets that meet
// at a true edge describe no smooth surface, whatever their normals say.
constexpr double kMaxLift = 0.15;

// A point of a triangle moved outwards to the tangent planes of its vertices,
// by the barycentric weights: the quadratic surface that the normals describe,
// where it lies above the facet (Hanika 2021). Without this a ray that leaves
// just above the shading horizon hits the next facet, and the edge between
// light and shadow shows the triangles.
Eigen::Vector3d LiftToSmoothSurface(const Eigen::Vector3d corners[3],
                                    const Eigen::Vector3d normals[3],
                                    const double weights[3],
                                    const Eigen::Vector3d& outward) {
  Eigen::Vector3d point = Eigen::Vector3d::Zero();
  for (int k = 0; k < 3; ++k) point += weights[k] * corners[k];
  Eigen::Vector3d lift = Eigen::Vector3d::Zero();
  double longest = 0.0;
  for (int k = 0; k < 3; ++k) {
    longest = std::max(longest, (corners[(k + 1) % 3] - corners[k]).norm());
    Eigen::Vector3d n = normals[k];
    if (!(n.allFinite() && n.norm() > 1e-6)) continue;
    n.normalize();
    if (n.dot(outward) < 0.0) n = -n;
    const double above = (point - corners[k]).dot(n);
    if (above < 0.0) lift -= weights[k] * above * n;
  }
  const double most = kMaxLift * longest;
  if (lift.norm() > most) lift *= most / lift.norm();
  return point + lift;
}

}  // namespace

struct Scene::Impl {
  enum class Kind { kSphere, kMesh, kNormalMap };
  Kind kind = Kind::kSphere;
  Image normals;
  TriangleMesh mesh;
  Eigen::Vector3d center = Eigen::Vector3d::Zero();  // of sphere or bounds
  // The same among the mesh's vertices, whose origin may be elsewhere.
  Eigen::Vector3d mesh_center = Eigen::Vector3d::Zero();
  double radius = 1.0;
  RTCDevice device = nullptr;
  RTCScene embree = nullptr;

  Impl() = default;
  Impl(const Impl&) = delete;
  Impl& operator=(const Impl&) = delete;
  ~Impl() {
    if (embree != nullptr) rtcReleaseScene(embree);
    if (device != nullptr) rtcReleaseDevice(device);
  }

  bool BuildEmbree();
  bool IntersectMesh(const Ray& ray, bool from_infinity, SurfaceHit* hit) const;
  // In the frame that Embree knows, of unit bounds.
  static RTCRay RayFrom(const Eigen::Vector3d& origin,
                        const Eigen::Vector3d& direction);
  // The interpolated normal of a hit, or the triangle's where there is none.
  // Sets the triangle's, on the same side; wo: to the viewer.
  Eigen::Vector3d NormalAt(const RTCHit& hit, const Eigen::Vector3d& wo,
                           Eigen::Vector3d* geometric) const;
  // SurfaceHit::position; outward: the triangle's normal on the viewer's side.
  Eigen::Vector3d LiftedPosition(const RTCHit& hit,
                                 const Eigen::Vector3d& outward) const;
  bool MeshOccludes(const Eigen::Vector3d& position,
                    const Eigen::Vector3d& direction) const;
  void MeshOccludes(const Eigen::Vector3d& position,
                    const std::vector<Eigen::Vector3f>& directions,
                    uint8_t* hidden) const;
};

bool Scene::Impl::BuildEmbree() {
  device = rtcNewDevice("threads=1");
  if (device == nullptr) return false;
  embree = rtcNewScene(device);
  rtcSetSceneFlags(embree, RTC_SCENE_FLAG_ROBUST);
  RTCGeometry geometry = rtcNewGeometry(device, RTC_GEOMETRY_TYPE_TRIANGLE);
  auto* vertices = static_cast<float*>(rtcSetNewGeometryBuffer(
      geometry, RTC_BUFFER_TYPE_VERTEX, 0, RTC_FORMAT_FLOAT3, 3 * sizeof(float),
      mesh.vertices.size()));
  auto* indices = static_cast<unsigned*>(rtcSetNewGeometryBuffer(
      geometry, RTC_BUFFER_TYPE_INDEX, 0, RTC_FORMAT_UINT3,
      3 * sizeof(unsigned), mesh.triangles.size()));
  if (vertices == nullptr || indices == nullptr) {
    rtcReleaseGeometry(geometry);
    return false;
  }
  // Unit bounds: Embree's float tolerances then fit any unit of length.
  for (size_t v = 0; v < mesh.vertices.size(); ++v) {
    const Eigen::Vector3d p =
        (mesh.vertices[v].cast<double>() - mesh_center) / radius;
    for (int k = 0; k < 3; ++k) vertices[3 * v + k] = static_cast<float>(p[k]);
  }
  for (size_t t = 0; t < mesh.triangles.size(); ++t) {
    for (int k = 0; k < 3; ++k) {
      indices[3 * t + k] = static_cast<unsigned>(mesh.triangles[t][k]);
    }
  }
  rtcCommitGeometry(geometry);
  rtcAttachGeometry(embree, geometry);
  rtcReleaseGeometry(geometry);
  rtcCommitScene(embree);
  return rtcGetDeviceError(device) == RTC_ERROR_NONE;
}

bool Scene::Impl::IntersectMesh(const Ray& ray, bool from_infinity,
                                SurfaceHit* hit) const {
  const Eigen::Vector3d origin = (ray.origin - center) / radius;
  // Start just before the bounding sphere: float keeps its precision there.
  const double to_center = -origin.dot(ray.direction);
  double start = to_center - 1.5;
  if (!from_infinity) start = std::max(start, 0.0);

  RTCRayHit query{};
  query.ray = RayFrom(origin + start * ray.direction, ray.direction);
  query.hit.geomID = RTC_INVALID_GEOMETRY_ID;
  RTCIntersectContext context;
  rtcInitIntersectContext(&context);
  rtcIntersect1(embree, &context, &query);
  if (query.hit.geomID == RTC_INVALID_GEOMETRY_ID) return false;

  const Eigen::Vector3d wo = -ray.direction;
  Eigen::Vector3d geometric;
  const Eigen::Vector3d normal = NormalAt(query.hit, wo, &geometric);
  hit->position = LiftedPosition(query.hit, geometric.dot(wo) < 0.0
                                                ? Eigen::Vector3d(-geometric)
                                                : geometric);
  if (!mesh.texture.empty()) {
    const std::array<Eigen::Vector2f, 3>& uv = mesh.texture[query.hit.primID];
    const float u = query.hit.u, v = query.hit.v;
    hit->texture = (1.0f - u - v) * uv[0] + u * uv[1] + v * uv[2];
  }
  hit->distance = (start + query.ray.tfar) * radius;
  hit->normal = FaceViewer(normal, geometric, wo);
  return true;
}

RTCRay Scene::Impl::RayFrom(const Eigen::Vector3d& origin,
                            const Eigen::Vector3d& direction) {
  RTCRay ray{};
  ray.org_x = static_cast<float>(origin.x());
  ray.org_y = static_cast<float>(origin.y());
  ray.org_z = static_cast<float>(origin.z());
  ray.dir_x = static_cast<float>(direction.x());
  ray.dir_y = static_cast<float>(direction.y());
  ray.dir_z = static_cast<float>(direction.z());
  ray.tnear = 0.0f;
  ray.tfar = std::numeric_limits<float>::infinity();
  ray.mask = ~0u;
  return ray;
}

Eigen::Vector3d Scene::Impl::NormalAt(const RTCHit& hit,
                                      const Eigen::Vector3d& wo,
                                      Eigen::Vector3d* geometric) const {
  *geometric = Eigen::Vector3d(hit.Ng_x, hit.Ng_y, hit.Ng_z);
  if (geometric->allFinite() && geometric->norm() > 0.0) {
    geometric->normalize();
  } else {
    *geometric = wo;
  }
  if (mesh.normals.empty()) return *geometric;
  const std::array<int, 3>& triangle = mesh.triangles[hit.primID];
  const double u = hit.u, v = hit.v;
  const Eigen::Vector3d smooth =
      (1.0 - u - v) * mesh.normals[triangle[0]].cast<double>() +
      u * mesh.normals[triangle[1]].cast<double>() +
      v * mesh.normals[triangle[2]].cast<double>();
  if (!smooth.allFinite() || !(smooth.norm() > 1e-6)) return *geometric;
  const Eigen::Vector3d normal = smooth.normalized();
  // The winding may disagree with the normals: the side that the viewer sees
  // decides.
  if (geometric->dot(normal) < 0.0) *geometric = -*geometric;
  return normal;
}

Eigen::Vector3d Scene::Impl::LiftedPosition(
    const RTCHit& hit, const Eigen::Vector3d& outward) const {
  const std::array<int, 3>& triangle = mesh.triangles[hit.primID];
  const double weights[3] = {1.0 - hit.u - hit.v, hit.u, hit.v};
  Eigen::Vector3d corners[3], corner_normals[3];
  for (int k = 0; k < 3; ++k) {
    corners[k] =
        (mesh.vertices[triangle[k]].cast<double>() - mesh_center) / radius;
    corner_normals[k] = outward;
    if (!mesh.normals.empty()) {
      corner_normals[k] = mesh.normals[triangle[k]].cast<double>();
    }
  }
  return center + radius * (LiftToSmoothSurface(corners, corner_normals,
                                                weights, outward) +
                            kShadowOffset * outward);
}

bool Scene::Impl::MeshOccludes(const Eigen::Vector3d& position,
                               const Eigen::Vector3d& direction) const {
  RTCRay ray = RayFrom((position - center) / radius, direction);
  RTCIntersectContext context;
  rtcInitIntersectContext(&context);
  rtcOccluded1(embree, &context, &ray);
  return ray.tfar < 0.0f;
}

void Scene::Impl::MeshOccludes(const Eigen::Vector3d& position,
                               const std::vector<Eigen::Vector3f>& directions,
                               uint8_t* hidden) const {
  constexpr size_t kPacket = 8;
  const Eigen::Vector3f o = ((position - center) / radius).cast<float>();
  RTCRay8 rays{};
  for (size_t k = 0; k < kPacket; ++k) {
    rays.org_x[k] = o.x();
    rays.org_y[k] = o.y();
    rays.org_z[k] = o.z();
    rays.mask[k] = ~0u;
  }
  RTCIntersectContext context;
  rtcInitIntersectContext(&context);
  for (size_t begin = 0; begin < directions.size(); begin += kPacket) {
    const size_t count = std::min(kPacket, directions.size() - begin);
    alignas(32) int valid[kPacket] = {};
    for (size_t k = 0; k < count; ++k) {
      const Eigen::Vector3f& direction = directions[begin + k];
      valid[k] = -1;
      rays.dir_x[k] = direction.x();
      rays.dir_y[k] = direction.y();
      rays.dir_z[k] = direction.z();
      rays.tnear[k] = 0.0f;
      rays.tfar[k] = std::numeric_limits<float>::infinity();
    }
    rtcOccluded8(valid, embree, &context, &rays);
    for (size_t k = 0; k < count; ++k) {
      hidden[begin + k] = rays.tfar[k] < 0.0f ? 1 : 0;
    }
  }
}

Eigen::Vector2f SphereTexture(const Eigen::Vector3d& direction) {
  const double longitude = std::atan2(direction.x(), direction.z());
  const double polar = std::acos(std::clamp(direction.y(), -1.0, 1.0));
  return Eigen::Vector2d(0.5 + longitude / (2.0 * kPi), 1.0 - polar / kPi)
      .cast<float>();
}

Scene Scene::UnitSphere() { return Scene(std::make_shared<Impl>()); }

Scene Scene::Sphere(const Eigen::Vector3d& center, double radius) {
  CHECK(center.allFinite() && radius > 0.0 && std::isfinite(radius));
  auto impl = std::make_shared<Impl>();
  impl->center = center;
  impl->radius = radius;
  return Scene(std::move(impl));
}

StatusOr<Scene> Scene::FromMesh(const TriangleMesh& mesh,
                                const Eigen::Vector3d& origin) {
  const auto num_vertices = static_cast<int>(mesh.vertices.size());
  if (!mesh.normals.empty() && mesh.normals.size() != mesh.vertices.size()) {
    return InvalidInput("mesh", "expected one normal per vertex or none");
  }
  if (!mesh.texture.empty() && mesh.texture.size() != mesh.triangles.size()) {
    return InvalidInput("mesh",
                        "expected texture coordinates of all triangles or "
                        "none");
  }
  Eigen::Vector3d low = Eigen::Vector3d::Constant(1e300), high = -low;
  bool has_area = false;
  for (const std::array<int, 3>& t : mesh.triangles) {
    Eigen::Vector3d p[3];
    for (int k = 0; k < 3; ++k) {
      if (t[k] < 0 || t[k] >= num_vertices) {
        return InvalidInput("mesh", "triangle refers to vertex " +
                                        std::to_string(t[k]) + " of " +
                                        std::to_string(num_vertices));
      }
      p[k] = mesh.vertices[t[k]].cast<double>();
      if (!p[k].allFinite()) {
        return InvalidInput(
            "mesh", "vertex " + std::to_string(t[k]) + " is not finite");
      }
      low = low.cwiseMin(p[k]);
      high = high.cwiseMax(p[k]);
    }
    has_area = has_area || (p[1] - p[0]).cross(p[2] - p[0]).norm() > 0.0;
  }
  if (!has_area) {
    return InvalidInput("mesh", "expected a triangle of positive area");
  }
  auto impl = std::make_shared<Impl>();
  impl->kind = Impl::Kind::kMesh;
  impl->mesh = mesh;
  impl->mesh_center = 0.5 * (low + high);
  impl->center = origin + impl->mesh_center;
  impl->radius = 0.5 * (high - low).norm();
  if (!impl->BuildEmbree()) {
    return Status(StatusCode::kInternal, "mesh: Embree could not build it");
  }
  return Scene(std::move(impl));
}

StatusOr<Scene> Scene::FromNormalMap(const Image& normals) {
  auto impl = std::make_shared<Impl>();
  impl->kind = Impl::Kind::kNormalMap;
  impl->normals = normals;
  bool any = false;
  for (size_t i = 0; i < normals.num_pixels(); ++i) {
    Eigen::Map<Eigen::Vector3f> n(impl->normals.rgb.data() + 3 * i);
    // In double: squares of floats may be beyond them.
    const Eigen::Vector3d exact = n.cast<double>();
    const double length = exact.norm();
    if (std::isfinite(length) && length > 1e-6) {
      n = (exact / length).cast<float>();
      any = true;
    } else {
      n.setZero();
    }
  }
  if (!any) return InvalidInput("normals", "expected a normal in some pixel");
  return Scene(std::move(impl));
}

bool Scene::Intersect(const Ray& ray, bool from_infinity,
                      SurfaceHit* hit) const {
  switch (impl_->kind) {
    case Impl::Kind::kSphere:
      return IntersectSphere(ray, impl_->center, impl_->radius, from_infinity,
                             hit);
    case Impl::Kind::kMesh:
      return impl_->IntersectMesh(ray, from_infinity, hit);
    case Impl::Kind::kNormalMap:
      return false;
  }
  return false;
}

bool Scene::Occluded(const Eigen::Vector3d& position,
                     const Eigen::Vector3d& direction) const {
  return CastsShadows() && impl_->MeshOccludes(position, direction);
}

void Scene::Occluded(const Eigen::Vector3d& position,
                     const std::vector<Eigen::Vector3f>& directions,
                     uint8_t* hidden) const {
  if (CastsShadows()) {
    impl_->MeshOccludes(position, directions, hidden);
  } else {
    std::fill_n(hidden, directions.size(), uint8_t{0});
  }
}

bool Scene::CastsShadows() const { return impl_->kind == Impl::Kind::kMesh; }

BoundingBall Scene::Bounds() const {
  CHECK(impl_->kind != Impl::Kind::kNormalMap);
  return {impl_->center, impl_->radius};
}

const Image& Scene::normal_map() const { return impl_->normals; }

}  // namespace ibrdf
