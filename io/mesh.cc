#include "ibrdf/io/mesh.h"

#include <Eigen/Geometry>
#include <algorithm>
#include <array>
#include <cmath>
#include <cstdint>
#include <cstring>
#include <numeric>
#include <unordered_map>
#include <utility>
#include <vector>

#include "ibrdf/io/atomic_file.h"
#include "ibrdf/io/file_extension.h"
#include "ibrdf/io/polygon_mesh.h"

namespace ibrdf {
namespace {

constexpr size_t kMaxMeshFileBytes = size_t{512} << 20;

// Normals of one position that differ by less than 0.08 degrees are one normal,
// rounded differently.
constexpr float kMinSameNormalCosine = 1.0f - 1e-6f;

// Position, bit by bit.
using VertexKey = std::array<uint32_t, 3>;

struct VertexKeyHash {
  size_t operator()(const VertexKey& key) const {
    uint64_t hash = 14695981039346656037u;  // FNV-1a, by words
    for (const uint32_t word : key) hash = (hash ^ word) * 1099511628211u;
    return static_cast<size_t>(hash ^ (hash >> 32));
  }
};

VertexKey MakeKey(const Eigen::Vector3f& position) {
  VertexKey key;
  for (int i = 0; i < 3; ++i) {
    const float p = position[i] + 0.0f;  // -0 and 0 are one vertex
    std::memcpy(&key[i], &p, sizeof(p));
  }
  return key;
}

using Points = std::vector<Eigen::Vector2d>;

// Twice the area of the triangle, negative where it runs clockwise.
double Area(const Eigen::Vector2d& a, const Eigen::Vector2d& b,
            const Eigen::Vector2d& c) {
  const Eigen::Vector2d u = b - a, v = c - a;
  return u.x() * v.y() - u.y() * v.x();
}

// The polygon as its normal sees it, counterclockwise but for rounding: without
// the coordinate in which the normal is longest.
Points Project(const std::vector<Eigen::Vector3d>& polygon) {
  Eigen::Vector3d normal = Eigen::Vector3d::Zero();  // twice the area
  for (size_t i = 1; i + 1 < polygon.size(); ++i) {
    normal += (polygon[i] - polygon[0]).cross(polygon[i + 1] - polygon[0]);
  }
  int axis = 0;
  normal.cwiseAbs().maxCoeff(&axis);
  const int x = (axis + 1) % 3, y = (axis + 2) % 3;
  Points points;
  for (const Eigen::Vector3d& p : polygon) {
    points.emplace_back(normal[axis] < 0.0 ? -p[x] : p[x], p[y]);
  }
  return points;
}

// Whether the corner left[at] can be cut off: it turns left, and no other
// corner that is left lies in its triangle.
bool IsEar(const Points& points, const std::vector<int>& left, size_t at) {
  const size_t n = left.size();
  const Eigen::Vector2d& a = points[left[(at + n - 1) % n]];
  const Eigen::Vector2d& b = points[left[at]];
  const Eigen::Vector2d& c = points[left[(at + 1) % n]];
  if (!(Area(a, b, c) > 0.0)) return false;
  for (const int i : left) {
    const Eigen::Vector2d& p = points[i];
    if (p != a && p != b && p != c && Area(a, b, p) >= 0.0 &&
        Area(b, c, p) >= 0.0 && Area(c, a, p) >= 0.0) {
      return false;
    }
  }
  return true;
}

// Calls visit(i, j, k) for triangles of corners that fill the polygon: cuts
// ears off (Meisters 1975), from the second corner on, so that a convex polygon
// becomes a fan. Where there is none, as in one without area or that crosses
// itself, what is left becomes a fan.
template <typename Visit>
void Triangulate(const std::vector<Eigen::Vector3d>& polygon,
                 const Visit& visit) {
  if (polygon.size() == 3) return visit(0, 1, 2);
  const Points points = Project(polygon);
  std::vector<int> left(polygon.size());
  std::iota(left.begin(), left.end(), 0);
  size_t at = 1, refused = 0;  // since the last cut
  while (left.size() > 2) {
    const size_t n = left.size();
    const bool any = refused >= n;
    if (!any && !IsEar(points, left, at)) {
      at = (at + 1) % n;
      ++refused;
      continue;
    }
    visit(left[(at + n - 1) % n], left[at], left[(at + 1) % n]);
    left.erase(left.begin() + static_cast<std::ptrdiff_t>(at));
    at %= left.size();
    if (!any) refused = 0;
  }
}

// Where floats of coordinates would be coarse, the centre of the bounds; else
// 0.
Eigen::Vector3d FarOrigin(const PolygonMesh& polygons) {
  // Coordinates within so many sizes of the mesh keep 17 of a float's 24 bits.
  constexpr double kNearSizes = 128.0;
  Eigen::Vector3d low = polygons.vertices[0], high = low;
  for (const Eigen::Vector3d& v : polygons.vertices) {
    low = low.cwiseMin(v);
    high = high.cwiseMax(v);
  }
  const Eigen::Vector3d centre = 0.5 * low + 0.5 * high;
  const double size = (high - low).maxCoeff();
  return centre.cwiseAbs().maxCoeff() > kNearSizes * size
             ? centre
             : Eigen::Vector3d(Eigen::Vector3d::Zero());
}

// Joins corners of one position to vertices.
class VertexJoiner {
 public:
  VertexJoiner(const PolygonMesh& polygons, const Eigen::Vector3d& origin,
               TriangleMesh* mesh)
      : polygons_(polygons),
        origin_(origin),
        mesh_(mesh),
        has_normals_(!polygons.corner_normals.empty()),
        agree_(true) {}

  Eigen::Vector3f Position(size_t corner) const {
    return (polygons_.vertices[polygons_.corners[corner]] - origin_)
        .cast<float>();
  }

  // The corner's vertex, added where its position is new.
  int Vertex(size_t corner) {
    const Eigen::Vector3f normal = Normal(corner);
    const Eigen::Vector3f position = Position(corner);
    const auto [it, added] = index_of_.emplace(
        MakeKey(position), static_cast<int>(mesh_->vertices.size()));
    if (added) {
      mesh_->vertices.push_back(position);
      mesh_->normals.push_back(normal);
    } else if (mesh_->normals[it->second].dot(normal) < kMinSameNormalCosine) {
      agree_ = false;
    }
    return it->second;
  }

  bool HasNormals() const { return has_normals_; }
  // Whether all corners of a vertex have one normal.
  bool Agree() const { return agree_; }

 private:
  Eigen::Vector3f Normal(size_t corner) const {
    if (!has_normals_) return Eigen::Vector3f::Zero();
    return polygons_.normals[polygons_.corner_normals[corner]]
        .cast<double>()
        .normalized()
        .cast<float>();
  }

  const PolygonMesh& polygons_;
  Eigen::Vector3d origin_;
  TriangleMesh* mesh_;
  bool has_normals_, agree_;
  std::unordered_map<VertexKey, int, VertexKeyHash> index_of_;
};

std::string CountOf(size_t count, size_t all) {
  return std::to_string(count) + " of " + std::to_string(all) + " normals ";
}

// Settles the normals (ReadMesh) of a mesh that has the file's.
void MendNormals(const std::string& path, bool agree, TriangleMesh* mesh,
                 MeshNotes* notes) {
  const size_t all = mesh->normals.size();
  const auto zero = static_cast<size_t>(
      std::count_if(mesh->normals.begin(), mesh->normals.end(),
                    [](const Eigen::Vector3f& n) { return n.isZero(); }));
  if (zero > 0) {
    notes->warnings.push_back(path + ": " + CountOf(zero, all) +
                              "are zero or not finite; all were made from the "
                              "faces");
  }
  if (zero > 0 || !agree) return ComputeVertexNormals(mesh);
  const std::vector<int> against = NormalsAgainstFaces(*mesh);
  if (against.empty()) return;
  const bool many = 100 * against.size() > all;
  notes->warnings.push_back(path + ": " + CountOf(against.size(), all) +
                            "contradict the faces around them; " +
                            (many ? "all" : "these") +
                            " were made from the faces");
  TriangleMesh computed = *mesh;
  ComputeVertexNormals(&computed);
  if (many) {
    mesh->normals = std::move(computed.normals);
    return;
  }
  for (const int v : against) mesh->normals[v] = computed.normals[v];
}

TriangleMesh ToTriangles(const std::string& path, const PolygonMesh& polygons,
                         MeshNotes* notes) {
  TriangleMesh result;
  notes->origin = FarOrigin(polygons);
  notes->texture_fault = polygons.texture_fault;
  VertexJoiner joiner(polygons, notes->origin, &result);
  std::vector<Eigen::Vector3d> polygon;
  size_t first = 0;
  for (const int size : polygons.sizes) {
    polygon.clear();
    for (int i = 0; i < size; ++i) {
      polygon.push_back(joiner.Position(first + i).cast<double>());
    }
    Triangulate(polygon, [&](int i, int j, int k) {
      // Braces: vertices are numbered from left to right.
      result.triangles.push_back({joiner.Vertex(first + i),
                                  joiner.Vertex(first + j),
                                  joiner.Vertex(first + k)});
      if (polygons.corner_texture.empty()) return;
      const auto uv = [&](int corner) {
        return polygons.texture[polygons.corner_texture[first + corner]];
      };
      result.texture.push_back({uv(i), uv(j), uv(k)});
    });
    first += static_cast<size_t>(size);
  }
  if (joiner.HasNormals()) {
    MendNormals(path, joiner.Agree(), &result, notes);
  } else {
    ComputeVertexNormals(&result);
  }
  return result;
}

using PolygonParser = StatusOr<PolygonMesh>(const std::string& path,
                                            const std::string& bytes);

// The parser of a file by its extension; null for other extensions.
PolygonParser* ParserOf(const std::string& path) {
  const std::string extension = FileExtension(path);
  if (extension == "obj") return ParseObj;
  if (extension == "ply") return ParsePly;
  if (extension == "stl") return ParseStl;
  if (extension == "glb") return ParseGlb;
  return nullptr;
}

Status UnknownMeshExtension(const std::string& path) {
  return InvalidInput(path + ": extension",
                      FileExtension(path) == "gltf"
                          ? "expected .glb, glTF in one file with its buffer"
                          : "expected .obj, .ply, .stl or .glb");
}

}  // namespace

StatusOr<TriangleMesh> ReadMesh(const std::string& path, MeshNotes* notes) {
  if (ParserOf(path) == nullptr) return UnknownMeshExtension(path);
  const StatusOr<std::string> bytes = ReadFile(path, kMaxMeshFileBytes);
  if (!bytes.ok()) return bytes.status();
  return DecodeMesh(path, *bytes, notes);
}

StatusOr<TriangleMesh> DecodeMesh(const std::string& path,
                                  const std::string& bytes, MeshNotes* notes) {
  PolygonParser* const parse = ParserOf(path);
  if (parse == nullptr) return UnknownMeshExtension(path);
  const StatusOr<PolygonMesh> polygons = parse(path, bytes);
  if (!polygons.ok()) return polygons.status();
  MeshNotes unused;
  return ToTriangles(path, *polygons, notes != nullptr ? notes : &unused);
}

}  // namespace ibrdf
