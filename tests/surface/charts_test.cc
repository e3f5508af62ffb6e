#include "ibrdf/surface/charts.h"

#include <gtest/gtest.h>

#include <Eigen/Geometry>

#include "ibrdf/surface/surface_atlas.h"
#include "tests/support/shapes.h"

namespace ibrdf {
namespace {

// Nothing lies on anything else, all of the area has texels, and they are where
// the triangles are.
void ExpectInjective(const TriangleMesh& mesh, int size) {
  EXPECT_EQ("", TextureFault(mesh));
  const StatusOr<SurfaceAtlas> atlas =
      SurfaceAtlas::OfMesh(mesh, Eigen::Vector3d::Zero(), size, size);
  ASSERT_TRUE(atlas.ok()) << atlas.status().message();
  EXPECT_EQ(0, atlas->overlapped);
  EXPECT_EQ(0.0, atlas->area_without);
}

TEST(Charts, OfATorusAreInjectiveAndFillSomeOfThePicture) {
  TriangleMesh mesh = TorusMesh(60, 24);
  AddCharts(&mesh);
  ExpectInjective(mesh, 256);
  // Four sides of the ring, its upper and its lower half, and the inside.
  EXPECT_GE(CountCharts(mesh), 6);
  EXPECT_LE(CountCharts(mesh), 24);
  double in_picture = 0.0;
  for (const auto& uv : mesh.texture) {
    const Eigen::Vector2f a = uv[1] - uv[0], b = uv[2] - uv[0];
    in_picture += 0.5 * std::abs(a.x() * b.y() - a.y() * b.x());
  }
  EXPECT_GT(in_picture, 0.2);
}

TEST(Charts, WhatOverlapsIsCutApart) {
  TriangleMesh ramp = WindingRamp(80);
  AddCharts(&ramp);
  ExpectInjective(ramp, 256);
  EXPECT_GE(CountCharts(ramp), 2);
  // As one chart it would overlap.
  TriangleMesh flat = WindingRamp(80);
  for (const auto& triangle : flat.triangles) {
    flat.texture.emplace_back();
    for (int k = 0; k < 3; ++k) {
      const Eigen::Vector3f& p = flat.vertices[triangle[k]];
      flat.texture.back()[k] = {0.5f + 0.4f * p.x(), 0.5f + 0.4f * p.z()};
    }
  }
  EXPECT_GT(
      SurfaceAtlas::OfMesh(flat, Eigen::Vector3d::Zero(), 256, 256)->overlapped,
      1000);
}

TEST(Charts, ScaleIsOneOnAFlatMesh) {
  TriangleMesh mesh;
  mesh.vertices = {{0, 0, 5}, {4, 0, 5}, {4, 2, 5}, {0, 2, 5}};
  mesh.triangles = {{0, 1, 2}, {0, 2, 3}};
  AddCharts(&mesh);
  EXPECT_EQ(1, CountCharts(mesh));
  const Eigen::Vector2f along = mesh.texture[0][1] - mesh.texture[0][0];
  const Eigen::Vector2f across = mesh.texture[0][2] - mesh.texture[0][1];
  EXPECT_NEAR(along.norm(), 2.0f * across.norm(), 1e-6f);
  EXPECT_NEAR(1.0f, along.norm() + 2.0f / 256, 1e-5f);  // but for the gaps
}

TEST(Charts, ManyPartsPointsAndFlippedFacesHaveSome) {
  TriangleMesh mesh;
  for (int i = 0; i < 3000; ++i) {
    const auto x = static_cast<float>(i);
    const int v = 3 * i;
    mesh.vertices.insert(mesh.vertices.end(),
                         {{x, 0, 0}, {x, 1, 0}, {x + 0.5f, 0, 0.1f}});
    mesh.triangles.push_back({v, v + 1 + i % 2, v + 2 - i % 2});
  }
  AddCharts(&mesh);
  ExpectInjective(mesh, 512);
  mesh.triangles.push_back({0, 0, 1});  // no area
  AddCharts(&mesh);
  EXPECT_EQ("", TextureFault(mesh));
  TriangleMesh point;
  point.vertices = {{1, 2, 3}};
  point.triangles = {{0, 0, 0}};
  AddCharts(&point);
  EXPECT_EQ("", TextureFault(point));
}

TEST(Charts, AreTheSameEachTime) {
  TriangleMesh a = TorusMesh(30, 12), b = a;
  AddCharts(&a);
  AddCharts(&b);
  EXPECT_EQ(a.texture, b.texture);
}

}  // namespace
}  // namespace ibrdf
