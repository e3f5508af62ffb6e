#include "ibrdf/io/mesh.h"

#include <gtest/gtest.h>

#include <Eigen/Geometry>
#include <algorithm>
#include <cmath>
#include <cstring>
#include <map>
#include <set>
#include <string>
#include <vector>

#include "ibrdf/base/format.h"
#include "tests/support/corruption.h"
#include "tests/support/shared_data.h"
#include "tests/support/signed_volume.h"
#include "tests/support/temp_dir.h"

namespace ibrdf {
namespace {

// Rounding of a float unit vector.
constexpr float kUnitTolerance = 1e-6f;

// A cube of quads in two groups, with texture coordinates that split vertices,
// a vertex that no face uses, and a line.
const char kCubeObj[] =
    "mtllib none.mtl\no cube\n"
    "v -1 -1 -1\nv 1 -1 -1\nv 1 1 -1\nv -1 1 -1\n"
    "v -1 -1 1\nv 1 -1 1\nv 1 1 1\nv -1 1 1\nv 9 9 9\n"
    "vt 0 0\nvt 1 0\nvt 1 1\nvt 0 1\n"
    "g first\nusemtl a\n"
    "f 1/1 4/2 3/3 2/4\nf 5/2 6/1 7/3 8/4\nf 1/1 2/2 6/3 5/4\n"
    "g second\nusemtl b\n"
    "f 4/4 8/3 7/2 3/1\nf 1/3 5/2 8/1 4/4\nf 2/1 3/2 7/3 6/4\nl 1 2\n";

const char kTetrahedronPly[] =
    "ply\nformat ascii 1.0\nelement vertex 4\nproperty float x\n"
    "property float y\nproperty float z\nelement face 4\n"
    "property list uchar int vertex_indices\nend_header\n"
    "0 0 0\n1 0 0\n0 1 0\n0 0 1\n"
    "3 0 2 1\n3 0 1 3\n3 0 3 2\n3 1 2 3\n";

void ExpectValid(const TriangleMesh& mesh) {
  ASSERT_EQ(mesh.vertices.size(), mesh.normals.size());
  EXPECT_FALSE(mesh.triangles.empty());
  for (const auto& triangle : mesh.triangles) {
    for (const int v : triangle) {
      ASSERT_GE(v, 0);
      ASSERT_LT(static_cast<size_t>(v), mesh.vertices.size());
    }
  }
  for (const Eigen::Vector3f& v : mesh.vertices) ASSERT_TRUE(v.allFinite());
  for (const Eigen::Vector3f& n : mesh.normals) {
    ASSERT_NEAR(1.0f, n.norm(), kUnitTolerance);
  }
}

// Every edge has one triangle on each side, in opposite directions.
bool IsClosed(const TriangleMesh& mesh) {
  std::multiset<std::pair<int, int>> edges;
  for (const auto& t : mesh.triangles) {
    for (size_t i = 0; i < 3; ++i) edges.insert({t[i], t[(i + 1) % 3]});
  }
  for (const auto& [a, b] : edges) {
    if (edges.count({b, a}) != edges.count({a, b})) return false;
  }
  return true;
}

TEST(Mesh, ObjCubeIsJoinedAcrossGroupsAndSeams) {
  const TempDir dir;
  const std::string path = dir.File("cube.OBJ");
  WriteBytes(path, kCubeObj);
  const StatusOr<TriangleMesh> mesh = ReadMesh(path);
  ASSERT_TRUE(mesh.ok()) << mesh.status().message();
  ExpectValid(*mesh);
  EXPECT_EQ(8u, mesh->vertices.size());
  EXPECT_EQ(12u, mesh->triangles.size());
  EXPECT_TRUE(IsClosed(*mesh));
  EXPECT_NEAR(8.0, SignedVolume(*mesh), 1e-12);
  // Three right angles at every corner, however the quads are cut.
  for (size_t v = 0; v < 8; ++v) {
    EXPECT_NEAR(0.0f,
                (mesh->normals[v] - mesh->vertices[v].normalized()).norm(),
                kUnitTolerance);
  }
}

// Area of the parts and of the whole, in the plane of the polygon: equal only
// where no part is turned over.
void ExpectCut(const std::vector<Eigen::Vector3d>& polygon) {
  const TempDir dir;
  std::string obj, face = "f";
  Eigen::Vector3d whole = Eigen::Vector3d::Zero();
  for (size_t i = 0; i < polygon.size(); ++i) {
    const Eigen::Vector3d& p = polygon[i];
    obj += "v " + std::to_string(p.x()) + " " + std::to_string(p.y()) + " " +
           std::to_string(p.z()) + "\n";
    face += " " + std::to_string(i + 1);
    whole += p.cross(polygon[(i + 1) % polygon.size()]);
  }
  WriteBytes(dir.File("a.obj"), obj + face + "\n");
  const StatusOr<TriangleMesh> mesh = ReadMesh(dir.File("a.obj"));
  ASSERT_TRUE(mesh.ok()) << mesh.status().message();
  EXPECT_EQ(polygon.size() - 2, mesh->triangles.size());
  double parts = 0.0;
  for (const auto& t : mesh->triangles) {
    const Eigen::Vector3f& a = mesh->vertices[t[0]];
    parts += (mesh->vertices[t[1]] - a)
                 .cross(mesh->vertices[t[2]] - a)
                 .cast<double>()
                 .norm();
  }
  EXPECT_NEAR(whole.norm(), parts, 1e-5 * whole.norm());
}

TEST(Mesh, PolygonsAreCutWhereTheyAreConcave) {
  ExpectCut({{0, 0, 0}, {1, 0, 0}, {1, 1, 0}, {0, 1, 0}});
  // Arrowheads: the notch at each corner by turns, and seen from both sides.
  for (int start = 0; start < 4; ++start) {
    std::vector<Eigen::Vector3d> arrow = {
        {0, 0, 1}, {2, 1, 0}, {0, 2, 1}, {0.5, 1, 0.75}};
    std::rotate(arrow.begin(), arrow.begin() + start, arrow.end());
    ExpectCut(arrow);
    std::reverse(arrow.begin(), arrow.end());
    ExpectCut(arrow);
  }
  // A star, and a comb, tilted.
  std::vector<Eigen::Vector3d> star, comb;
  for (int i = 0; i < 14; ++i) {
    const double angle = i * std::acos(-1.0) / 7, radius = i % 2 ? 0.3 : 1.0;
    star.emplace_back(radius * std::cos(angle), radius * std::sin(angle),
                      0.5 * radius * std::cos(angle));
  }
  for (int i = 0; i < 9; ++i) comb.emplace_back(i % 2 ? 0.1 : 3.0, i, i);
  comb.emplace_back(0.0, 8.0, 8.0);
  comb.emplace_back(0.0, 0.0, 0.0);
  ExpectCut(star);
  ExpectCut(comb);
}

// A bow tie and a line: as many triangles as of any polygon.
TEST(Mesh, PolygonsThatNothingFillsAreCutAllTheSame) {
  const TempDir dir;
  const std::string path = dir.File("a.obj");
  for (const char* vertices : {"v 0 0 0\nv 1 1 0\nv 1 0 0\nv 0 1 0\n",
                               "v 0 0 0\nv 1 0 0\nv 2 0 0\nv 3 0 0\n",
                               "v 0 0 0\nv 0 0 0\nv 0 0 0\nv 0 0 0\n"}) {
    WriteBytes(path, std::string(vertices) + "f 1 2 3 4\n");
    const StatusOr<TriangleMesh> mesh = ReadMesh(path);
    ASSERT_TRUE(mesh.ok()) << mesh.status().message();
    ExpectValid(*mesh);
    EXPECT_EQ(2u, mesh->triangles.size());
  }
}

TEST(Mesh, PlyAsciiAndBinary) {
  const TempDir dir;
  const std::string path = dir.File("t.ply");
  WriteBytes(path, kTetrahedronPly);
  const StatusOr<TriangleMesh> mesh = ReadMesh(path);
  ASSERT_TRUE(mesh.ok()) << mesh.status().message();
  ExpectValid(*mesh);
  EXPECT_EQ(4u, mesh->vertices.size());
  EXPECT_TRUE(IsClosed(*mesh));
  EXPECT_NEAR(1.0 / 6, SignedVolume(*mesh), 1e-7);

  std::string bytes =
      "ply\nformat binary_little_endian 1.0\nelement vertex 4\n"
      "property float x\nproperty float y\nproperty float z\n"
      "element face 4\nproperty list uchar int vertex_indices\nend_header\n";
  const float coordinates[12] = {0, 0, 0, 1, 0, 0, 0, 1, 0, 0, 0, 1};
  bytes.append(reinterpret_cast<const char*>(coordinates), sizeof(coordinates));
  const int32_t faces[4][3] = {{0, 2, 1}, {0, 1, 3}, {0, 3, 2}, {1, 2, 3}};
  for (const auto& face : faces) {
    bytes.push_back(3);
    bytes.append(reinterpret_cast<const char*>(face), sizeof(face));
  }
  WriteBytes(path, bytes);
  const StatusOr<TriangleMesh> binary = ReadMesh(path);
  ASSERT_TRUE(binary.ok()) << binary.status().message();
  EXPECT_EQ(mesh->triangles, binary->triangles);
  EXPECT_EQ(mesh->vertices, binary->vertices);
}

// Two strips in one list; triangles that a strip repeats a corner in are
// joints.
TEST(Mesh, PlyStrips) {
  const auto ply = [](const std::string& strips) {
    return "ply\nformat ascii 1.0\nelement vertex 6\nproperty float x\n"
           "property float y\nproperty float z\nelement tristrips 1\n"
           "property list int int vertex_indices\nend_header\n"
           "0 0 0\n1 0 0\n0 1 0\n1 1 0\n0 2 0\n1 2 0\n" +
           strips + "\n";
  };
  for (const char* strips :
       {"9 0 1 2 3 -1 2 3 4 5", "6 0 1 2 3 4 5", "10 0 1 2 3 3 2 2 3 4 5"}) {
    const StatusOr<TriangleMesh> mesh = DecodeMesh("a.ply", ply(strips));
    ASSERT_TRUE(mesh.ok()) << mesh.status().message();
    EXPECT_EQ(4u, mesh->triangles.size()) << strips;
    for (const Eigen::Vector3f& n : mesh->normals) {
      EXPECT_NEAR(1.0f, n.z(), kUnitTolerance) << strips;
    }
  }
  for (const char* strips :
       {"3 0 1 6", "3 0 1 -2", "5 0 1 2 3", "2 0 1", "0", "-1", "3 0 1 1.5"}) {
    const Status status = DecodeMesh("a.ply", ply(strips)).status();
    EXPECT_EQ(StatusCode::kInvalidInput, status.code()) << strips;
  }
}

TEST(Mesh, NormalsOfTheFileAreUsedWhenValid) {
  const TempDir dir;
  const std::string path = dir.File("t.obj");
  const std::string head = "v 0 0 0\nv 1 0 0\nv 0 1 0\nv 1 1 0\n";
  const std::string faces = "f 1//1 2//1 3//1\nf 2//2 4//2 3//2\n";
  // One direction, two lengths: used, and made unit.
  WriteBytes(path, head + "vn 0 3 4\nvn 0 0.6 0.8\n" + faces);
  StatusOr<TriangleMesh> mesh = ReadMesh(path);
  ASSERT_TRUE(mesh.ok()) << mesh.status().message();
  ExpectValid(*mesh);
  EXPECT_EQ(4u, mesh->vertices.size());
  for (const Eigen::Vector3f& n : mesh->normals) {
    EXPECT_NEAR(0.0f, (n - Eigen::Vector3f(0, 0.6f, 0.8f)).norm(),
                kUnitTolerance);
  }
  // A normal per face; one without a length; one missing: all are computed.
  for (const std::string& rest :
       {"vn 0 3 4\nvn 1 0 0\n" + faces, "vn 0 0 0\nvn 0 3 4\n" + faces,
        std::string("vn 0 3 4\nf 1//1 2//1 3//1\nf 2//1 4 3//1\n")}) {
    WriteBytes(path, head + rest);
    mesh = ReadMesh(path);
    ASSERT_TRUE(mesh.ok()) << mesh.status().message();
    EXPECT_EQ(4u, mesh->vertices.size());
    for (const Eigen::Vector3f& n : mesh->normals) {
      EXPECT_NEAR(1.0f, n.z(), kUnitTolerance);
    }
  }
}

TEST(Mesh, RelativeIndicesAndContinuedLines) {
  const TempDir dir;
  const std::string path = dir.File("t.obj");
  WriteBytes(path,
             "v 0 0 0\r\nv +1 0 0\r\nv 0 1e0 0 # comment\r\n"
             "f -3 -2 \\\r\n-1\r\nv 0 0 2\nf -4 -1 -3");
  const StatusOr<TriangleMesh> mesh = ReadMesh(path);
  ASSERT_TRUE(mesh.ok()) << mesh.status().message();
  ASSERT_EQ(2u, mesh->triangles.size());
  const auto corner = [&](size_t t, size_t i) {
    return mesh->vertices[mesh->triangles[t][i]];
  };
  EXPECT_EQ(Eigen::Vector3f(0, 0, 0), corner(0, 0));
  EXPECT_EQ(Eigen::Vector3f(1, 0, 0), corner(0, 1));
  EXPECT_EQ(Eigen::Vector3f(0, 1, 0), corner(0, 2));
  EXPECT_EQ(Eigen::Vector3f(0, 0, 2), corner(1, 1));
  EXPECT_EQ(Eigen::Vector3f(1, 0, 0), corner(1, 2));
}

TEST(Mesh, AByteOrderMarkIsNoPartOfTheFirstLine) {
  const TempDir dir;
  WriteBytes(dir.File("a.obj"), kCubeObj);
  WriteBytes(dir.File("b.obj"), "\xef\xbb\xbf" + std::string(kCubeObj));
  const StatusOr<TriangleMesh> a = ReadMesh(dir.File("a.obj"));
  const StatusOr<TriangleMesh> b = ReadMesh(dir.File("b.obj"));
  ASSERT_TRUE(a.ok() && b.ok()) << b.status().message();
  EXPECT_EQ(a->vertices, b->vertices);
  EXPECT_EQ(a->triangles, b->triangles);
  const std::string ply =
      "ply\nformat ascii 1.0\nelement vertex 3\nproperty float x\n"
      "property float y\nproperty float z\nelement face 1\n"
      "property list uchar int vertex_indices\nend_header\n"
      "0 0 0\n1 0 0\n0 1 0\n3 0 1 2\n";
  const StatusOr<TriangleMesh> c = DecodeMesh("c.ply", ply);
  const StatusOr<TriangleMesh> d = DecodeMesh("d.ply", "\xef\xbb\xbf" + ply);
  ASSERT_TRUE(c.ok() && d.ok()) << d.status().message();
  EXPECT_EQ(c->vertices, d->vertices);
}

// A grid of bumps, moved; with a normal per vertex, or none.
std::string BumpsObj(const Eigen::Vector3d& moved,
                     const std::vector<Eigen::Vector3d>& normals = {}) {
  constexpr int kSide = 9;
  std::string obj, faces;
  for (int y = 0; y < kSide; ++y) {
    for (int x = 0; x < kSide; ++x) {
      const Eigen::Vector3d p =
          moved + Eigen::Vector3d(0.25 * x, 0.5 * y, 0.125 * (x * y % 3));
      obj += "v " + Format("%.10g", p.x()) + " " + Format("%.10g", p.y()) +
             " " + Format("%.10g", p.z()) + "\n";
    }
  }
  for (const Eigen::Vector3d& n : normals) {
    obj += "vn " + Format("%g", n.x()) + " " + Format("%g", n.y()) + " " +
           Format("%g", n.z()) + "\n";
  }
  const auto corner = [&](int x, int y) {
    const std::string v = std::to_string(y * kSide + x + 1);
    return " " + v + (normals.empty() ? "" : "//" + v);
  };
  for (int y = 0; y + 1 < kSide; ++y) {
    for (int x = 0; x + 1 < kSide; ++x) {
      faces += "f" + corner(x, y) + corner(x + 1, y) + corner(x + 1, y + 1) +
               corner(x, y + 1) + "\n";
    }
  }
  return obj + faces;
}

TEST(Mesh, GeoreferencedCoordinatesAreTakenFromTheirCentre) {
  StatusOr<TriangleMesh> near = DecodeMesh("a.obj", BumpsObj({0, 0, 0}));
  const Eigen::Vector3d offset(5e5, 4e6, 300);
  MeshNotes notes;
  StatusOr<TriangleMesh> far = DecodeMesh("a.obj", BumpsObj(offset), &notes);
  ASSERT_TRUE(near.ok() && far.ok());
  ASSERT_EQ(near->vertices.size(), far->vertices.size());
  EXPECT_EQ(near->triangles, far->triangles);
  EXPECT_LT((notes.origin - offset).norm(), 5.0);
  for (size_t v = 0; v < near->vertices.size(); ++v) {
    const Eigen::Vector3d p =
        notes.origin + far->vertices[v].cast<double>() - offset;
    EXPECT_LT((p - near->vertices[v].cast<double>()).norm(), 1e-6);
    EXPECT_LT((near->normals[v] - far->normals[v]).norm(), 1e-6);
  }
  FitUnitSphere(&*near);
  FitUnitSphere(&*far);
  for (size_t v = 0; v < near->vertices.size(); ++v) {
    EXPECT_LT((near->vertices[v] - far->vertices[v]).norm(), 1e-6);
  }
  // Others keep the file's floats.
  MeshNotes none;
  ASSERT_TRUE(DecodeMesh("a.obj", BumpsObj({70, 0, 0}), &none).ok());
  EXPECT_TRUE(none.origin.isZero());
}

TEST(Mesh, BadNormalsAreMadeFromTheFacesAndCounted) {
  const StatusOr<TriangleMesh> right = DecodeMesh("a.obj", BumpsObj({0, 0, 0}));
  ASSERT_TRUE(right.ok());
  std::vector<Eigen::Vector3d> good(right->normals.size());
  for (size_t v = 0; v < good.size(); ++v) {  // in the file's order
    const Eigen::Vector3f& p = right->vertices[v];
    const long x = std::lround(4 * p.x()), y = std::lround(2 * p.y());
    good[static_cast<size_t>(9 * y + x)] = right->normals[v].cast<double>();
  }
  const auto expect = [&](const std::vector<Eigen::Vector3d>& normals,
                          const std::string& says) {
    MeshNotes notes;
    const StatusOr<TriangleMesh> mesh =
        DecodeMesh("a.obj", BumpsObj({0, 0, 0}, normals), &notes);
    ASSERT_TRUE(mesh.ok()) << mesh.status().message();
    for (size_t v = 0; v < good.size(); ++v) {
      EXPECT_LT((mesh->normals[v] - right->normals[v]).norm(), 1e-5);
    }
    ASSERT_EQ(says.empty() ? 0u : 1u, notes.warnings.size());
    if (says.empty()) return;
    EXPECT_EQ("a.obj: " + says, notes.warnings[0]);
  };
  expect(good, "");
  std::vector<Eigen::Vector3d> bad = good;
  bad[7] *= std::nan("");
  bad[9].setZero();
  expect(bad,
         "2 of 81 normals are zero or not finite; all were made from the "
         "faces");
  bad = good;
  bad[40] = -bad[40];
  expect(bad,
         "1 of 81 normals contradict the faces around them; all were made from "
         "the faces");
  for (Eigen::Vector3d& n : good) n = -n;  // a matter of the winding alone
  MeshNotes notes;
  const StatusOr<TriangleMesh> inward =
      DecodeMesh("a.obj", BumpsObj({0, 0, 0}, good), &notes);
  ASSERT_TRUE(inward.ok());
  EXPECT_TRUE(notes.warnings.empty());
  EXPECT_LT((inward->normals[3] + right->normals[3]).norm(), 1e-5);
}

TEST(Mesh, BadMeshesAreRefused) {
  const TempDir dir;
  const std::string obj = dir.File("a.obj"), ply = dir.File("a.ply");
  const auto refused = [](const std::string& path, const std::string& bytes) {
    WriteBytes(path, bytes);
    const Status status = ReadMesh(path).status();
    EXPECT_EQ(StatusCode::kInvalidInput, status.code()) << bytes;
    EXPECT_EQ(0u, status.message().find(path + ": ")) << status.message();
  };
  const std::string triangle = "v 0 0 0\nv 1 0 0\nv 0 1 0\n";
  refused(obj, "");
  refused(obj, "this is no mesh");
  refused(obj, triangle);                                      // no faces
  refused(obj, "\xfe\xffv 9 9 9\n" + triangle + "f 1 2 3\n");  // UTF-16's mark
  refused(obj, triangle + "f 1 2 4\n");                        // out of range
  refused(obj, triangle + "f 1 2 -9\n");
  refused(obj, triangle + "f 1 2 0\n");
  refused(obj, triangle + "f 1 2 99999999999\n");
  refused(obj, "v nan 0 0\nv 1 0 0\nv 0 1 0\nf 1 2 3\n");
  refused(obj, "v 0 inf 0\nv 1 0 0\nv 0 1 0\nf 1 2 3\n");
  refused(obj, "v 0 1e99 0\nv 1 0 0\nv 0 1 0\nf 1 2 3\n");
  refused(obj, triangle + "l 1 2\n");  // lines only
  refused(obj, triangle + std::string("f 1 2 3\0\n", 9));
  refused(ply, "");
  refused(ply, "ply\n");
  const std::string text = kTetrahedronPly;
  const auto replaced = [&](const std::string& from, const std::string& to) {
    std::string bytes = text;
    bytes.replace(bytes.find(from), from.size(), to);
    return bytes;
  };
  refused(ply, replaced("3 1 2 3", "3 1 2 4"));
  refused(ply, replaced("3 1 2 3", "3 1 2 -1"));
  refused(ply, replaced("vertex 4", "vertex 4000000000"));
  refused(ply, replaced("vertex 4", "vertex 2000000000"));
  refused(ply, replaced("face 4", "face 1000000"));
  refused(ply, replaced("vertex 4", "vertex -1"));
  refused(ply, replaced("face 4", "face 0"));
  refused(ply, replaced("float x", "quaternion x"));
  refused(ply, replaced("ascii", "morse"));
  refused(ply, replaced("1 0 0\n", "nan 0 0\n"));
}

constexpr char kSquare[] = "v 0 0 0\nv 1 0 0\nv 1 1 0\nv 0 1 0\n";

TEST(MeshTexture, SeamsOfTextureAreNoSeamsOfShading) {
  // Two triangles that share an edge on the surface, not in the picture.
  const StatusOr<TriangleMesh> mesh = DecodeMesh(
      "a.obj", std::string(kSquare) +
                   "vt 0 0\nvt 0.5 0\nvt 0.5 1\nvt 0.75\nvt 1 0.5 0\nvt "
                   "0.75 1\nf 1/1 2/2 3/3\nf 1/-3 3/-2 4/-1\n");
  ASSERT_TRUE(mesh.ok()) << mesh.status().message();
  EXPECT_EQ(4u, mesh->vertices.size());
  ASSERT_EQ(2u, mesh->texture.size());
  EXPECT_EQ(Eigen::Vector2f(0.5f, 0.0f), mesh->texture[0][1]);
  EXPECT_EQ(Eigen::Vector2f(0.75f, 0.0f), mesh->texture[1][0]);
  EXPECT_EQ(Eigen::Vector2f(1.0f, 0.5f), mesh->texture[1][1]);
}

TEST(MeshTexture, FollowsTheCornersOfPolygons) {
  const StatusOr<TriangleMesh> mesh = DecodeMesh(
      "a.obj", std::string(kSquare) +
                   "vt 0 0\nvt 1 0\nvt 1 1\nvt 0 1\nf 1/1 2/2 3/3 4/4\n");
  ASSERT_TRUE(mesh.ok());
  ASSERT_EQ(2u, mesh->texture.size());
  for (size_t t = 0; t < 2; ++t) {
    for (int k = 0; k < 3; ++k) {
      EXPECT_EQ(mesh->vertices[mesh->triangles[t][k]].head<2>(),
                mesh->texture[t][k]);
    }
  }
}

// The rest of the mesh is as without it.
TEST(MeshTexture, FaultsAreToldAndLeaveTheMesh) {
  const std::string plain = std::string(kSquare) + "f 1 2 3\nf 1 3 4\n";
  const TriangleMesh without = DecodeMesh("a.obj", plain).value();
  EXPECT_TRUE(without.texture.empty());
  const std::string vt = std::string(kSquare) + "vt 0 0\nvt 1 0\nvt 1 1\n";
  const struct {
    std::string text, fault;
  } cases[] = {
      {plain, ""},
      {vt + "f 1 2 3\nf 1 3 4\n", ""},
      {vt + "f 1/1 2/2 3/3\nf 1 3 4\n",
       "expected texture coordinates (vt) on all faces or on none"},
      {vt + "f 1/1 2/2 3\nf 1 3 4\n",
       "expected texture coordinates (vt) on all faces or on none"},
      {vt + "f 1/1 2/2 3/3\nf 1/1 3/3 4/4\n",
       "expected indices of the file's 3 texture coordinates (vt) at line 9"},
      {vt + "f 1/1 2/2 3/3\nf 1/1 3/0 4/1\n",
       "expected indices of the file's 3 texture coordinates (vt) at line 9"},
      {vt + "f 1/1 2/2 3/x\nf 1/1 3/3 4/1\n",
       "expected indices of the file's 3 texture coordinates (vt) at line 8"},
      {std::string(kSquare) + "vt nan 0\nf 1/1 2/1 3/1\nf 1/1 3/1 4/1\n",
       "expected vt and finite numbers at line 5"},
      {std::string(kSquare) + "vt\nf 1/1 2/1 3/1\nf 1/1 3/1 4/1\n",
       "expected vt and finite numbers at line 5"}};
  for (const auto& c : cases) {
    MeshNotes notes;
    const StatusOr<TriangleMesh> mesh = DecodeMesh("a.obj", c.text, &notes);
    ASSERT_TRUE(mesh.ok()) << mesh.status().message();
    EXPECT_EQ(c.fault, notes.texture_fault);
    EXPECT_TRUE(mesh->texture.empty());
    EXPECT_EQ(without.vertices, mesh->vertices);
    EXPECT_EQ(without.triangles, mesh->triangles);
    EXPECT_EQ(without.normals, mesh->normals);
  }
}

TEST(MeshTexture, PlyHasItUnderThreeNames) {
  for (const auto& [u, v] :
       {std::pair("s", "t"), {"u", "v"}, {"texture_u", "texture_v"}}) {
    const std::string ply =
        std::string(
            "ply\nformat ascii 1.0\nelement vertex 3\nproperty float "
            "x\nproperty float y\nproperty float z\nproperty float ") +
        u + "\nproperty float " + v +
        "\nelement face 1\nproperty list uchar int "
        "vertex_indices\nend_header\n0 0 0 0.1 0.2\n1 0 0 0.3 0.4\n0 1 0 0.5 "
        "0.6\n3 0 1 2\n";
    const StatusOr<TriangleMesh> mesh = DecodeMesh("a.ply", ply);
    ASSERT_TRUE(mesh.ok()) << mesh.status().message();
    ASSERT_EQ(1u, mesh->texture.size());
    EXPECT_EQ(Eigen::Vector2f(0.3f, 0.4f), mesh->texture[0][1]);
    MeshNotes notes;
    std::string bad = ply;
    bad.replace(bad.find("0.3"), 3, "nan");
    EXPECT_TRUE(DecodeMesh("a.ply", bad, &notes)->texture.empty());
    EXPECT_EQ("expected finite texture coordinates", notes.texture_fault);
  }
}

TEST(Mesh, WhatIsNotAMeshFile) {
  const TempDir dir;
  EXPECT_FALSE(ReadMesh(dir.File("missing.obj")).ok());
  std::filesystem::create_directory(dir.File("folder.obj"));
  EXPECT_FALSE(ReadMesh(dir.File("folder.obj")).ok());
  WriteBytes(dir.File("a.fbx"), "Kaydara FBX Binary");
  EXPECT_EQ(
      dir.File("a.fbx") + ": extension: expected .obj, .ply, .stl or .glb",
      ReadMesh(dir.File("a.fbx")).status().message());
}

TEST(Mesh, DamagedFiles) {
  std::string path;
  const auto check = [&](const std::string& bytes) {
    const StatusOr<TriangleMesh> mesh = DecodeMesh(path, bytes);
    if (mesh.ok()) {
      ExpectValid(*mesh);
    } else {
      EXPECT_EQ(StatusCode::kInvalidInput, mesh.status().code());
    }
  };
  for (const char* name : {"a.obj", "a.ply"}) {
    path = name;
    const std::string bytes =
        std::strcmp(name, "a.obj") == 0 ? kCubeObj : kTetrahedronPly;
    ForEachTruncation(bytes, 200, check);
    ForEachCorruption(bytes, 200, 2000, 7, check);
  }
  // Binary faces and vertices.
  std::string bytes =
      "ply\nformat binary_big_endian 1.0\nelement vertex 3\n"
      "property float x\nproperty float y\nproperty float z\n"
      "element face 1\nproperty list uchar int vertex_indices\nend_header\n";
  const size_t header = bytes.size();
  bytes += std::string(36, '\0');
  bytes[header + 12] = bytes[header + 28] = 0x3f;
  bytes += std::string("\3\0\0\0\0\0\0\0\1\0\0\0\2", 13);
  ForEachTruncation(bytes, 200, check);
  ForEachCorruption(bytes, header, 2000, 8, check);
}

TEST(Mesh, SharedMeshesAreClosedAndOriented) {
  IBRDF_REQUIRE_SHARED_DATA(data_dir);
  for (const char* name :
       {"armadillo", "bunny", "spot_low_resolution", "torus"}) {
    StatusOr<TriangleMesh> mesh =
        ReadMesh(data_dir + "/meshes/" + name + ".obj");
    ASSERT_TRUE(mesh.ok()) << mesh.status().message();
    ExpectValid(*mesh);
    EXPECT_TRUE(IsClosed(*mesh)) << name;
    EXPECT_GT(SignedVolume(*mesh), 0.0) << name;
    FitUnitSphere(&*mesh);
    float farthest = 0.0f;
    for (const Eigen::Vector3f& v : mesh->vertices) {
      farthest = std::max(farthest, v.norm());
    }
    EXPECT_NEAR(1.0f, farthest, kUnitTolerance) << name;
  }
}

}  // namespace
}  // namespace ibrdf
