// Bytes of mesh files: one mesh in every format.
#pragma once
#include <Eigen/Core>
#include <array>
#include <cstdint>
#include <cstring>
#include <nlohmann/json.hpp>
#include <sstream>
#include <string>
#include <vector>

namespace ibrdf {

struct MeshSpec {
  std::vector<Eigen::Vector3d> vertices;
  std::vector<Eigen::Vector3d> normals;  // per vertex, or none
  std::vector<std::array<int, 3>> triangles;
};

// Closed, of volume 1/6.
inline MeshSpec Tetrahedron() {
  return {{{0, 0, 0}, {1, 0, 0}, {0, 1, 0}, {0, 0, 1}},
          {},
          {{0, 2, 1}, {0, 1, 3}, {0, 3, 2}, {1, 2, 3}}};
}

// A value as it lies in memory (little-endian).
template <typename T>
void AppendRaw(const T& value, std::string* bytes) {
  bytes->append(reinterpret_cast<const char*>(&value), sizeof(value));
}

inline void AppendFloats(const Eigen::Vector3d& v, std::string* bytes) {
  for (int i = 0; i < 3; ++i) AppendRaw(static_cast<float>(v[i]), bytes);
}

inline std::string ObjBytes(const MeshSpec& mesh) {
  std::ostringstream obj;
  obj.precision(17);
  for (const Eigen::Vector3d& v : mesh.vertices) {
    obj << "v " << v.x() << ' ' << v.y() << ' ' << v.z() << '\n';
  }
  for (const Eigen::Vector3d& n : mesh.normals) {
    obj << "vn " << n.x() << ' ' << n.y() << ' ' << n.z() << '\n';
  }
  for (const auto& triangle : mesh.triangles) {
    obj << 'f';
    for (const int i : triangle) {
      obj << ' ' << i + 1;
      if (!mesh.normals.empty()) obj << "//" << i + 1;
    }
    obj << '\n';
  }
  return obj.str();
}

inline std::string PlyBytes(const MeshSpec& mesh) {
  std::string header = "ply\nformat binary_little_endian 1.0\nelement vertex ";
  header += std::to_string(mesh.vertices.size()) + "\n";
  const std::vector<std::string> names = {"x", "y", "z", "nx", "ny", "nz"};
  for (size_t i = 0; i < (mesh.normals.empty() ? 3u : 6u); ++i) {
    header += "property float " + names[i] + "\n";
  }
  std::string bytes = header + "element face " +
                      std::to_string(mesh.triangles.size()) +
                      "\nproperty list uchar int vertex_indices\nend_header\n";
  for (size_t v = 0; v < mesh.vertices.size(); ++v) {
    AppendFloats(mesh.vertices[v], &bytes);
    if (!mesh.normals.empty()) AppendFloats(mesh.normals[v], &bytes);
  }
  for (const auto& triangle : mesh.triangles) {
    bytes += '\3';
    for (const int32_t i : triangle) AppendRaw(i, &bytes);
  }
  return bytes;
}

// Without normals, as many programs write STL.
inline std::string StlBytes(const MeshSpec& mesh) {
  std::string bytes = "solid in name alone";
  bytes.resize(80);
  AppendRaw(static_cast<uint32_t>(mesh.triangles.size()), &bytes);
  for (const auto& triangle : mesh.triangles) {
    AppendFloats(Eigen::Vector3d::Zero(), &bytes);
    for (const int i : triangle) AppendFloats(mesh.vertices[i], &bytes);
    bytes += std::string(2, '\0');
  }
  return bytes;
}

inline std::string StlText(const MeshSpec& mesh) {
  std::ostringstream stl;
  stl.precision(17);
  stl << "solid a name\n";
  for (const auto& triangle : mesh.triangles) {
    stl << "  facet normal 0 0 0\n    outer loop\n";
    for (const int i : triangle) {
      const Eigen::Vector3d& v = mesh.vertices[i];
      stl << "      vertex " << v.x() << ' ' << v.y() << ' ' << v.z() << '\n';
    }
    stl << "    endloop\n  endfacet\n";
  }
  stl << "endsolid a name\n";
  return stl.str();
}

// The chunks of a GLB; `buffer` may be empty.
inline std::string GlbOf(std::string json, std::string buffer) {
  while (json.size() % 4 != 0) json += ' ';
  while (buffer.size() % 4 != 0) buffer += '\0';
  std::string chunks;
  AppendRaw(static_cast<uint32_t>(json.size()), &chunks);
  chunks += "JSON" + json;
  if (!buffer.empty()) {
    AppendRaw(static_cast<uint32_t>(buffer.size()), &chunks);
    chunks += std::string("BIN\0", 4) + buffer;
  }
  std::string bytes = "glTF";
  AppendRaw(uint32_t{2}, &bytes);
  AppendRaw(static_cast<uint32_t>(12 + chunks.size()), &bytes);
  return bytes + chunks;
}

// The JSON of a GLB with one mesh, and its buffer: positions, normals if any,
// then indices, all tight.
inline nlohmann::json GltfJsonOf(const MeshSpec& mesh, std::string* buffer) {
  using Json = nlohmann::json;
  Json views = Json::array(), accessors = Json::array();
  const auto add = [&](size_t begin, int type, size_t count, const char* of) {
    accessors.push_back({{"bufferView", views.size()},
                         {"componentType", type},
                         {"count", count},
                         {"type", of}});
    views.push_back({{"buffer", 0},
                     {"byteOffset", begin},
                     {"byteLength", buffer->size() - begin}});
    return accessors.size() - 1;
  };
  Json attributes;
  size_t begin = buffer->size();
  for (const Eigen::Vector3d& v : mesh.vertices) AppendFloats(v, buffer);
  attributes["POSITION"] = add(begin, 5126, mesh.vertices.size(), "VEC3");
  if (!mesh.normals.empty()) {
    begin = buffer->size();
    for (const Eigen::Vector3d& n : mesh.normals) AppendFloats(n, buffer);
    attributes["NORMAL"] = add(begin, 5126, mesh.normals.size(), "VEC3");
  }
  begin = buffer->size();
  for (const auto& triangle : mesh.triangles) {
    for (const int i : triangle) AppendRaw(static_cast<uint32_t>(i), buffer);
  }
  const size_t indices = add(begin, 5125, 3 * mesh.triangles.size(), "SCALAR");
  Json json;
  json["asset"]["version"] = "2.0";
  json["buffers"] = Json::array({{{"byteLength", buffer->size()}}});
  json["bufferViews"] = views;
  json["accessors"] = accessors;
  json["meshes"] = Json::array({{{"primitives", Json::array()}}});
  json["meshes"][0]["primitives"].push_back(
      {{"attributes", attributes}, {"indices", indices}});
  json["nodes"] = Json::array({{{"mesh", 0}}});
  json["scenes"] = Json::array({{{"nodes", {0}}}});
  return json;
}

inline std::string GlbBytes(const MeshSpec& mesh) {
  std::string buffer;
  const nlohmann::json json = GltfJsonOf(mesh, &buffer);
  return GlbOf(json.dump(), buffer);
}

}  // namespace ibrdf
