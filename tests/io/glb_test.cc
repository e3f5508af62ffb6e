// GLB files: glTF 2.0 in one file.
#include <gtest/gtest.h>

#include <Eigen/Geometry>
#include <cmath>
#include <functional>
#include <string>
#include <vector>

#include "ibrdf/io/mesh.h"
#include "tests/support/corruption.h"
#include "tests/support/mesh_files.h"
#include "tests/support/signed_volume.h"

namespace ibrdf {
namespace {
using Json = nlohmann::json;

// The tetrahedron's file, changed.
std::string Changed(const std::function<void(Json*)>& change,
                    const MeshSpec& spec = Tetrahedron()) {
  std::string buffer;
  Json json = GltfJsonOf(spec, &buffer);
  change(&json);
  return GlbOf(json.dump(), buffer);
}

TriangleMesh Decoded(const std::string& bytes) {
  const StatusOr<TriangleMesh> mesh = DecodeMesh("a.glb", bytes);
  EXPECT_TRUE(mesh.ok()) << mesh.status().message();
  return mesh.ok() ? *mesh : TriangleMesh();
}

void ExpectGlbRefused(const std::string& bytes, const std::string& says) {
  const Status status = DecodeMesh("a.glb", bytes).status();
  EXPECT_EQ(StatusCode::kInvalidInput, status.code()) << says;
  EXPECT_EQ(0u, status.message().find("a.glb: ")) << status.message();
  EXPECT_NE(std::string::npos, status.message().find(says)) << status.message();
}

TEST(Glb, IsTheMeshThatItHolds) {
  const TriangleMesh mesh = Decoded(GlbBytes(Tetrahedron()));
  const StatusOr<TriangleMesh> obj =
      DecodeMesh("a.obj", ObjBytes(Tetrahedron()));
  ASSERT_TRUE(obj.ok());
  EXPECT_EQ(obj->vertices, mesh.vertices);
  EXPECT_EQ(obj->triangles, mesh.triangles);
  EXPECT_EQ(obj->normals, mesh.normals);
}

TEST(Glb, NodesPlaceMeshes) {
  // A parent turns by 90 degrees about z and moves; its child doubles.
  const double half = std::sqrt(0.5);
  const TriangleMesh mesh = Decoded(Changed([&](Json* json) {
    (*json)["nodes"] = Json::array(
        {{{"rotation", {0, 0, half, half}},
          {"translation", {10, 0, 0}},
          {"children", {1, 2}}},
         {{"mesh", 0}, {"scale", {2, 2, 2}}},
         {{"mesh", 0},
          {"matrix", {1, 0, 0, 0, 0, 1, 0, 0, 0, 0, 1, 0, 0, 0, 5, 1}}}});
  }));
  ASSERT_EQ(8u, mesh.triangles.size());
  EXPECT_NEAR(8.0 / 6 + 1.0 / 6, SignedVolume(mesh), 1e-5);
  // The vertex (1, 0, 0) of the first, the vertex (0, 1, 0) of the second.
  const auto has = [&](const Eigen::Vector3f& p) {
    for (const Eigen::Vector3f& v : mesh.vertices) {
      if ((v - p).norm() < 1e-5f) return true;
    }
    return false;
  };
  EXPECT_TRUE(has({10, 2, 0}));
  EXPECT_TRUE(has({9, 0, 5}));
}

TEST(Glb, MirroredMeshesStayRightSideOut) {
  MeshSpec spec = Tetrahedron();
  for (const Eigen::Vector3d& v : spec.vertices) {
    spec.normals.push_back((v - Eigen::Vector3d::Constant(0.25)).normalized());
  }
  for (const bool with_normals : {false, true}) {
    if (!with_normals) spec.normals.clear();
    const TriangleMesh mesh = Decoded(Changed(
        [](Json* json) {
          (*json)["nodes"][0]["scale"] = {-1, 1, 3};
        },
        spec));
    EXPECT_NEAR(0.5, SignedVolume(mesh), 1e-6);
    const Eigen::Vector3f centre(-0.25f, 0.25f, 0.75f);
    for (size_t v = 0; v < mesh.vertices.size(); ++v) {
      EXPECT_GT(mesh.normals[v].dot(mesh.vertices[v] - centre), 0.0f);
    }
  }
}

TEST(Glb, NormalsGoThroughTheInverse) {
  const MeshSpec spec = {{{0, 0, 0}, {1, 0, 1}, {0, 1, 0}},
                         std::vector<Eigen::Vector3d>(3, {-1, 0, 1}),
                         {{0, 1, 2}}};
  const TriangleMesh mesh = Decoded(Changed(
      [](Json* json) {
        (*json)["nodes"][0]["scale"] = {4, 1, 1};
      },
      spec));
  const Eigen::Vector3f expected = Eigen::Vector3f(-0.25f, 0, 1).normalized();
  for (const Eigen::Vector3f& n : mesh.normals) {
    EXPECT_LT((n - expected).norm(), 1e-6f);
  }
}

TEST(Glb, StripsFansAndIndicesOfAllSizes) {
  // A square of two triangles, as a strip, a fan and a list.
  const std::vector<Eigen::Vector3d> strip = {
      {0, 0, 0}, {1, 0, 0}, {0, 1, 0}, {1, 1, 0}};
  const std::vector<Eigen::Vector3d> fan = {
      {0, 0, 0}, {1, 0, 0}, {1, 1, 0}, {0, 1, 0}};
  for (const int mode : {4, 5, 6}) {
    const MeshSpec spec = {mode == 6 ? fan : strip, {}, {{0, 1, 2}, {2, 1, 3}}};
    const TriangleMesh mesh = Decoded(Changed(
        [&](Json* json) {
          Json& primitive = (*json)["meshes"][0]["primitives"][0];
          primitive["mode"] = mode;
          if (mode != 4) primitive.erase("indices");
        },
        spec));
    ASSERT_EQ(2u, mesh.triangles.size()) << mode;
    for (const Eigen::Vector3f& n : mesh.normals) {
      EXPECT_NEAR(1.0f, n.z(), 1e-6f) << mode;
    }
  }
  for (const int type : {5121, 5123}) {
    std::string buffer;
    Json json = GltfJsonOf({strip, {}, {}}, &buffer);
    json["bufferViews"][1]["byteLength"] = type == 5121 ? 4 : 8;
    json["accessors"][1]["componentType"] = type;
    json["accessors"][1]["count"] = 4;
    json["meshes"][0]["primitives"][0]["mode"] = 5;
    for (int i = 0; i < 4; ++i) {
      buffer += static_cast<char>(i);
      if (type == 5123) buffer += '\0';
    }
    EXPECT_EQ(2u, Decoded(GlbOf(json.dump(), buffer)).triangles.size());
  }
}

TEST(Glb, QuantisedAndInterleavedAttributes) {
  // Positions as normalised shorts, 8 bytes apart.
  std::string buffer;
  Json json = GltfJsonOf({}, &buffer);
  for (const auto& v : Tetrahedron().vertices) {
    for (int i = 0; i < 3; ++i) {
      AppendRaw(static_cast<int16_t>(-32767 * v[i]), &buffer);
    }
    buffer += std::string(2, '\x55');
  }
  json["extensionsRequired"] = {"KHR_mesh_quantization", "KHR_materials_unlit"};
  json["bufferViews"][0] = {
      {"buffer", 0}, {"byteLength", 30}, {"byteStride", 8}};
  json["accessors"][0] = {{"bufferView", 0},
                          {"componentType", 5122},
                          {"normalized", true},
                          {"count", 4},
                          {"type", "VEC3"}};
  Json& primitive = json["meshes"][0]["primitives"][0];
  primitive["mode"] = 5;
  primitive.erase("indices");
  const TriangleMesh mesh = Decoded(GlbOf(json.dump(), buffer));
  ASSERT_EQ(4u, mesh.vertices.size());
  EXPECT_EQ(Eigen::Vector3f(0, -1, 0), mesh.vertices[2]);
}

// TEXCOORD_0 runs down from the top left.
TEST(Glb, TextureCoordinatesAreTurnedUp) {
  std::string buffer;
  Json json = GltfJsonOf(Tetrahedron(), &buffer);
  while (buffer.size() % 4 != 0) buffer += '\0';
  json["bufferViews"].push_back(
      {{"buffer", 0}, {"byteOffset", buffer.size()}, {"byteLength", 32}});
  for (int i = 0; i < 8; ++i)
    AppendRaw(0.125f * static_cast<float>(i), &buffer);
  json["buffers"][0]["byteLength"] = buffer.size();
  json["accessors"].push_back({{"bufferView", json["bufferViews"].size() - 1},
                               {"componentType", 5126},
                               {"count", 4},
                               {"type", "VEC2"}});
  json["meshes"][0]["primitives"][0]["attributes"]["TEXCOORD_0"] =
      json["accessors"].size() - 1;
  const TriangleMesh mesh = Decoded(GlbOf(json.dump(), buffer));
  ASSERT_EQ(4u, mesh.texture.size());
  // The first triangle is 0, 2, 1.
  EXPECT_EQ(Eigen::Vector2f(0.5f, 1.0f - 0.625f), mesh.texture[0][1]);
  // What is wrong with it leaves the mesh.
  json["accessors"].back()["count"] = 3;
  MeshNotes notes;
  const StatusOr<TriangleMesh> bare =
      DecodeMesh("a.glb", GlbOf(json.dump(), buffer), &notes);
  ASSERT_TRUE(bare.ok()) << bare.status().message();
  EXPECT_TRUE(bare->texture.empty());
  EXPECT_EQ("expected 4 pairs of TEXCOORD_0 at meshes[0].primitives[0]",
            notes.texture_fault);
  EXPECT_EQ(mesh.triangles, bare->triangles);
}

TEST(Glb, TheSceneSaysWhatIsThere) {
  // Two nodes, of which a scene shows one; without a scene, all roots; without
  // nodes, all meshes.
  const auto triangles = [](const std::function<void(Json*)>& change) {
    return Decoded(Changed([&](Json* json) {
             (*json)["nodes"] = Json::array(
                 {{{"mesh", 0}}, {{"mesh", 0}, {"translation", {3, 0, 0}}}});
             (*json)["scenes"] = Json::array(
                 {{{"nodes", {0, 1}}}, {{"nodes", {1}}}, Json::object()});
             change(json);
           }))
        .triangles.size();
  };
  EXPECT_EQ(8u, triangles([](Json*) {}));
  EXPECT_EQ(4u, triangles([](Json* json) { (*json)["scene"] = 1; }));
  EXPECT_EQ(8u, triangles([](Json* json) { json->erase("scenes"); }));
  EXPECT_EQ(4u, triangles([](Json* json) {
              json->erase("scenes");
              json->erase("nodes");
            }));
  ExpectGlbRefused(Changed([](Json* json) {
                     (*json)["scenes"] = Json::array({Json::object()});
                   }),
                   "at least one face");
  // Lines and points are left out.
  ExpectGlbRefused(Changed([](Json* json) {
                     (*json)["meshes"][0]["primitives"][0]["mode"] = 1;
                   }),
                   "at least one face");
}

TEST(Glb, WhatIsNotReadIsRefusedByName) {
  for (const char* name :
       {"KHR_draco_mesh_compression", "EXT_meshopt_compression"}) {
    ExpectGlbRefused(
        Changed([&](Json* json) { (*json)["extensionsRequired"] = {name}; }),
        name);
  }
  ExpectGlbRefused(
      Changed([](Json* json) {
        (*json)["nodes"][0]["extensions"]["EXT_mesh_gpu_instancing"] =
            Json::object();
      }),
      "EXT_mesh_gpu_instancing");
  ExpectGlbRefused(Changed([](Json* json) { (*json)["nodes"][0]["skin"] = 0; }),
                   "nodes[0].skin: expected a mesh without a skeleton");
  ExpectGlbRefused(Changed([](Json* json) {
                     (*json)["meshes"][0]["weights"] = {0, 0.5};
                   }),
                   "meshes[0].weights: expected a mesh without morphs");
  Decoded(Changed([](Json* json) {
    (*json)["meshes"][0]["weights"] = {0, 0};
  }));
  ExpectGlbRefused(
      Changed([](Json* json) { (*json)["buffers"][0]["uri"] = "mesh.bin"; }),
      "buffers[0]: expected the buffer inside of the .glb");
  ExpectGlbRefused(Changed([](Json* json) {
                     (*json)["accessors"][0]["sparse"] = Json::object();
                   }),
                   "accessors[0].sparse");
  EXPECT_EQ(
      "a.gltf: extension: expected .glb, glTF in one file with its buffer",
      DecodeMesh("a.gltf", "{}").status().message());
}

TEST(Glb, BadContainersAreRefused) {
  const std::string bytes = GlbBytes(Tetrahedron());
  ExpectGlbRefused("", "expected \"glTF\"");
  ExpectGlbRefused("{\"asset\": 2}     ", "expected \"glTF\"");
  std::string damaged = bytes;
  damaged[4] = 1;
  ExpectGlbRefused(damaged, "expected version 2, found 1");
  ExpectGlbRefused(bytes.substr(0, bytes.size() - 4), "expected a length");
  damaged = bytes;
  damaged.replace(12, 4, std::string("\xff\xff\xff\x7f", 4));
  ExpectGlbRefused(damaged, "expected a first chunk JSON");
  ExpectGlbRefused(GlbOf("[]", ""), "JSON: expected a valid object");
  ExpectGlbRefused(GlbOf("{\"meshes\": [1e999]}", ""), "JSON");
  ExpectGlbRefused(GlbOf("{", ""), "JSON");
  ExpectGlbRefused(GlbOf(std::string(100000, '['), ""), "JSON");
  const std::string deep(100, '['), ends(100, ']');
  ExpectGlbRefused(GlbOf("{\"extras\": " + deep + ends + "}", ""),
                   "at most 64 levels");
  // A buffer's chunk that ends behind the file.
  std::string buffer;
  const std::string json = GltfJsonOf(Tetrahedron(), &buffer).dump();
  damaged = GlbOf(json, buffer);
  damaged[damaged.size() - buffer.size() - 8] += 4;
  ExpectGlbRefused(damaged, "expected chunks that end inside");
}

TEST(Glb, BadReferencesAndCountsAreRefused) {
  const auto refused = [](const char* pointer, const Json& value,
                          const std::string& says) {
    SCOPED_TRACE(std::string(pointer) + " = " + value.dump());
    ExpectGlbRefused(Changed([&](Json* json) {
                       (*json)[Json::json_pointer(pointer)] = value;
                     }),
                     says);
  };
  refused("/scene", 1, "scene: ");
  refused("/scenes/0", 7, "scenes[0]: expected a map");
  refused("/scenes/0/nodes", {1}, "scenes[0].nodes: ");
  refused("/scenes/0/nodes", "all", "scenes[0].nodes: ");
  refused("/scenes/0/nodes", {0, 0}, "nodes[0]: expected a tree");
  refused("/nodes/0/children", {0}, "nodes[0]: expected a tree");
  refused("/nodes/0", 1, "nodes[0]: ");
  refused("/nodes/0/mesh", 1, "nodes[0].mesh: ");
  refused("/nodes/0/mesh", -1, "nodes[0].mesh: ");
  refused("/nodes/0/mesh", 0.5, "nodes[0].mesh: ");
  refused("/nodes/0/scale", {1, 1}, "nodes[0]: expected a matrix");
  refused("/nodes/0/matrix", {1, 1}, "nodes[0]: expected a matrix");
  refused("/nodes/0/rotation", {0, "x", 0, 1}, "nodes[0]: expected a matrix");
  refused("/nodes/0/scale", {1e300, 1, 1}, "vertex 1: expected finite");
  refused("/meshes/0/primitives", 3, "meshes[0].primitives: ");
  const std::string primitive = "/meshes/0/primitives/0";
  refused(primitive.c_str(), "x", "primitives[0].mode");
  refused((primitive + "/mode").c_str(), 7, "primitives[0].mode");
  refused((primitive + "/indices").c_str(), 9, "primitives[0].indices");
  refused((primitive + "/indices").c_str(), 0, "expected indices");
  refused((primitive + "/attributes").c_str(), 1, "attributes.POSITION");
  refused((primitive + "/attributes/POSITION").c_str(), 9,
          "attributes.POSITION");
  refused((primitive + "/attributes/POSITION").c_str(), 1, "expected VEC3");
  refused((primitive + "/attributes/NORMAL").c_str(), "x", "attributes.NORMAL");
  refused("/accessors/0", 1, "accessors[0]");
  refused("/accessors/0/count", 5,
          "accessors[0].count: expected at most the 4");
  refused("/accessors/0/count", 1e18, "accessors[0].count");
  refused("/accessors/0/count", 3, "expected indices of its 3 vertices");
  refused("/accessors/0/byteOffset", 49, "accessors[0].byteOffset");
  refused("/accessors/0/byteOffset", 4, "accessors[0].count");
  refused("/accessors/0/componentType", 5130, "componentType");
  refused("/accessors/0/type", "MAT4", "accessors[0]");
  refused("/accessors/0/bufferView", 2, "accessors[0].bufferView");
  refused("/accessors/1/count", 11, "expected three corners per triangle");
  refused("/accessors/1/componentType", 5126, "expected indices");
  refused("/bufferViews/0/buffer", 1, "bufferViews[0].buffer");
  refused("/bufferViews/0/byteOffset", 97, "bufferViews[0]: ");
  refused("/bufferViews/0/byteLength", 97, "bufferViews[0]: ");
  refused("/bufferViews/0/byteStride", 4, "accessors[0].count");
  refused("/bufferViews/0/byteStride", 253, "byteStride");
  refused("/extensionsRequired", 1, "extensionsRequired");
}

TEST(Glb, CoordinatesThatAreNotFinite) {
  std::string bytes = GlbBytes(Tetrahedron());
  std::string buffer;
  GltfJsonOf(Tetrahedron(), &buffer);
  bytes.replace(bytes.size() - buffer.size(), 4,
                std::string("\0\0\xc0\x7f", 4));
  ExpectGlbRefused(bytes, "primitives[0]: vertex 0: expected finite");
}

// One mesh that many nodes place.
TEST(Glb, InstancesAreLimited) {
  std::string buffer;
  MeshSpec spec;
  spec.vertices.assign(4096, Eigen::Vector3d::Zero());
  spec.vertices[1].x() = spec.vertices[2].y() = 1;
  spec.triangles = {{0, 1, 2}};
  ExpectGlbRefused(Changed(
                       [](Json* json) {
                         Json& nodes = (*json)["nodes"];
                         nodes = Json::array();
                         for (int i = 0; i < 4097; ++i) {
                           nodes.push_back({{"mesh", 0}});
                         }
                         json->erase("scenes");
                       },
                       spec),
                   "at most 16777216 vertices");
}

TEST(Glb, DamagedFiles) {
  const auto check = [](const std::string& bytes) {
    const StatusOr<TriangleMesh> mesh = DecodeMesh("a.glb", bytes);
    if (!mesh.ok()) {
      EXPECT_EQ(StatusCode::kInvalidInput, mesh.status().code());
      EXPECT_EQ(0u, mesh.status().message().find("a.glb: "));
      return;
    }
    for (const auto& triangle : mesh->triangles) {
      for (const int v : triangle) ASSERT_LT(v, mesh->vertices.size());
    }
  };
  const std::string bytes = GlbBytes(Tetrahedron());
  ForEachTruncation(bytes, 200, check);
  ForEachCorruption(bytes, bytes.size(), 20000, 7, check);
}

}  // namespace
}  // namespace ibrdf
