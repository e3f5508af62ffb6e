#include "ibrdf/solvers/report/sphere_lookup.h"

#include <gtest/gtest.h>

#include <cmath>

#include "ibrdf/geometry/camera.h"
#include "ibrdf/solvers/report/brdf_sphere.h"

namespace ibrdf {
namespace {

// Radiance (2 + x, 2 + y, 1) of the normal (x, y, z), linear in what is looked
// up between pixels.
Image LinearSphere(int size) {
  Image sphere(size, size);
  for (int y = 0; y < size; ++y) {
    for (int x = 0; x < size; ++x) {
      const double right = 2.0 * (x + 0.5) / size - 1.0;
      const double up = 1.0 - 2.0 * (y + 0.5) / size;
      if (right * right + up * up >= 1.0) continue;
      sphere.At(x, y)[0] = static_cast<float>(2.0 + right);
      sphere.At(x, y)[1] = static_cast<float>(2.0 + up);
      sphere.At(x, y)[2] = 1.0f;
    }
  }
  return sphere;
}

TEST(SphereLookup, IsLinearInsideAndNearAtTheEdge) {
  const Image sphere = LinearSphere(32);
  const SphereLookup lookup(sphere);
  for (int k = 0; k < 360; ++k) {
    const double angle = k * 0.01745329252;
    for (const double radius : {0.0, 0.3, 0.8, 0.99, 1.0}) {
      const double right = radius * std::cos(angle);
      const double up = radius * std::sin(angle);
      const Eigen::Array3f L_o = lookup.At(right, up);
      const double tolerance = radius < 0.9 ? 1e-5 : 3.0 * 2.0 / 32;
      EXPECT_NEAR(L_o[0], 2.0 + right, tolerance) << k << ' ' << radius;
      EXPECT_NEAR(L_o[1], 2.0 + up, tolerance) << k << ' ' << radius;
      EXPECT_NEAR(L_o[2], 1.0, 1e-6);  // no background at the edge
    }
  }
}

TEST(ResizeSphere, FillsTheDiscOfItsSize) {
  const Image large = ResizeSphere(LinearSphere(32), 100);
  const Mask mask = BrdfSphereMask(100);
  for (size_t i = 0; i < mask.inside.size(); ++i) {
    EXPECT_NEAR(large.rgb[3 * i + 2], mask.inside[i] ? 1.0 : 0.0, 1e-6) << i;
  }
}

// A sphere relit is the sphere.
TEST(RelitObject, LooksUpTheNormalsOfThePoints) {
  const int size = 20;
  const auto points =
      FindShadingPoints(Scene::UnitSphere(), Camera(), size, size, Mask(), 1);
  ASSERT_TRUE(points.ok());
  const Image relit = RelitObject(LinearSphere(64), *points, size, size);
  for (const ShadingPoint& point : *points) {
    const float* const L_o = &relit.rgb[size_t{3} * point.pixel];
    EXPECT_NEAR(L_o[0], 2.0f + point.normal.x(), 0.05f);
    EXPECT_NEAR(L_o[1], 2.0f + point.normal.y(), 0.05f);
  }
}

}  // namespace
}  // namespace ibrdf
