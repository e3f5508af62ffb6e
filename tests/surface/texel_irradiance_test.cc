#include "ibrdf/surface/texel_irradiance.h"

#include <gtest/gtest.h>

#include <cmath>
#include <vector>

#include "ibrdf/base/pi.h"
#include "ibrdf/light/environment_map.h"
#include "tests/support/shapes.h"

namespace ibrdf {
namespace {

// A bright patch of 16 degrees over a gradient.
Image PatchedMap() {
  Image map(128, 64);
  const Eigen::Vector3d lamp = Eigen::Vector3d(0.5, 0.7, 0.4).normalized();
  for (int y = 0; y < 64; ++y) {
    for (int x = 0; x < 128; ++x) {
      const Eigen::Vector3d d = MapDirection(y + 0.5, x + 0.5, 64, 128);
      const double bright = d.dot(lamp) > std::cos(kPi / 22.5) ? 20.0 : 0.0;
      Eigen::Map<Eigen::Array3f>(map.At(x, y)) =
          (1.2 + d.array() + bright).cast<float>();
    }
  }
  return map;
}

// The integral over all texels of the map that are not hidden.
Eigen::Array3d PlainIrradiance(const Scene& scene, const Image& map,
                               const Eigen::Vector3d& position,
                               const Eigen::Vector3d& normal, bool shadowed) {
  Eigen::Array3d E = Eigen::Array3d::Zero();
  for (int y = 0; y < map.height; ++y) {
    for (int x = 0; x < map.width; ++x) {
      const Eigen::Vector3d d =
          MapDirection(y + 0.5, x + 0.5, map.height, map.width);
      const double cosine = normal.dot(d);
      if (cosine <= 0.0 || (shadowed && scene.Occluded(position, d))) continue;
      E += cosine * TexelSolidAngle(y, map.height, map.width) *
           Eigen::Map<const Eigen::Array3f>(map.At(x, y)).cast<double>();
    }
  }
  return E;
}

TEST(TexelIrradiance, IsTheIntegralWhereNothingIsHidden) {
  constexpr double kHarmonics = 0.01;
  const Image map = PatchedMap();
  const TexelIrradiance irradiance(Scene::UnitSphere(), map, true);
  double largest = 0.0;
  for (const Eigen::Vector3d& n :
       {Eigen::Vector3d(0, 1, 0), Eigen::Vector3d(1, 0, 0),
        Eigen::Vector3d(-0.6, 0, 0.8), Eigen::Vector3d(0.5, 0.7, 0.4)}) {
    const Eigen::Vector3d normal = n.normalized();
    const Eigen::Array3d plain =
        PlainIrradiance(Scene::UnitSphere(), map, normal, normal, false);
    const Eigen::Array3d E = irradiance.At(normal, normal);
    largest = std::max(largest, plain.maxCoeff());
    EXPECT_LT(((E - plain) / plain).abs().maxCoeff(), kHarmonics) << n;
  }
  EXPECT_GT(largest, kPi);
}

TEST(TexelIrradiance, OfConstantLightIsPi) {
  Image map(32, 16);
  for (float& x : map.rgb) x = 1.0f;
  const TexelIrradiance irradiance(Scene::UnitSphere(), map, false);
  const Eigen::Vector3d n = Eigen::Vector3d(0.3, -0.5, 0.8).normalized();
  EXPECT_LT((irradiance.At(n, n) - kPi).abs().maxCoeff(), 1e-6);
}

// In the hole of a torus much is hidden.
TEST(TexelIrradiance, LeavesOutWhatTheSurfaceHides) {
  const TriangleMesh mesh = TorusMesh(96, 48, 0.7, 0.3);
  const Scene scene = Scene::FromMesh(mesh).value();
  const Image map = PatchedMap();
  const TexelIrradiance open(scene, map, false), shadowed(scene, map, true);
  double error = 0.0, without = 0.0;
  int count = 0;
  for (size_t i = 0; i < mesh.vertices.size(); i += 97) {
    const Eigen::Vector3d n = mesh.normals[i].cast<double>();
    const Eigen::Vector3d p = mesh.vertices[i].cast<double>() + 3e-3 * n;
    const Eigen::Array3d plain = PlainIrradiance(scene, map, p, n, true);
    error += ((shadowed.At(p, n) - plain) / plain).abs().mean();
    without += ((open.At(p, n) - plain) / plain).abs().mean();
    ++count;
  }
  ASSERT_GT(count, 40);
  EXPECT_GT(without / count, 0.09);
  EXPECT_LT(error / count, 0.02);
}

}  // namespace
}  // namespace ibrdf
