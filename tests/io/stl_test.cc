// STL files: text and binary.
#include <gtest/gtest.h>

#include <string>
#include <vector>

#include "ibrdf/io/mesh.h"
#include "tests/support/corruption.h"
#include "tests/support/mesh_files.h"

namespace ibrdf {
namespace {

void ExpectStlRefused(const std::string& bytes, const std::string& says) {
  const Status status = DecodeMesh("a.stl", bytes).status();
  EXPECT_EQ(StatusCode::kInvalidInput, status.code());
  EXPECT_EQ(0u, status.message().find("a.stl: ")) << status.message();
  EXPECT_NE(std::string::npos, status.message().find(says)) << status.message();
}

TEST(Stl, RepeatedVerticesAreJoined) {
  const StatusOr<TriangleMesh> expected =
      DecodeMesh("a.obj", ObjBytes(Tetrahedron()));
  ASSERT_TRUE(expected.ok());
  for (const std::string& bytes :
       {StlBytes(Tetrahedron()), StlText(Tetrahedron()),
        "\xef\xbb\xbf\r\n" + StlText(Tetrahedron())}) {
    const StatusOr<TriangleMesh> mesh = DecodeMesh("a.STL", bytes);
    ASSERT_TRUE(mesh.ok()) << mesh.status().message();
    EXPECT_EQ(4u, mesh->vertices.size());
    EXPECT_EQ(expected->triangles, mesh->triangles);
    EXPECT_EQ(expected->vertices, mesh->vertices);
    EXPECT_EQ(expected->normals, mesh->normals);
  }
}

TEST(Stl, TextOfSeveralSolidsInAnyCaseAndWithAnyLineEnd) {
  std::string text = StlText(Tetrahedron());
  for (size_t at = 0; (at = text.find('\n', at)) != std::string::npos;
       at += 2) {
    text.replace(at, 1, "\r\n");
  }
  std::string capitals = text;
  for (char& c : capitals) c = static_cast<char>(std::toupper(c));
  const StatusOr<TriangleMesh> mesh = DecodeMesh("a.stl", text + capitals);
  ASSERT_TRUE(mesh.ok()) << mesh.status().message();
  EXPECT_EQ(8u, mesh->triangles.size());
  EXPECT_EQ(4u, mesh->vertices.size());
}

TEST(Stl, BadTextIsRefusedByLine) {
  const std::string text = StlText(Tetrahedron());
  const auto replaced = [&](const std::string& from, const std::string& to) {
    std::string out = text;
    return out.replace(out.find(from), from.size(), to);
  };
  const std::string vertex = "vertex 0 1 0";
  ExpectStlRefused(replaced(vertex, "vertex 0 nan 0"),
                   "line 5: expected three");
  ExpectStlRefused(replaced(vertex, "vertex 0 1e99 0"),
                   "line 5: expected three");
  ExpectStlRefused(replaced(vertex, "vertex 0 one 0"),
                   "line 5: expected three");
  ExpectStlRefused(replaced(vertex, "vertex 0 1"), "line 5: expected a vertex");
  ExpectStlRefused(replaced(vertex, ""), "three vertices, found 2");
  ExpectStlRefused(replaced(vertex, vertex + "\n" + vertex),
                   "three vertices, found 4");
  ExpectStlRefused(replaced("endfacet", ""), "before another facet");
  ExpectStlRefused(replaced("endloop", "color 1 0 0"),
                   "line 7: expected facet");
  ExpectStlRefused(text.substr(0, text.find("endsolid")), "cut off");
  ExpectStlRefused(text.substr(0, text.rfind("    endloop")), "cut off");
  ExpectStlRefused("solid a\nendsolid a\n", "at least one face");
  ExpectStlRefused("solid", "cut off");
}

TEST(Stl, BadBinaryFilesAreRefused) {
  const std::string bytes = StlBytes(Tetrahedron());
  ExpectStlRefused("", "found 0 bytes");
  ExpectStlRefused("this is no mesh", "found 15 bytes");
  // Cut off, and with a count that lies.
  ExpectStlRefused(bytes.substr(0, bytes.size() - 1), "found 4 triangles");
  ExpectStlRefused(bytes + "more", "found 4 triangles");
  std::string damaged = bytes;
  damaged.replace(80, 4, std::string(4, '\xff'));
  ExpectStlRefused(damaged, "found 4294967295 triangles");
  damaged = bytes;
  damaged.replace(80, 4, std::string(4, '\0'));
  ExpectStlRefused(damaged, "found 0 triangles");
  ExpectStlRefused(damaged.substr(0, 84), "at least one face");
  damaged = bytes;
  damaged.replace(84 + 50 + 12, 4, std::string("\0\0\xc0\x7f", 4));
  ExpectStlRefused(damaged, "triangle 1: expected finite");
}

TEST(Stl, DamagedFiles) {
  const auto check = [](const std::string& bytes) {
    const StatusOr<TriangleMesh> mesh = DecodeMesh("a.stl", bytes);
    if (!mesh.ok()) {
      EXPECT_EQ(StatusCode::kInvalidInput, mesh.status().code());
      return;
    }
    for (const auto& triangle : mesh->triangles) {
      for (const int v : triangle) ASSERT_LT(v, mesh->vertices.size());
    }
  };
  for (const std::string& bytes :
       {StlBytes(Tetrahedron()), StlText(Tetrahedron())}) {
    ForEachTruncation(bytes, 200, check);
    ForEachCorruption(bytes, 200, 2000, 7, check);
  }
}

}  // namespace
}  // namespace ibrdf
