// Texels of a surface: where each is, and how large.
#pragma once
#include <Eigen/Core>
#include <vector>

#include "ibrdf/base/status.h"
#include "ibrdf/geometry/triangle_mesh.h"

namespace ibrdf {

// A texel of the picture that some of the surface is mapped to.
struct SurfaceTexel {
  int texel;                 // row * width + column; row 0 is the top, v = 1
  Eigen::Vector3d position;  // on the surface: of the texel's centre, or else
                             // of the middle of its largest piece
  // Unit, orthogonal, right-handed: tangent x bitangent = normal. tangent is
  // y x normal normalised, or x x normal where |normal.y| > 0.9 (Wiersma et al.
  // 2025, supplemental code).
  Eigen::Vector3f normal, tangent, bitangent;
  float area;  // of all of the surface that is mapped to it, world units
};

// Directions and positions are in the world's frame.
struct SurfaceAtlas {
  int width = 0, height = 0;
  std::vector<SurfaceTexel> texels;  // by `texel`
  // Texels onto which more than their own area is mapped, by a hundredth: some
  // of the surface overlaps there.
  int overlapped = 0;
  // The area of surface that is mapped to lines and points, and has no texel.
  double area_without = 0.0;

  // The latitude-longitude atlas of a sphere (SphereTexture). radius > 0;
  // width, height >= 1.
  static SurfaceAtlas OfSphere(const Eigen::Vector3d& centre, double radius,
                               int width, int height);

  // The atlas of a mesh with texture coordinates in [0, 1]^2, which has normals
  // or not; origin: of its vertices, in the world. Refuses others.
  static StatusOr<SurfaceAtlas> OfMesh(const TriangleMesh& mesh,
                                       const Eigen::Vector3d& origin, int width,
                                       int height);
};

// What keeps texture coordinates from being those of an atlas, beginning
// "expected"; empty where they are.
std::string TextureFault(const TriangleMesh& mesh);

}  // namespace ibrdf
