#include "ibrdf/solvers/problem/depth_normals.h"

#include <gtest/gtest.h>

#include <Eigen/Core>
#include <algorithm>
#include <cmath>
#include <limits>
#include <random>

#include "ibrdf/scene/scene.h"

namespace ibrdf {
namespace {

constexpr double kHole = std::numeric_limits<double>::quiet_NaN();

Camera Perspective() {
  Camera camera;
  camera.type = CameraType::kPerspective;
  camera.fov_degrees = 50;
  camera.from = Eigen::Vector3d::Zero();
  camera.to = -Eigen::Vector3d::UnitZ();
  return camera;
}

Eigen::Vector3d At(const Image& normals, int x, int y) {
  return Eigen::Map<const Eigen::Vector3f>(normals.At(x, y)).cast<double>();
}

// Depth of the plane n . p = offset, in the camera's frame, positions of pixels
// in their sides before an orthographic camera.
DepthMap Plane(int width, int height, const Camera& camera,
               const Eigen::Vector3d& n, double offset) {
  DepthMap map{width, height, {}};
  for (int y = 0; y < height; ++y) {
    for (int x = 0; x < width; ++x) {
      if (camera.type == CameraType::kPerspective) {
        const Eigen::Vector3d d =
            CameraRay(camera, x + 0.5, y + 0.5, width, height).direction;
        map.depth.push_back(-offset / n.dot(d) * d.z());
      } else {
        const double px = x + 0.5 - 0.5 * width, py = 0.5 * height - y - 0.5;
        map.depth.push_back(-(offset - n.x() * px - n.y() * py) / n.z());
      }
    }
  }
  return map;
}

TEST(DepthNormals, APlaneHasItsNormalEverywhere) {
  const Eigen::Vector3d normal = Eigen::Vector3d(0.3, -0.5, 0.8).normalized();
  for (const Camera& camera : {Camera(), Perspective()}) {
    const double offset = camera.type == CameraType::kPerspective ? -3 : 7;
    const DepthNormals found =
        NormalsOfDepth(Plane(31, 20, camera, normal, offset), camera);
    EXPECT_EQ(620u, found.known);
    EXPECT_EQ(0u, found.isolated);
    for (int y = 0; y < 20; ++y) {
      for (int x = 0; x < 31; ++x) {
        ASSERT_LT((At(found.normals, x, y) - normal).norm(), 1e-6);
      }
    }
  }
}

// Depth of a sphere; radius and centre in the camera's frame.
DepthMap SphereDepth(int size, const Camera& camera,
                     const Eigen::Vector3d& center, double radius,
                     Image* normals) {
  DepthMap map{size, size, {}};
  *normals = Image(size, size);
  const Scene scene = Scene::Sphere(center, radius);
  const double side = 2.0 / size;  // of a pixel, orthographic
  for (int y = 0; y < size; ++y) {
    for (int x = 0; x < size; ++x) {
      const Ray ray = CameraRay(camera, x + 0.5, y + 0.5, size, size);
      const bool perspective = camera.type == CameraType::kPerspective;
      SurfaceHit hit{};
      map.depth.push_back(kHole);
      if (!scene.Intersect(ray, !perspective, &hit)) continue;
      const double z = (ray.origin + hit.distance * ray.direction).z();
      map.depth.back() = perspective ? -z : -z / side;
      Eigen::Map<Eigen::Vector3f>(normals->At(x, y)) = hit.normal.cast<float>();
    }
  }
  return map;
}

TEST(DepthNormals, ASpheresAreItsOwn) {
  const int size = 200;
  struct {
    Camera camera;
    Eigen::Vector3d center;
    double radius;
  } const cases[] = {{Camera(), {0.1, -0.05, 0}, 0.8},
                     {Perspective(), {0.2, -0.1, -3}, 1.0}};
  for (const auto& c : cases) {
    Image truth;
    const DepthNormals found = NormalsOfDepth(
        SphereDepth(size, c.camera, c.center, c.radius, &truth), c.camera);
    size_t checked = 0;
    for (int y = 0; y < size; ++y) {
      for (int x = 0; x < size; ++x) {
        const Eigen::Vector3d expected = At(truth, x, y);
        const Ray ray = CameraRay(c.camera, x + 0.5, y + 0.5, size, size);
        const double cosine = -expected.dot(ray.direction);
        if (cosine < 0.3) continue;  // a pixel is wide at the limb
        ++checked;
        // Second differences: the curvature over a pixel, squared.
        ASSERT_LT((At(found.normals, x, y) - expected).norm(), 5e-3)
            << x << " " << y << " " << cosine;
      }
    }
    EXPECT_GT(checked, 5000u);
  }
}

TEST(DepthNormals, FacesTheCameraAtTheLimbToo) {
  Image truth;
  const DepthNormals found = NormalsOfDepth(
      SphereDepth(60, Camera(), {0, 0, 0}, 0.9, &truth), Camera());
  double worst = 0.0;
  for (int y = 0; y < 60; ++y) {
    for (int x = 0; x < 60; ++x) {
      const Eigen::Vector3d n = At(found.normals, x, y);
      if (n.isZero()) continue;
      EXPECT_GT(n.z(), 0.0);
      worst = std::max(worst, (n - At(truth, x, y)).norm());
    }
  }
  EXPECT_LT(worst, 0.45);  // one-sided differences where the limb is a pixel
}

TEST(DepthNormals, NothingIsBlendedOverAJump) {
  // Two planes of other depth and slope meet between columns 9 and 10.
  DepthMap map{20, 12, {}};
  for (int i = 0; i < 240; ++i) {
    const int x = i % 20;
    map.depth.push_back(x < 10 ? 5.0 + 0.2 * x : 80.0 - 0.5 * x);
  }
  const DepthNormals found = NormalsOfDepth(map, Camera());
  const Eigen::Vector3d left = Eigen::Vector3d(0.2, 0, 1).normalized();
  const Eigen::Vector3d right = Eigen::Vector3d(-0.5, 0, 1).normalized();
  for (int y = 0; y < 12; ++y) {
    for (int x = 0; x < 20; ++x) {
      ASSERT_LT((At(found.normals, x, y) - (x < 10 ? left : right)).norm(),
                1e-6)
          << x;
    }
  }
}

TEST(DepthNormals, HolesHaveNoneAndIsolatedPixelsAreCounted) {
  DepthMap map = Plane(9, 9, Camera(), {0, 0, 1}, -4);
  map.depth[4 * 9 + 4] = kHole;
  for (int x = 0; x < 9; ++x) map.depth[7 * 9 + x] = kHole;  // cuts row 8 off
  const DepthNormals found = NormalsOfDepth(map, Camera());
  EXPECT_EQ(81u - 10u, found.known);
  EXPECT_EQ(9u, found.isolated);
  EXPECT_TRUE(At(found.normals, 4, 4).isZero());
  EXPECT_TRUE(At(found.normals, 3, 8).isZero());
  EXPECT_NEAR(1.0, At(found.normals, 3, 4).z(), 1e-6);
  EXPECT_NEAR(1.0, At(found.normals, 4, 5).z(), 1e-6);
}

TEST(DepthNormals, NoiseTurnsThemByItsSlopes) {
  const double sigma = 0.05;  // of a pixel
  DepthMap map = Plane(100, 100, Camera(), {0, 0, 1}, -4);
  std::mt19937 random(1);
  std::normal_distribution<double> noise(0.0, sigma);
  for (double& d : map.depth) d += noise(random);
  const DepthNormals found = NormalsOfDepth(map, Camera());
  double squares = 0.0;
  for (int y = 1; y < 99; ++y) {
    for (int x = 1; x < 99; ++x) {
      squares += At(found.normals, x, y).head<2>().squaredNorm();
    }
  }
  // A slope is a difference over two pixels: variance sigma^2 / 2, twice.
  EXPECT_NEAR(sigma, std::sqrt(squares / (98 * 98)), 0.02 * sigma + 5e-4);
}

TEST(DepthNormals, HeightsAreNegativeDepths) {
  // Heights that rise to the right face left.
  DepthMap map{4, 3, {}};
  for (int i = 0; i < 12; ++i) map.depth.push_back(-1.0 * (i % 4));
  const Eigen::Vector3d n = At(NormalsOfDepth(map, Camera()).normals, 1, 1);
  EXPECT_LT((n - Eigen::Vector3d(-1, 0, 1).normalized()).norm(), 1e-6);
}

}  // namespace
}  // namespace ibrdf
