#include <Eigen/Core>
#include <Eigen/Geometry>
#include <cstdint>
#include <optional>
#include <string>
#include <utility>
#include <vector>

#include "ibrdf/io/gltf_document.h"
#include "ibrdf/io/polygon_mesh.h"

namespace ibrdf {
namespace {
using GltfJson = nlohmann::json;

// One mesh may be placed often: what a small file makes of it is limited.
constexpr size_t kMaxGlbVertices = size_t{1} << 24;
constexpr size_t kMaxGlbCorners = size_t{3} << 24;

// Reads `size` numbers of a list; false where the key holds something else.
bool GltfVector(const GltfJson& object, const char* key, int size,
                double* out) {
  const auto at = object.find(key);
  if (!at->is_array() || at->size() != static_cast<size_t>(size)) return false;
  for (int i = 0; i < size; ++i) {
    const GltfJson& number = (*at)[static_cast<size_t>(i)];
    if (!number.is_number()) return false;
    out[i] = number.get<double>();
  }
  return true;
}

// A node's transform: a matrix, or translation, rotation and scale.
bool NodeTransform(const GltfJson& node, Eigen::Matrix4d* parent_from_node) {
  if (node.contains("matrix")) {
    return GltfVector(node, "matrix", 16, parent_from_node->data());
  }
  Eigen::Vector3d translation(0, 0, 0), scale(1, 1, 1);
  Eigen::Quaterniond rotation(1, 0, 0, 0);
  if ((node.contains("translation") &&
       !GltfVector(node, "translation", 3, translation.data())) ||
      (node.contains("scale") && !GltfVector(node, "scale", 3, scale.data())) ||
      (node.contains("rotation") &&
       !GltfVector(node, "rotation", 4, rotation.coeffs().data()))) {
    return false;
  }
  parent_from_node->setIdentity();
  parent_from_node->topLeftCorner<3, 3>() =
      rotation.normalized().toRotationMatrix() * scale.asDiagonal();
  parent_from_node->topRightCorner<3, 1>() = translation;
  return true;
}

// The determinant times the inverse, transposed: what normals go through, also
// where there is no inverse.
Eigen::Matrix3d Cofactors(const Eigen::Matrix3d& m) {
  Eigen::Matrix3d out;
  for (int i = 0; i < 3; ++i) {
    out.col(i) = m.col((i + 1) % 3).cross(m.col((i + 2) % 3));
  }
  return out;
}

bool HasMorph(const GltfJson& object) {
  const auto weights = object.find("weights");
  if (weights == object.end() || !weights->is_array()) return false;
  for (const GltfJson& weight : *weights) {
    if (weight != 0) return true;
  }
  return false;
}

// A primitive of a mesh.
struct Part {
  std::string where;  // in the file
  size_t mode = 4;    // 4: triangles, 5: a strip, 6: a fan
  GltfNumbers positions;
  std::optional<GltfNumbers> normals, texture;
  std::optional<GltfNumbers> indices;  // below positions.count()
  size_t corners = 0;
};

// Places the meshes of a scene's nodes, then adds them one after another.
class GlbScene {
 public:
  explicit GlbScene(const GltfDocument& document)
      : document_(document),
        reached_(document.Size("nodes"), false),
        read_(document.Size("meshes"), false),
        parts_(document.Size("meshes")) {}

  StatusOr<PolygonMesh> Read() {
    IBRDF_RETURN_IF_ERROR(PushRoots());
    while (!stack_.empty()) {
      const Placed placed = stack_.back();
      stack_.pop_back();
      IBRDF_RETURN_IF_ERROR(VisitNode(placed.index, placed.world_from_local));
    }
    if (document_.Size("nodes") == 0) {
      for (size_t m = 0; m < document_.Size("meshes"); ++m) {
        IBRDF_RETURN_IF_ERROR(Place(m, Eigen::Matrix4d::Identity()));
      }
    }
    IBRDF_RETURN_IF_ERROR(CheckSize());
    for (const Placed& placed : placed_) {
      for (const Part& part : parts_[placed.index]) {
        IBRDF_RETURN_IF_ERROR(AddPart(part, placed.world_from_local));
      }
    }
    if (mesh_.sizes.empty()) {
      return document_.Fail("faces", "expected at least one face");
    }
    if (all_have_normals_) mesh_.corner_normals = mesh_.corners;
    UseVertexTexture(&mesh_);
    return std::move(mesh_);
  }

 private:
  // A node or a mesh, and where it is.
  struct Placed {
    size_t index;
    Eigen::Matrix4d world_from_local;
  };

  // Pushes the nodes that a key lists, the first on top.
  Status PushNodes(const std::string& where, const GltfJson& holder,
                   const char* key, const Eigen::Matrix4d& world_from_holder) {
    const auto list = holder.find(key);
    if (list == holder.end()) return OkStatus();
    if (!list->is_array()) return document_.Fail(where, "expected a list");
    for (size_t i = list->size(); i-- > 0;) {
      size_t node = 0;
      if (!GltfWhole((*list)[i], document_.Size("nodes"), &node)) {
        return document_.Fail(
            where, "expected indices of the file's " +
                       std::to_string(document_.Size("nodes")) + " nodes");
      }
      if (reached_[node]) {
        return document_.Fail("nodes[" + std::to_string(node) + "]",
                              "expected a tree of nodes, found one in it "
                              "twice");
      }
      reached_[node] = true;
      stack_.push_back({node, world_from_holder});
    }
    return OkStatus();
  }

  Status PushRoots() {
    const Eigen::Matrix4d identity = Eigen::Matrix4d::Identity();
    if (document_.Size("scenes") > 0) {
      size_t scene = 0;
      if (document_.json().contains("scene") &&
          !GltfIndex(document_.json(), "scene", document_.Size("scenes"),
                     &scene)) {
        return document_.Fail("scene", "expected the index of a scene");
      }
      const GltfJson& json = document_.At("scenes", scene);
      const std::string where = "scenes[" + std::to_string(scene) + "]";
      return json.is_object()
                 ? PushNodes(where + ".nodes", json, "nodes", identity)
                 : document_.Fail(where, "expected a map");
    }
    return PushNodes("nodes", {{"nodes", RootsWithoutScene()}}, "nodes",
                     identity);
  }

  // The nodes that are no other's child.
  std::vector<size_t> RootsWithoutScene() const {
    const size_t nodes = document_.Size("nodes");
    std::vector<bool> is_child(nodes, false);
    for (size_t n = 0; n < nodes; ++n) {
      const GltfJson& node = document_.At("nodes", n);
      const auto children = node.find("children");
      if (children == node.end() || !children->is_array()) continue;
      for (const GltfJson& child : *children) {
        size_t c = 0;
        if (GltfWhole(child, nodes, &c)) is_child[c] = true;
      }
    }
    std::vector<size_t> roots;
    for (size_t n = 0; n < nodes; ++n) {
      if (!is_child[n]) roots.push_back(n);
    }
    return roots;
  }

  Status VisitNode(size_t n, const Eigen::Matrix4d& world_from_parent) {
    const std::string where = "nodes[" + std::to_string(n) + "]";
    const GltfJson& node = document_.At("nodes", n);
    Eigen::Matrix4d parent_from_node;
    if (!node.is_object() || !NodeTransform(node, &parent_from_node)) {
      return document_.Fail(where,
                            "expected a matrix of 16 numbers, or a "
                            "translation, rotation and scale of 3, 4 and 3");
    }
    const Eigen::Matrix4d world_from_node =
        world_from_parent * parent_from_node;
    IBRDF_RETURN_IF_ERROR(
        PushNodes(where + ".children", node, "children", world_from_node));
    if (!node.contains("mesh")) return OkStatus();
    const auto extensions = node.find("extensions");
    if (extensions != node.end() &&
        extensions->contains("EXT_mesh_gpu_instancing")) {
      return document_.Fail(where + ".extensions",
                            "EXT_mesh_gpu_instancing is not read");
    }
    if (node.contains("skin")) {
      return document_.Fail(where + ".skin",
                            "expected a mesh without a skeleton; apply its "
                            "pose before the export");
    }
    size_t mesh = 0;
    if (!GltfIndex(node, "mesh", document_.Size("meshes"), &mesh)) {
      return document_.Fail(where + ".mesh",
                            "expected one of the file's " +
                                std::to_string(document_.Size("meshes")) +
                                " meshes");
    }
    if (HasMorph(node)) return Morphed(where);
    return Place(mesh, world_from_node);
  }

  Status Place(size_t mesh, const Eigen::Matrix4d& world_from_mesh) {
    if (!read_[mesh]) IBRDF_RETURN_IF_ERROR(ReadParts(mesh));
    read_[mesh] = true;
    placed_.push_back({mesh, world_from_mesh});
    return OkStatus();
  }

  Status Morphed(const std::string& where) const {
    return document_.Fail(where + ".weights",
                          "expected a mesh without morphs; apply them before "
                          "the export");
  }

  // Reads what a mesh is made of, once.
  Status ReadParts(size_t m) {
    const std::string where = "meshes[" + std::to_string(m) + "]";
    const GltfJson& mesh = document_.At("meshes", m);
    const auto primitives = mesh.find("primitives");
    if (primitives == mesh.end() || !primitives->is_array()) {
      return document_.Fail(where + ".primitives", "expected a list");
    }
    if (HasMorph(mesh)) return Morphed(where);
    for (size_t p = 0; p < primitives->size(); ++p) {
      IBRDF_RETURN_IF_ERROR(
          ReadPart(where + ".primitives[" + std::to_string(p) + "]",
                   (*primitives)[p], &parts_[m]));
    }
    return OkStatus();
  }

  Status ReadPart(const std::string& where, const GltfJson& primitive,
                  std::vector<Part>* parts) {
    Part part;
    part.where = where;
    if (!primitive.is_object() ||
        (primitive.contains("mode") &&
         !GltfIndex(primitive, "mode", 7, &part.mode))) {
      return document_.Fail(where + ".mode", "expected 0 to 6");
    }
    if (part.mode < 4) return OkStatus();  // points and lines
    const StatusOr<GltfNumbers> positions =
        Attribute(where, primitive, "POSITION");
    if (!positions.ok()) return positions.status();
    part.positions = *positions;
    part.corners = positions->count();
    if (primitive.find("attributes")->contains("NORMAL")) {
      const StatusOr<GltfNumbers> normals =
          Attribute(where, primitive, "NORMAL");
      if (!normals.ok()) return normals.status();
      if (normals->count() != positions->count()) {
        return document_.Fail(where + ".attributes.NORMAL",
                              "expected " + std::to_string(part.corners) +
                                  ", found " +
                                  std::to_string(normals->count()));
      }
      part.normals = *normals;
    }
    part.texture = Texture(where, primitive, part.corners);
    if (primitive.contains("indices")) {
      IBRDF_RETURN_IF_ERROR(ReadIndices(primitive, &part));
    }
    if (part.mode == 4 && part.corners % 3 != 0) {
      return document_.Fail(where,
                            "expected three corners per triangle, "
                            "found " +
                                std::to_string(part.corners));
    }
    parts->push_back(part);
    return OkStatus();
  }

  // Rows of three numbers of an attribute, or of so many.
  StatusOr<GltfNumbers> Attribute(const std::string& where,
                                  const GltfJson& primitive, const char* name,
                                  int components = 3) const {
    const auto attributes = primitive.find("attributes");
    size_t accessor = 0;
    if (attributes == primitive.end() ||
        !GltfIndex(*attributes, name, document_.Size("accessors"), &accessor)) {
      return document_.Fail(where + ".attributes." + name,
                            "expected one of the file's " +
                                std::to_string(document_.Size("accessors")) +
                                " accessors");
    }
    StatusOr<GltfNumbers> numbers = document_.Numbers(accessor);
    if (numbers.ok() && numbers->components() != components) {
      return document_.Fail(
          "accessors[" + std::to_string(accessor) + "].type",
          "expected VEC" + std::to_string(components) + " for " + name);
    }
    return numbers;
  }

  // TEXCOORD_0 of `count` vertices, where it is usable.
  std::optional<GltfNumbers> Texture(const std::string& where,
                                     const GltfJson& primitive, size_t count) {
    const char* const name = "TEXCOORD_0";
    if (!primitive.find("attributes")->contains(name)) return std::nullopt;
    const StatusOr<GltfNumbers> numbers = Attribute(where, primitive, name, 2);
    if (numbers.ok() && numbers->count() == count) return *numbers;
    mesh_.texture_fault = "expected " + std::to_string(count) + " pairs of " +
                          name + " at " + where;
    return std::nullopt;
  }

  Status ReadIndices(const GltfJson& primitive, Part* part) const {
    size_t accessor = 0;
    if (!GltfIndex(primitive, "indices", document_.Size("accessors"),
                   &accessor)) {
      return document_.Fail(part->where + ".indices", "expected an accessor");
    }
    const StatusOr<GltfNumbers> numbers = document_.Numbers(accessor);
    if (!numbers.ok()) return numbers.status();
    if (numbers->components() != 1 || !numbers->IsUnsigned()) {
      return document_.Fail("accessors[" + std::to_string(accessor) + "]",
                            "expected indices, unsigned whole numbers");
    }
    for (size_t i = 0; i < numbers->count(); ++i) {
      if (numbers->Index(i) < part->positions.count()) continue;
      return document_.Fail(
          part->where + ".indices",
          "expected indices of its " + std::to_string(part->positions.count()) +
              " vertices, found " + std::to_string(numbers->Index(i)));
    }
    part->indices = *numbers;
    part->corners = numbers->count();
    return OkStatus();
  }

  // Refuses what would take too much, before it does.
  Status CheckSize() const {
    size_t vertices = 0, corners = 0;
    for (const Placed& placed : placed_) {
      for (const Part& part : parts_[placed.index]) {
        vertices += part.positions.count();
        corners += part.corners;
      }
      if (vertices > kMaxGlbVertices || corners > kMaxGlbCorners) {
        return document_.Fail(
            "meshes", "expected at most " + std::to_string(kMaxGlbVertices) +
                          " vertices and " + std::to_string(kMaxGlbCorners) +
                          " indices, counted wherever a node places "
                          "them");
      }
    }
    return OkStatus();
  }

  Status AddPart(const Part& part, const Eigen::Matrix4d& world_from_mesh) {
    const int first = static_cast<int>(mesh_.vertices.size());
    IBRDF_RETURN_IF_ERROR(AddPositions(part, world_from_mesh));
    const Eigen::Matrix3d linear = world_from_mesh.topLeftCorner<3, 3>();
    // glTF 2.0, 3.7.4: a mirrored mesh is wound the other way.
    const bool mirrored = linear.determinant() < 0.0;
    all_have_normals_ = all_have_normals_ && part.normals.has_value();
    if (all_have_normals_) {
      AddNormals(*part.normals, mirrored ? Eigen::Matrix3d(-Cofactors(linear))
                                         : Cofactors(linear));
    }
    if (part.texture.has_value()) AddTexture(*part.texture);
    return AddTriangles(part, first, mirrored);
  }

  // Its second coordinate runs down.
  void AddTexture(const GltfNumbers& texture) {
    for (size_t i = 0; i < texture.count(); ++i) {
      const double uv[2] = {texture.At(i, 0), 1.0 - texture.At(i, 1)};
      AppendTexture(uv, &mesh_);
    }
  }

  Status AddPositions(const Part& part,
                      const Eigen::Matrix4d& world_from_mesh) {
    for (size_t i = 0; i < part.positions.count(); ++i) {
      const Eigen::Vector4d p(part.positions.At(i, 0), part.positions.At(i, 1),
                              part.positions.At(i, 2), 1.0);
      const Eigen::Vector3d v = (world_from_mesh * p).head<3>();
      if (!AppendVertex(v.data(), &mesh_)) {
        return document_.Fail(part.where + ": vertex " + std::to_string(i),
                              "expected finite coordinates");
      }
    }
    return OkStatus();
  }

  void AddNormals(const GltfNumbers& normals, const Eigen::Matrix3d& turn) {
    for (size_t i = 0; i < normals.count(); ++i) {
      const Eigen::Vector3d n =
          (turn * Eigen::Vector3d(normals.At(i, 0), normals.At(i, 1),
                                  normals.At(i, 2)))
              .stableNormalized();
      AppendNormal(n.data(), &mesh_);
    }
  }

  Status AddTriangles(const Part& part, int first, bool mirrored) {
    const auto corner = [&](size_t i) {
      return first + static_cast<int>(
                         part.indices.has_value() ? part.indices->Index(i) : i);
    };
    const size_t step = part.mode == 4 ? 3 : 1;
    for (size_t i = 2; i < part.corners; i += step) {
      int a = corner(part.mode == 6 ? 0 : i - 2), b = corner(i - 1);
      if (mirrored != (part.mode == 5 && i % 2 == 1)) std::swap(a, b);
      if (!AppendTriangle(a, b, corner(i), &mesh_)) {
        return document_.Fail("meshes", "expected at most " +
                                            std::to_string(kMaxStripTriangles) +
                                            " triangles in all");
      }
    }
    return OkStatus();
  }

  const GltfDocument& document_;
  PolygonMesh mesh_;
  std::vector<Placed> stack_, placed_;    // nodes to visit; meshes
  std::vector<bool> reached_, read_;      // nodes; meshes
  std::vector<std::vector<Part>> parts_;  // of each mesh
  bool all_have_normals_ = true;
};

}  // namespace

StatusOr<PolygonMesh> ParseGlb(const std::string& path,
                               const std::string& bytes) {
  const StatusOr<GltfDocument> document = GltfDocument::Open(path, bytes);
  if (!document.ok()) return document.status();
  return GlbScene(*document).Read();
}

}  // namespace ibrdf
