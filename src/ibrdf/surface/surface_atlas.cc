#include "ibrdf/surface/surface_atlas.h"

#include <glog/logging.h>

#include <Eigen/Geometry>
#include <algorithm>
#include <cmath>
#include <string>

#include "ibrdf/base/format.h"
#include "ibrdf/base/pi.h"
#include "ibrdf/surface/plane.h"

namespace ibrdf {
namespace {

using Point = Eigen::Vector2d;
using Polygon = std::vector<Point>;

constexpr double kOverlap = 1.01;
// Rounding of texture coordinates at the borders.
constexpr float kOutside = 1e-5f;

void SetFrame(const Eigen::Vector3d& normal, SurfaceTexel* texel) {
  const Eigen::Vector3d n = normal.normalized();
  const Eigen::Vector3d side = std::abs(n.y()) > 0.9
                                   ? Eigen::Vector3d(1.0, 0.0, 0.0)
                                   : Eigen::Vector3d(0.0, 1.0, 0.0);
  const Eigen::Vector3d tangent = side.cross(n).normalized();
  texel->normal = n.cast<float>();
  texel->tangent = tangent.cast<float>();
  texel->bitangent = n.cross(tangent).cast<float>();
}

// The part of a convex polygon where axis * (p[k] - at) <= 0.
void ClipAt(int k, double at, double axis, Polygon* polygon) {
  Polygon kept;
  const size_t n = polygon->size();
  for (size_t i = 0; i < n; ++i) {
    const Point& a = (*polygon)[i];
    const Point& b = (*polygon)[(i + 1) % n];
    const double from = axis * (a[k] - at), to = axis * (b[k] - at);
    if (from <= 0.0) kept.push_back(a);
    if ((from < 0.0 && to > 0.0) || (from > 0.0 && to < 0.0)) {
      kept.push_back(a + (from / (from - to)) * (b - a));
    }
  }
  polygon->swap(kept);
}

// Area, and the centroid where there is any.
double AreaOf(const Polygon& polygon, Point* centroid) {
  double twice = 0.0;
  Point sum = Point::Zero();
  for (size_t i = 1; i + 1 < polygon.size(); ++i) {
    const double a =
        Cross(polygon[i] - polygon[0], polygon[i + 1] - polygon[0]);
    twice += a;
    sum += a * (polygon[0] + polygon[i] + polygon[i + 1]) / 3.0;
  }
  if (twice != 0.0) *centroid = sum / twice;
  return 0.5 * std::abs(twice);
}

// Adds the texels of triangles, one triangle after another.
class Rasterizer {
 public:
  Rasterizer(const TriangleMesh& mesh, const Eigen::Vector3d& origin,
             SurfaceAtlas* atlas)
      : mesh_(mesh),
        origin_(origin),
        atlas_(*atlas),
        pieces_(static_cast<size_t>(atlas->width) * atlas->height) {}

  void Add(size_t t) {
    Corner corners[3];
    for (int k = 0; k < 3; ++k) {
      const Eigen::Vector2f& uv = mesh_.texture[t][k];
      corners[k].at = {uv.x() * static_cast<double>(atlas_.width),
                       (1.0 - uv.y()) * atlas_.height};
      corners[k].vertex = mesh_.triangles[t][k];
    }
    const Point u = corners[1].at - corners[0].at;
    const Point v = corners[2].at - corners[0].at;
    const double twice = Cross(u, v);
    const Eigen::Vector3d n = Normal(corners);
    // The surface's area over one texel's in the picture.
    const double scale = n.norm() / std::abs(twice);
    if (!(std::abs(twice) > 0.0) || !std::isfinite(scale)) {
      atlas_.area_without += 0.5 * n.norm();
      return;
    }
    AddPieces(corners, twice, n, scale);
  }

  // What the pieces add up to.
  void Finish() {
    for (size_t i = 0; i < pieces_.size(); ++i) {
      const Piece& piece = pieces_[i];
      if (!(piece.covered > 0.0)) continue;
      SurfaceTexel texel;
      texel.texel = static_cast<int>(i);
      texel.position = piece.position;
      texel.area = static_cast<float>(piece.area);
      SetFrame(piece.normal, &texel);
      atlas_.texels.push_back(texel);
      atlas_.overlapped += piece.covered > kOverlap;
    }
  }

 private:
  struct Corner {
    Point at;  // in texels, y down
    int vertex;
  };
  // What is known of a texel.
  struct Piece {
    double covered = 0.0;  // of its area in the picture
    double area = 0.0;     // of the surface
    double largest = 0.0;  // piece so far; 2 where the centre is in it
    Eigen::Vector3d position = Eigen::Vector3d::Zero();
    Eigen::Vector3d normal = Eigen::Vector3d::Zero();
  };

  Eigen::Vector3d Vertex(int v) const {
    return mesh_.vertices[v].cast<double>();
  }
  // Twice the area long.
  Eigen::Vector3d Normal(const Corner corners[3]) const {
    const Eigen::Vector3d a = Vertex(corners[0].vertex);
    return (Vertex(corners[1].vertex) - a).cross(Vertex(corners[2].vertex) - a);
  }

  void AddPieces(const Corner corners[3], double twice,
                 const Eigen::Vector3d& n, double scale) {
    Polygon triangle;
    for (int k = 0; k < 3; ++k) triangle.push_back(corners[k].at);
    Point low = triangle[0], high = triangle[0];
    for (const Point& p : triangle) {
      low = low.cwiseMin(p);
      high = high.cwiseMax(p);
    }
    const auto cell = [](double x, int count) {
      return std::clamp(static_cast<int>(std::floor(x)), 0, count - 1);
    };
    const int bottom = cell(high.y(), atlas_.height);
    const int right = cell(high.x(), atlas_.width);
    for (int y = cell(low.y(), atlas_.height); y <= bottom; ++y) {
      Polygon row = triangle;
      ClipTo(1, y, atlas_.height, &row);
      for (int x = cell(low.x(), atlas_.width); x <= right; ++x) {
        Polygon piece = row;
        ClipTo(0, x, atlas_.width, &piece);
        AddPiece(corners, twice, n, scale, x, y, piece);
      }
    }
  }

  // To a row or column of texels; the outer ones take what lies beyond them by
  // rounding.
  static void ClipTo(int k, int at, int count, Polygon* polygon) {
    if (at > 0) ClipAt(k, at, -1.0, polygon);
    if (at + 1 < count) ClipAt(k, at + 1, 1.0, polygon);
  }

  void AddPiece(const Corner corners[3], double twice, const Eigen::Vector3d& n,
                double scale, int x, int y, const Polygon& polygon) {
    Point at = Point::Zero();
    const double covered = AreaOf(polygon, &at);
    if (!(covered > 0.0)) return;
    Piece& piece = pieces_[static_cast<size_t>(y) * atlas_.width + x];
    piece.covered += covered;
    piece.area += scale * covered;
    const Point centre(x + 0.5, y + 0.5);
    double weights[3];
    const bool holds = Weights(corners, twice, centre, weights);
    const double size = holds ? 2.0 : covered;
    if (!(size > piece.largest)) return;
    piece.largest = size;
    if (!holds) Weights(corners, twice, at, weights);
    piece.position = origin_;
    for (int k = 0; k < 3; ++k) {
      piece.position += weights[k] * Vertex(corners[k].vertex);
    }
    piece.normal = ShadingNormal(corners, weights, n);
  }

  // Barycentric; whether none is below 0.
  static bool Weights(const Corner corners[3], double twice, const Point& p,
                      double weights[3]) {
    for (int k = 0; k < 3; ++k) {
      const Point& b = corners[(k + 1) % 3].at;
      const Point& c = corners[(k + 2) % 3].at;
      weights[k] = Cross(b - p, c - p) / twice;
    }
    return weights[0] >= 0.0 && weights[1] >= 0.0 && weights[2] >= 0.0;
  }

  Eigen::Vector3d ShadingNormal(const Corner corners[3],
                                const double weights[3],
                                const Eigen::Vector3d& n) const {
    if (mesh_.normals.empty()) return n;
    Eigen::Vector3d sum = Eigen::Vector3d::Zero();
    for (int k = 0; k < 3; ++k) {
      sum += weights[k] * mesh_.normals[corners[k].vertex].cast<double>();
    }
    constexpr double kLeast = 1e-6;
    return sum.allFinite() && sum.norm() > kLeast ? sum : n;
  }

  const TriangleMesh& mesh_;
  const Eigen::Vector3d origin_;
  SurfaceAtlas& atlas_;
  std::vector<Piece> pieces_;
};

}  // namespace

SurfaceAtlas SurfaceAtlas::OfSphere(const Eigen::Vector3d& centre,
                                    double radius, int width, int height) {
  CHECK(width > 0 && height > 0 && radius > 0.0);
  SurfaceAtlas atlas;
  atlas.width = width;
  atlas.height = height;
  for (int y = 0; y < height; ++y) {
    const double polar = kPi * (y + 0.5) / height;
    const double band =
        std::cos(kPi * y / height) - std::cos(kPi * (y + 1) / height);
    for (int x = 0; x < width; ++x) {
      const double longitude = 2.0 * kPi * ((x + 0.5) / width - 0.5);
      const Eigen::Vector3d n(std::sin(polar) * std::sin(longitude),
                              std::cos(polar),
                              std::sin(polar) * std::cos(longitude));
      SurfaceTexel texel;
      texel.texel = y * width + x;
      texel.position = centre + radius * n;
      texel.area =
          static_cast<float>(radius * radius * band * 2.0 * kPi / width);
      SetFrame(n, &texel);
      atlas.texels.push_back(texel);
    }
  }
  return atlas;
}

std::string TextureFault(const TriangleMesh& mesh) {
  if (mesh.texture.size() != mesh.triangles.size()) {
    return "expected texture coordinates of all faces";
  }
  for (const auto& corners : mesh.texture) {
    for (const Eigen::Vector2f& uv : corners) {
      if (uv.minCoeff() >= -kOutside && uv.maxCoeff() <= 1.0f + kOutside) {
        continue;
      }
      return "expected texture coordinates in [0, 1], found " +
             Format("%g, %g", uv.x(), uv.y());
    }
  }
  return "";
}

StatusOr<SurfaceAtlas> SurfaceAtlas::OfMesh(const TriangleMesh& mesh,
                                            const Eigen::Vector3d& origin,
                                            int width, int height) {
  CHECK(width > 0 && height > 0);
  const std::string fault = TextureFault(mesh);
  if (!fault.empty()) return InvalidInput("mesh", fault);
  SurfaceAtlas atlas;
  atlas.width = width;
  atlas.height = height;
  Rasterizer rasterizer(mesh, origin, &atlas);
  for (size_t t = 0; t < mesh.triangles.size(); ++t) rasterizer.Add(t);
  rasterizer.Finish();
  if (atlas.texels.empty()) {
    return InvalidInput("mesh",
                        "expected texture coordinates that span an area");
  }
  return atlas;
}

}  // namespace ibrdf
