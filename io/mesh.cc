#include "io/mesh.h"

#include <assimp/config.h>
#include <assimp/postprocess.h>
#include <assimp/scene.h>

#include <array>
#include <assimp/Importer.hpp>
#include <cmath>
#include <cstdint>
#include <cstring>
#include <exception>
#include <unordered_map>

#include "io/atomic_file.h"
#include "io/file_extension.h"
#include "io/mesh_clean.h"

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

Eigen::Vector3f ToEigen(const aiVector3D& v) { return {v.x, v.y, v.z}; }

// Calls visit(mesh, face) for every triangle of the scene; the transformations
// of the scene's nodes are the identity in both formats.
template <typename Visit>
Status ForEachTriangle(const std::string& path, const aiScene& scene,
                       const Visit& visit) {
  for (unsigned m = 0; m < scene.mNumMeshes; ++m) {
    const aiMesh& mesh = *scene.mMeshes[m];
    for (unsigned f = 0; f < mesh.mNumFaces; ++f) {
      const aiFace& face = mesh.mFaces[f];
      if (face.mNumIndices != 3) continue;
      for (unsigned i = 0; i < 3; ++i) {
        if (face.mIndices[i] >= mesh.mNumVertices) {
          return InvalidInput(path + ": face " + std::to_string(f),
                              "expected indices of existing vertices");
        }
      }
      visit(mesh, face);
    }
  }
  return OkStatus();
}

StatusOr<TriangleMesh> Convert(const std::string& path, const aiScene& scene) {
  size_t triangles = 0;
  bool finite = true, normals = true;
  IBRDF_RETURN_IF_ERROR(
      ForEachTriangle(path, scene, [&](const aiMesh& mesh, const aiFace& face) {
        ++triangles;
        for (unsigned i = 0; i < 3; ++i) {
          const unsigned v = face.mIndices[i];
          finite = finite && ToEigen(mesh.mVertices[v]).allFinite();
          if (!mesh.HasNormals()) {
            normals = false;
          } else {
            const double length =
                ToEigen(mesh.mNormals[v]).cast<double>().norm();
            normals = normals && std::isfinite(length) && length > 0.0;
          }
        }
      }));
  if (triangles == 0) {
    return InvalidInput(path + ": faces", "expected at least one face");
  }
  if (!finite) {
    return InvalidInput(path + ": vertices", "expected finite coordinates");
  }

  TriangleMesh result;
  result.triangles.reserve(triangles);
  std::unordered_map<VertexKey, int, VertexKeyHash> index_of;
  IBRDF_RETURN_IF_ERROR(
      ForEachTriangle(path, scene, [&](const aiMesh& mesh, const aiFace& face) {
        std::array<int, 3> triangle;
        for (unsigned i = 0; i < 3; ++i) {
          const unsigned v = face.mIndices[i];
          const Eigen::Vector3f position = ToEigen(mesh.mVertices[v]);
          const Eigen::Vector3f normal =
              normals ? Eigen::Vector3f(ToEigen(mesh.mNormals[v])
                                            .cast<double>()
                                            .normalized()
                                            .cast<float>())
                      : Eigen::Vector3f::Zero();
          const auto [it, added] = index_of.emplace(
              MakeKey(position), static_cast<int>(result.vertices.size()));
          if (added) {
            result.vertices.push_back(position);
            result.normals.push_back(normal);
          } else if (result.normals[it->second].dot(normal) <
                     kMinSameNormalCosine) {
            normals = false;
          }
          triangle[i] = it->second;
        }
        result.triangles.push_back(triangle);
      }));
  if (!normals) ComputeVertexNormals(&result);
  return result;
}

}  // namespace

StatusOr<TriangleMesh> ReadMesh(const std::string& path) {
  const std::string extension = FileExtension(path);
  if (extension != "obj" && extension != "ply") {
    return InvalidInput(path + ": extension", "expected .obj or .ply");
  }
  StatusOr<std::string> bytes = ReadFile(path, kMaxMeshFileBytes);
  if (!bytes.ok()) return bytes.status();
  bytes = extension == "obj" ? CleanObj(path, *bytes) : CleanPly(path, *bytes);
  if (!bytes.ok()) return bytes.status();
  try {
    Assimp::Importer importer;
    // What is imported is the OBJ text made of what was checked.
    const aiScene* scene = importer.ReadFileFromMemory(
        bytes->data(), bytes->size(), aiProcess_Triangulate, "obj");
    if (scene == nullptr) {
      return InvalidInput(path, "expected a " + extension + " mesh (" +
                                    importer.GetErrorString() + ")");
    }
    return Convert(path, *scene);
  } catch (const std::exception& e) {
    return InvalidInput(path,
                        "expected a " + extension + " mesh (" + e.what() + ")");
  }
}

}  // namespace ibrdf
