#include "ibrdf/io/polygon_mesh.h"

namespace ibrdf {

bool AppendVertex(const double xyz[3], PolygonMesh* mesh) {
  const Eigen::Map<const Eigen::Vector3d> v(xyz);
  if (!v.cast<float>().allFinite()) return false;
  mesh->vertices.push_back(v);
  return true;
}

void AppendNormal(const double xyz[3], PolygonMesh* mesh) {
  const Eigen::Vector3f v =
      Eigen::Map<const Eigen::Vector3d>(xyz).cast<float>();
  mesh->normals.push_back(v.allFinite() ? v : Eigen::Vector3f::Zero().eval());
}

bool AppendTexture(const double uv[2], PolygonMesh* mesh) {
  const Eigen::Vector2f v = Eigen::Map<const Eigen::Vector2d>(uv).cast<float>();
  mesh->texture.push_back(v);
  if (v.allFinite()) return true;
  mesh->texture_fault = "expected finite texture coordinates";
  return false;
}

void UseVertexTexture(PolygonMesh* mesh) {
  if (mesh->texture.empty()) return;
  if (mesh->texture.size() != mesh->vertices.size()) {
    mesh->texture_fault = "expected texture coordinates on all faces";
  }
  if (mesh->texture_fault.empty()) {
    mesh->corner_texture = mesh->corners;
  } else {
    mesh->texture.clear();
  }
}

bool AppendTriangle(int a, int b, int c, PolygonMesh* mesh) {
  if (a == b || b == c || c == a) return true;
  if (mesh->sizes.size() >= kMaxStripTriangles) return false;
  mesh->sizes.push_back(3);
  mesh->corners.insert(mesh->corners.end(), {a, b, c});
  return true;
}

bool AppendStrip(const std::vector<int>& strip, PolygonMesh* mesh) {
  for (size_t i = 2; i < strip.size(); ++i) {
    const bool odd = i % 2 == 1;
    if (!AppendTriangle(strip[odd ? i - 1 : i - 2], strip[odd ? i - 2 : i - 1],
                        strip[i], mesh)) {
      return false;
    }
  }
  return true;
}

}  // namespace ibrdf
