#include "ibrdf/scene/scene.h"

#include <gtest/gtest.h>

#include <cmath>
#include <limits>
#include <map>

#include "tests/support/render_testing.h"

namespace ibrdf {
namespace {

TriangleMesh SphereMesh(int rows, int columns) {
  TriangleMesh mesh;
  for (int r = 0; r <= rows; ++r) {
    for (int c = 0; c <= columns; ++c) {
      const Eigen::Vector3f p = MapDirection(r, c, rows, columns).cast<float>();
      mesh.vertices.push_back(p);
      mesh.normals.push_back(p);
    }
  }
  const auto at = [&](int r, int c) { return r * (columns + 1) + c; };
  for (int r = 0; r < rows; ++r) {
    for (int c = 0; c < columns; ++c) {
      mesh.triangles.push_back({at(r, c), at(r + 1, c), at(r + 1, c + 1)});
      mesh.triangles.push_back({at(r, c), at(r + 1, c + 1), at(r, c + 1)});
    }
  }
  return mesh;
}

std::map<int, Eigen::Vector3f> NormalsByPixel(
    const std::vector<ShadingPoint>& points) {
  std::map<int, Eigen::Vector3f> normals;
  for (const ShadingPoint& p : points) normals[p.pixel] = p.normal;
  return normals;
}

Camera Perspective() {
  Camera camera;
  camera.type = CameraType::kPerspective;
  camera.from = {1, 2, 3};
  camera.fov_degrees = 35;
  return camera;
}

TEST(Scene, OrthographicSphereHasTheClosedFormNormals) {
  const int size = 33;
  const std::vector<ShadingPoint> points = testing::SpherePoints(size);
  for (const ShadingPoint& p : points) {
    const double x = (p.pixel % size + 0.5) / size * 2 - 1;
    const double y = 1 - (p.pixel / size + 0.5) / size * 2;
    EXPECT_NEAR(x, p.normal.x(), 1e-6);
    EXPECT_NEAR(y, p.normal.y(), 1e-6);
    EXPECT_EQ(Eigen::Vector3f(0, 0, 1), p.wo);
    EXPECT_EQ(1.0f, p.coverage);
  }
  EXPECT_NEAR(kPi / 4, static_cast<double>(points.size()) / (size * size),
              0.01);
}

TEST(Scene, ThreadsDoNotChangeThePoints) {
  const Mask all;
  const auto one =
      FindShadingPoints(Scene::UnitSphere(), Camera(), 32, 32, all, 2, 1);
  const auto two =
      FindShadingPoints(Scene::UnitSphere(), Camera(), 32, 32, all, 2, 2);
  ASSERT_TRUE(one.ok() && two.ok());
  ASSERT_EQ(one->size(), two->size());
  for (size_t i = 0; i < one->size(); ++i) {
    EXPECT_EQ((*one)[i].pixel, (*two)[i].pixel);
    EXPECT_EQ((*one)[i].normal, (*two)[i].normal);
  }
}

TEST(Scene, SupersamplesStandForTheirShareOfThePixel) {
  const auto points =
      FindShadingPoints(Scene::UnitSphere(), Camera(), 16, 16, Mask(), 4);
  ASSERT_TRUE(points.ok());
  double area = 0.0;
  for (const ShadingPoint& p : *points) {
    EXPECT_EQ(1.0f / 16, p.coverage);
    area += p.coverage;
  }
  EXPECT_NEAR(kPi / 4, area / 256, 0.01);
}

TEST(Scene, TessellatedSphereMatchesTheAnalyticOne) {
  const auto scene = Scene::FromMesh(SphereMesh(128, 256));
  ASSERT_TRUE(scene.ok()) << scene.status().message();
  for (const Camera& camera : {Camera(), Perspective()}) {
    const auto a =
        FindShadingPoints(Scene::UnitSphere(), camera, 64, 48, Mask(), 1);
    const auto b = FindShadingPoints(*scene, camera, 64, 48, Mask(), 1);
    ASSERT_TRUE(a.ok() && b.ok());
    const auto sphere = NormalsByPixel(*a), mesh = NormalsByPixel(*b);
    std::map<int, Eigen::Vector3f> views;
    for (const ShadingPoint& p : *b) views[p.pixel] = p.wo;
    // Halves of 1.4-degree squares lie up to (1 degree)^2 / 2 = 1.5e-4 inside:
    // pixels on the outline may differ, and the point seen moves along the
    // surface by that over cos(theta_o); twice that for the floor of 0.05.
    EXPECT_NEAR(sphere.size(), mesh.size(), 4);
    for (const auto& [pixel, normal] : mesh) {
      const auto it = sphere.find(pixel);
      ASSERT_TRUE(it != sphere.end());
      const double cosine = std::max(0.05f, normal.dot(views.at(pixel)));
      EXPECT_LT((normal - it->second).norm(), 3e-4 / cosine);
    }
  }
}

TEST(Scene, OrientationAndUnitsOfAMeshDoNotMatter) {
  TriangleMesh mesh = SphereMesh(32, 64);
  const auto expected = FindShadingPoints(Scene::FromMesh(mesh).value(),
                                          Camera(), 24, 24, Mask(), 1);
  TriangleMesh flipped = mesh;
  for (std::array<int, 3>& t : flipped.triangles) std::swap(t[0], t[1]);
  TriangleMesh inward = mesh;
  for (Eigen::Vector3f& n : inward.normals) n = -n;
  for (const TriangleMesh& m : {flipped, inward}) {
    const auto points = FindShadingPoints(Scene::FromMesh(m).value(), Camera(),
                                          24, 24, Mask(), 1);
    ASSERT_TRUE(points.ok());
    ASSERT_EQ(expected->size(), points->size());
    for (size_t i = 0; i < points->size(); ++i) {
      EXPECT_LT(((*points)[i].normal - (*expected)[i].normal).norm(), 1e-5);
    }
  }
  // In units of a micrometre and far behind the image plane.
  for (Eigen::Vector3f& v : mesh.vertices) v = 1e6f * v;
  Ray ray{{3e5, 1e5, 0}, {0, 0, -1}};
  SurfaceHit hit{};
  ASSERT_TRUE(Scene::FromMesh(mesh).value().Intersect(ray, true, &hit));
  EXPECT_NEAR(0.3, hit.normal.x(), 5e-3);  // facets of 5.6 degrees
  EXPECT_NEAR(-1e6 * std::sqrt(1 - 0.1), hit.distance, 5e3);
}

TEST(Scene, NormalsAlwaysFaceTheViewer) {
  TriangleMesh mesh = SphereMesh(6, 9);  // coarse: silhouettes look away
  mesh.normals[10] = Eigen::Vector3f::Zero();
  mesh.normals[11] *= std::numeric_limits<float>::quiet_NaN();
  mesh.triangles.push_back({3, 3, 3});
  const auto points = FindShadingPoints(Scene::FromMesh(mesh).value(),
                                        Perspective(), 80, 80, Mask(), 2);
  ASSERT_TRUE(points.ok());
  for (const ShadingPoint& p : *points) {
    EXPECT_GE(p.normal.dot(p.wo), kMinViewCosine);
    EXPECT_NEAR(1.0f, p.normal.norm(), 1e-5f);
  }
}

TEST(Scene, NormalMapOfASphereMatchesTheSphere) {
  const int size = 40;
  const std::vector<ShadingPoint> sphere = testing::SpherePoints(size);
  Image map(size, size);
  for (const ShadingPoint& p : sphere) {
    for (int c = 0; c < 3; ++c) {
      map.rgb[3 * p.pixel + c] = 2.0f * p.normal[c];  // any length
    }
  }
  const auto scene = Scene::FromNormalMap(map);
  ASSERT_TRUE(scene.ok());
  const auto points =
      FindShadingPoints(*scene, Camera(), size, size, Mask(), 1);
  ASSERT_TRUE(points.ok());
  ASSERT_EQ(sphere.size(), points->size());
  for (size_t i = 0; i < sphere.size(); ++i) {
    EXPECT_EQ(sphere[i].pixel, (*points)[i].pixel);
    EXPECT_LT((sphere[i].normal - (*points)[i].normal).norm(), 1e-5);
  }
  EXPECT_EQ(StatusCode::kInvalidInput,
            FindShadingPoints(*scene, Perspective(), size, size, Mask(), 1)
                .status()
                .code());
  Camera tilted = Perspective();
  tilted.from = {0, 0, 4};
  tilted.to = {0, 0, 0};
  tilted.up = {0.1, 1, 0};
  EXPECT_FALSE(FindShadingPoints(*scene, tilted, size, size, Mask(), 1).ok());
  EXPECT_FALSE(FindShadingPoints(*scene, Camera(), 20, 20, Mask(), 1).ok());
  EXPECT_FALSE(Scene::FromNormalMap(Image(4, 4)).ok());
}

TEST(Scene, NormalsBeforeAPerspectiveCameraAreSeenAsTheSphereIs) {
  Camera camera;
  camera.type = CameraType::kPerspective;
  camera.fov_degrees = 40;
  camera.from = {0.3, -0.2, 3};  // off the axis, looking along -z
  camera.to = {0.3, -0.2, 0};
  const int width = 48, height = 36;
  const auto sphere =
      FindShadingPoints(Scene::UnitSphere(), camera, width, height, Mask(), 1);
  ASSERT_TRUE(sphere.ok());
  Image map(width, height);
  for (const ShadingPoint& p : *sphere) {
    for (int c = 0; c < 3; ++c) map.rgb[3 * p.pixel + c] = p.normal[c];
  }
  Camera own;  // where the problem leaves it
  own.type = CameraType::kPerspective;
  own.fov_degrees = 40;
  const auto points = FindShadingPoints(Scene::FromNormalMap(map).value(), own,
                                        width, height, Mask(), 1);
  ASSERT_TRUE(points.ok()) << points.status().message();
  ASSERT_EQ(sphere->size(), points->size());
  double widest = 0.0;
  for (size_t i = 0; i < points->size(); ++i) {
    const ShadingPoint &a = (*sphere)[i], &b = (*points)[i];
    EXPECT_EQ(a.pixel, b.pixel);
    EXPECT_LT((a.normal - b.normal).norm(), 1e-6);
    EXPECT_LT((a.wo - b.wo).norm(), 1e-6);
    widest = std::max(widest, std::acos(double{b.wo.z()}));
  }
  EXPECT_GT(widest, 0.2);  // the views differ
}

TEST(Scene, SpheresOfOtherPlacesAreTheUnitSphereMoved) {
  const Eigen::Vector3d center(0.25, -0.5, 0.125);
  const double radius = 0.5;
  const Scene scene = Scene::Sphere(center, radius);
  for (const Eigen::Vector3d& origin :
       {Eigen::Vector3d(0.1, 0.2, 3), Eigen::Vector3d(-0.6, 0.5, 2),
        Eigen::Vector3d(0.9, 0, 2)}) {
    const Ray unit{origin, Eigen::Vector3d(0, 0, -1)};
    const Ray moved{center + radius * origin, unit.direction};
    SurfaceHit expected{}, hit{};
    const bool hits = Scene::UnitSphere().Intersect(unit, false, &expected);
    ASSERT_EQ(hits, scene.Intersect(moved, false, &hit));
    if (!hits) continue;
    EXPECT_LT((expected.normal - hit.normal).norm(), 1e-12);
    EXPECT_NEAR(radius * expected.distance, hit.distance, 1e-12);
    EXPECT_LT((center + radius * expected.position - hit.position).norm(),
              1e-12);
  }
}

TEST(Scene, MaskChoosesPixels) {
  Mask one(9, 9, 0);
  one.inside[4 * 9 + 5] = 1;
  const auto points =
      FindShadingPoints(Scene::UnitSphere(), Camera(), 9, 9, one, 1);
  ASSERT_TRUE(points.ok());
  ASSERT_EQ(1u, points->size());
  EXPECT_EQ(4 * 9 + 5, points->front().pixel);
  EXPECT_FALSE(
      FindShadingPoints(Scene::UnitSphere(), Camera(), 8, 9, one, 1).ok());
  EXPECT_FALSE(
      FindShadingPoints(Scene::UnitSphere(), Camera(), 9, 9, Mask(9, 9, 0), 1)
          .ok());
}

TEST(Scene, RefusesBadMeshes) {
  TriangleMesh mesh = SphereMesh(4, 8);
  EXPECT_TRUE(Scene::FromMesh(mesh).ok());
  TriangleMesh bad = mesh;
  bad.triangles[3][1] = 1000;
  EXPECT_FALSE(Scene::FromMesh(bad).ok());
  bad = mesh;
  bad.vertices[12].x() = std::numeric_limits<float>::infinity();
  EXPECT_FALSE(Scene::FromMesh(bad).ok());
  bad = mesh;
  bad.normals.pop_back();
  EXPECT_FALSE(Scene::FromMesh(bad).ok());
  bad = mesh;
  bad.triangles = {{1, 1, 2}};
  EXPECT_FALSE(Scene::FromMesh(bad).ok());
}

TEST(Scene, RaysFromInsideAndPastTheSphere) {
  const Scene scene = Scene::UnitSphere();
  SurfaceHit hit{};
  EXPECT_FALSE(scene.Intersect({{0, 0, 3}, {0, 0, 1}}, false, &hit));
  EXPECT_FALSE(scene.Intersect({{0, 1.01, 3}, {0, 0, -1}}, false, &hit));
  ASSERT_TRUE(scene.Intersect({{0, 0, 3}, {0, 0, -1}}, false, &hit));
  EXPECT_NEAR(2.0, hit.distance, 1e-12);
  ASSERT_TRUE(scene.Intersect({{0, 0, 0}, {1, 0, 0}}, false, &hit));
  EXPECT_NEAR(1.0, hit.distance, 1e-12);
  EXPECT_GT(hit.normal.dot(Eigen::Vector3d(-1, 0, 0)), 0.0);
}

}  // namespace
}  // namespace ibrdf
