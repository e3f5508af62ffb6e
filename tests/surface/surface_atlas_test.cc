#include "ibrdf/surface/surface_atlas.h"

#include <gtest/gtest.h>

#include <Eigen/Geometry>
#include <algorithm>
#include <random>

#include "ibrdf/scene/scene.h"
#include "ibrdf/surface/charts.h"
#include "tests/support/shapes.h"

namespace ibrdf {
namespace {

// Areas of texels are floats.
constexpr double kFloat = 1e-5;

double TotalArea(const SurfaceAtlas& atlas) {
  double area = atlas.area_without;
  for (const SurfaceTexel& texel : atlas.texels) area += double{texel.area};
  return area;
}

void ExpectFrames(const SurfaceAtlas& atlas) {
  int last = -1;
  for (const SurfaceTexel& t : atlas.texels) {
    EXPECT_GT(t.texel, last);
    last = t.texel;
    Eigen::Matrix3f frame;
    frame << t.tangent, t.bitangent, t.normal;
    ASSERT_TRUE((frame.transpose() * frame).isIdentity(1e-5f));
    ASSERT_GT(frame.determinant(), 0.0f);
    ASSERT_GT(t.area, 0.0f);
  }
  EXPECT_LT(last, atlas.width * atlas.height);
}

TEST(SurfaceAtlas, SpheresAreaAndPlacesAreExact) {
  const Eigen::Vector3d centre(1, -2, 3);
  const SurfaceAtlas atlas = SurfaceAtlas::OfSphere(centre, 2.0, 64, 32);
  EXPECT_EQ(64u * 32u, atlas.texels.size());
  EXPECT_NEAR(16.0 * kPi, TotalArea(atlas), 16.0 * kPi * kFloat);
  ExpectFrames(atlas);
  for (const SurfaceTexel& t : atlas.texels) {
    const Eigen::Vector3d n = (t.position - centre) / 2.0;
    EXPECT_NEAR(1.0, n.norm(), 1e-12);
    const Eigen::Vector2f uv = SphereTexture(n);
    EXPECT_NEAR(t.texel % 64 + 0.5f, uv.x() * 64, 1e-4f);
    EXPECT_NEAR(t.texel / 64 + 0.5f, (1.0f - uv.y()) * 32, 1e-4f);
  }
}

TEST(SurfaceAtlas, AreasSumToTheMeshs) {
  TriangleMesh mesh = TorusMesh(40, 16);
  AddCharts(&mesh);
  for (const int size : {16, 100, 400}) {
    const StatusOr<SurfaceAtlas> atlas =
        SurfaceAtlas::OfMesh(mesh, {0, 0, 0}, size, size + 7);
    ASSERT_TRUE(atlas.ok());
    EXPECT_NEAR(AreaOf(mesh), TotalArea(*atlas), AreaOf(mesh) * kFloat);
    ExpectFrames(*atlas);
  }
}

// Distance from a triangle's plane and outside of its edges.
double DistanceTo(const TriangleMesh& mesh, size_t t,
                  const Eigen::Vector3d& p) {
  Eigen::Vector3d v[3];
  for (int k = 0; k < 3; ++k) {
    v[k] = mesh.vertices[mesh.triangles[t][k]].cast<double>();
  }
  const Eigen::Vector3d n = (v[1] - v[0]).cross(v[2] - v[0]).normalized();
  double distance = std::abs(n.dot(p - v[0]));
  for (int k = 0; k < 3; ++k) {
    const Eigen::Vector3d inward = n.cross(v[(k + 1) % 3] - v[k]).normalized();
    distance = std::max(distance, -inward.dot(p - v[k]));
  }
  return distance;
}

TEST(SurfaceAtlas, PositionsLieOnTheSurface) {
  TriangleMesh mesh = TorusMesh(24, 10);
  AddCharts(&mesh);
  const Eigen::Vector3d origin(1e6, 0, 0);
  const SurfaceAtlas atlas = SurfaceAtlas::OfMesh(mesh, origin, 64, 64).value();
  for (const SurfaceTexel& texel : atlas.texels) {
    double nearest = 1.0;
    for (size_t t = 0; t < mesh.triangles.size(); ++t) {
      nearest = std::min(nearest, DistanceTo(mesh, t, texel.position - origin));
    }
    ASSERT_LT(nearest, 1e-6) << texel.texel;
    // Normals are the torus's but for facets.
    const Eigen::Vector3d p = texel.position - origin;
    const Eigen::Vector3d ring = Eigen::Vector3d(p.x(), 0, p.z()).normalized();
    ASSERT_GT((p - ring).normalized().dot(texel.normal.cast<double>()), 0.97);
  }
}

// A point of the surface finds the texel that is nearest to it.
TEST(SurfaceAtlas, TexelsArePlacesOfTheirOwn) {
  TriangleMesh mesh = TorusMesh(40, 16);
  AddCharts(&mesh);
  constexpr int kSize = 256;  // gaps between charts are a texel
  const SurfaceAtlas atlas =
      SurfaceAtlas::OfMesh(mesh, {0, 0, 0}, kSize, kSize).value();
  std::vector<const SurfaceTexel*> at(kSize * kSize, nullptr);
  for (const SurfaceTexel& t : atlas.texels) at[t.texel] = &t;
  std::mt19937 rng(1);
  std::uniform_real_distribution<float> unit(0.0f, 1.0f);
  for (int i = 0; i < 20000; ++i) {
    const size_t t = rng() % mesh.triangles.size();
    float a = unit(rng), b = unit(rng);
    if (a + b > 1.0f) {
      a = 1.0f - a;
      b = 1.0f - b;
    }
    const float weights[3] = {1.0f - a - b, a, b};
    Eigen::Vector2f uv(0, 0);
    Eigen::Vector3d p(0, 0, 0);
    for (int k = 0; k < 3; ++k) {
      uv += weights[k] * mesh.texture[t][k];
      p += weights[k] * mesh.vertices[mesh.triangles[t][k]].cast<double>();
    }
    const int x = std::min(static_cast<int>(uv.x() * kSize), kSize - 1);
    const int y =
        std::clamp(static_cast<int>((1.0f - uv.y()) * kSize), 0, kSize - 1);
    const SurfaceTexel* texel = at[y * kSize + x];
    ASSERT_NE(nullptr, texel);
    // A texel is 0.03 wide on a surface that its chart sees face on, and its
    // diagonal is 2.5 times as long where it is seen at 55 degrees.
    ASSERT_LT((texel->position - p).norm(), 0.08);
  }
}

TEST(SurfaceAtlas, OneTexelHoldsAll) {
  TriangleMesh mesh = TorusMesh(8, 6);
  AddCharts(&mesh);
  const SurfaceAtlas atlas =
      SurfaceAtlas::OfMesh(mesh, {0, 0, 0}, 1, 1).value();
  ASSERT_EQ(1u, atlas.texels.size());
  EXPECT_NEAR(AreaOf(mesh), atlas.texels[0].area, AreaOf(mesh) * kFloat);
  EXPECT_EQ(1u, SurfaceAtlas::OfSphere({0, 0, 0}, 1.0, 1, 1).texels.size());
}

TEST(SurfaceAtlas, RefusesOtherCoordinates) {
  TriangleMesh mesh = TorusMesh(8, 6);
  EXPECT_EQ("expected texture coordinates of all faces", TextureFault(mesh));
  EXPECT_FALSE(SurfaceAtlas::OfMesh(mesh, {0, 0, 0}, 4, 4).ok());
  AddCharts(&mesh);
  mesh.texture[3][1] = {1.5f, 0.2f};
  EXPECT_EQ("expected texture coordinates in [0, 1], found 1.5, 0.2",
            TextureFault(mesh));
  for (auto& corners : mesh.texture) {
    corners.fill(Eigen::Vector2f(0.5f, 0.5f));
  }
  EXPECT_EQ("mesh: expected texture coordinates that span an area",
            SurfaceAtlas::OfMesh(mesh, {0, 0, 0}, 4, 4).status().message());
  // Some of it.
  mesh.texture[0] = {Eigen::Vector2f(0, 0), Eigen::Vector2f(1, 0),
                     Eigen::Vector2f(0, 1)};
  const SurfaceAtlas atlas =
      SurfaceAtlas::OfMesh(mesh, {0, 0, 0}, 4, 4).value();
  EXPECT_NEAR(AreaOf(mesh) - AreaOfTriangle(mesh, 0), atlas.area_without, 1e-6);
}

}  // namespace
}  // namespace ibrdf
