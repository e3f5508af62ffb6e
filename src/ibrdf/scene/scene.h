// The object in front of the camera, and its points that pixels see.
#pragma once
#include <Eigen/Core>
#include <cstdint>
#include <memory>
#include <vector>

#include "ibrdf/base/status.h"
#include "ibrdf/geometry/camera.h"
#include "ibrdf/geometry/triangle_mesh.h"
#include "ibrdf/image/image.h"

namespace ibrdf {

// n.wo of a shading point is at least this: normals that face away from the
// viewer (interpolated ones at silhouettes) are turned to it.
inline constexpr float kMinViewCosine = 1e-3f;

// A surface point seen by a pixel. World frame; unit vectors.
struct ShadingPoint {
  Eigen::Vector3f normal;  // n.wo >= kMinViewCosine
  Eigen::Vector3f wo;      // to the viewer
  int pixel;               // y * width + x
  float coverage;          // share of the pixel's area it stands for, (0, 1]
  int index = 0;           // in the list of FindShadingPoints; copies keep it
  // Where shadow rays start: just above the smooth surface (see SurfaceHit).
  // The origin where a normal map gives no position.
  Eigen::Vector3d position = Eigen::Vector3d::Zero();
  // Which of the object's materials it is of, >= 0.
  int material = 0;
  // Which part of the surface it is of, >= 0: bins of like normals have one.
  int part = 0;
  // May show several materials: no search for reflectances rests on it.
  bool mixed = false;
  // Which of several views sees it, >= 0.
  int view = 0;
  // Texture coordinates (SurfaceHit).
  Eigen::Vector2f texture = Eigen::Vector2f::Zero();
};

struct SurfaceHit {
  double distance;         // along the ray
  Eigen::Vector3d normal;  // unit, as ShadingPoint
  // The point lifted off its triangle to the surface that interpolated normals
  // describe, and a little more to the viewer's side: a ray from here above the
  // horizon of `normal` meets no facet of a convex part.
  Eigen::Vector3d position = Eigen::Vector3d::Zero();
  // The mesh's, interpolated, or SphereTexture; 0 where a mesh has none.
  Eigen::Vector2f texture = Eigen::Vector2f::Zero();
};

// Texture coordinates of a sphere in a direction from its centre, unit: u is
// longitude, 1/2 at +z and growing toward +x, [0, 1]; v is latitude, 0 at -y
// and 1 at +y.
Eigen::Vector2f SphereTexture(const Eigen::Vector3d& direction);

struct BoundingBall {
  Eigen::Vector3d centre = Eigen::Vector3d::Zero();
  double radius = 0.0;
};

// Geometry that rays can be cast at. Immutable; safe to share between threads;
// copies share the geometry.
class Scene {
 public:
  // Unit sphere at the origin.
  static Scene UnitSphere();
  // center: finite; radius: > 0.
  static Scene Sphere(const Eigen::Vector3d& center, double radius);

  // Normals are interpolated between vertices where the mesh has them (one per
  // vertex), else taken from the triangle; the orientation of triangles and
  // normals does not matter. Fails on a mesh without a triangle of positive
  // area, an index out of range or a vertex that is not finite.
  // origin: of the vertices, in the world; for coordinates that floats hold too
  // coarsely.
  static StatusOr<Scene> FromMesh(
      const TriangleMesh& mesh,
      const Eigen::Vector3d& origin = Eigen::Vector3d::Zero());

  // rgb = unit normal in the camera's frame (x right, y up, z against the
  // view), one per pixel; zero length (or not finite) = outside the object.
  // Fails when none is set.
  static StatusOr<Scene> FromNormalMap(const Image& normals);

  // First hit of the ray. `from_infinity`: the ray's origin is any point of its
  // line. Always false for a normal map, which has no position.
  bool Intersect(const Ray& ray, bool from_infinity, SurfaceHit* hit) const;

  // Whether anything is hit from `position` on; direction: unit. Always false
  // where CastsShadows() is.
  bool Occluded(const Eigen::Vector3d& position,
                const Eigen::Vector3d& direction) const;
  // The same in many directions, neighbours best side by side, in packets:
  // hidden[i] = 1 where directions[i] hits, else 0.
  void Occluded(const Eigen::Vector3d& position,
                const std::vector<Eigen::Vector3f>& directions,
                uint8_t* hidden) const;

  // Whether the geometry may hide light from itself: meshes. The sphere is
  // convex, and a normal map has no position.
  bool CastsShadows() const;

  // About a sphere or mesh; CHECKs that it is no normal map.
  BoundingBall Bounds() const;

  // The normal map; empty for other geometry.
  const Image& normal_map() const;

 private:
  struct Impl;
  explicit Scene(std::shared_ptr<const Impl> impl) : impl_(std::move(impl)) {}
  std::shared_ptr<const Impl> impl_;
};

// The points that an image of width x height sees, by pixel in row order: the
// hits of samples_per_side^2 positions on a regular grid in every pixel inside
// `mask` (empty: all). 1: the pixel's centre. The camera of a normal map looks
// along -z with y up. Fails when the mask has another size, the camera is
// invalid or looks another way, a normal map has another size than the image,
// or no pixel sees the object. num_threads <= 0: all.
StatusOr<std::vector<ShadingPoint>> FindShadingPoints(
    const Scene& scene, const Camera& camera, int width, int height,
    const Mask& mask, int samples_per_side, int num_threads = 0);

// At most `most` of the points, evenly spread over the list.
std::vector<ShadingPoint> SpreadPoints(const std::vector<ShadingPoint>& points,
                                       size_t most);

}  // namespace ibrdf
