#include "ibrdf/solvers/report/brdf_sphere.h"

#include <gtest/gtest.h>

#include <Eigen/Geometry>
#include <algorithm>
#include <cmath>

#include "ibrdf/base/pi.h"
#include "ibrdf/brdf/cook_torrance.h"
#include "ibrdf/geometry/camera.h"
#include "ibrdf/light/environment_map.h"
#include "ibrdf/render/reference_renderer.h"
#include "ibrdf/scene/scene.h"

namespace ibrdf {
namespace {

// Normals and pixels are float.
constexpr double kFloatTolerance = 2e-6;
// The quadrature under a map is coarse by intent.
constexpr double kQuadratureTolerance = 5e-3;

const Eigen::Array3d kAlbedo(0.8, 0.5, 0.2);

Eigen::Array3d Lambertian(double, double, double) { return kAlbedo / kPi; }

// Normal of the sphere at a pixel's centre; false outside.
bool NormalAt(int x, int y, int size, Eigen::Vector3d* n) {
  const double u = 2.0 * (x + 0.5) / size - 1.0;
  const double v = 1.0 - 2.0 * (y + 0.5) / size;
  if (u * u + v * v >= 1.0) return false;
  *n = Eigen::Vector3d(u, v, std::sqrt(1.0 - u * u - v * v));
  return true;
}

TEST(BrdfSphere, LambertianIsAlbedoTimesTheCosinesOfItsLights) {
  const std::vector<DirectionalLight> lights = {
      {{-1.0, 2.0, 2.0}, Eigen::Array3d(kPi, kPi, kPi)},
      {{3.0, 0.0, -4.0}, Eigen::Array3d(1.0, 2.0, 3.0)}};
  const int size = 33;
  const Image image = RenderBrdfSphere(Lambertian, lights, size, 1);
  const Mask mask = BrdfSphereMask(size);
  int inside = 0;
  for (int y = 0; y < size; ++y) {
    for (int x = 0; x < size; ++x) {
      Eigen::Vector3d n = Eigen::Vector3d::Zero();
      const bool hit = NormalAt(x, y, size, &n);
      EXPECT_EQ(mask.inside[y * size + x] != 0, hit) << x << ' ' << y;
      Eigen::Array3d expected = Eigen::Array3d::Zero();
      if (hit) {
        ++inside;
        for (const DirectionalLight& light : lights) {
          expected += kAlbedo / kPi * light.irradiance *
                      std::max(n.dot(light.direction.normalized()), 0.0);
        }
      }
      for (int c = 0; c < 3; ++c) {
        EXPECT_NEAR(image.At(x, y)[c], expected[c], kFloatTolerance)
            << x << ' ' << y;
      }
    }
  }
  EXPECT_GT(inside, 700);
}

// A BRDF that is 1 in a narrow cone of half-vectors: its highlight must be
// where the normal halves light and viewer.
TEST(BrdfSphere, HighlightIsAtTheHalfVector) {
  const BrdfFunction glossy = [](double theta_h, double, double) {
    return Eigen::Array3d::Constant(theta_h < 0.1 ? 1.0 : 0.0).eval();
  };
  const Eigen::Vector3d light = Eigen::Vector3d(-1.0, 1.0, 1.0).normalized();
  const int size = 64;
  const Image image =
      RenderBrdfSphere(glossy, {{light, Eigen::Array3d::Ones()}}, size, 1);
  const Eigen::Vector3d half = (light + Eigen::Vector3d::UnitZ()).normalized();
  int lit = 0;
  for (int y = 0; y < size; ++y) {
    for (int x = 0; x < size; ++x) {
      Eigen::Vector3d n = Eigen::Vector3d::Zero();
      if (!NormalAt(x, y, size, &n)) continue;
      const double angle = std::acos(std::min(n.dot(half), 1.0));
      if (std::fabs(angle - 0.1) < 1e-4) continue;  // float normals decide
      EXPECT_EQ(image.At(x, y)[0] > 0.0f, angle < 0.1) << x << ' ' << y;
      lit += angle < 0.1;
    }
  }
  EXPECT_GT(lit, 10);
}

TEST(BrdfSphere, ConstantMapShowsTheAlbedo) {
  Image map(32, 16);
  std::fill(map.rgb.begin(), map.rgb.end(), 2.0f);
  const int size = 24;
  MerlTable table;
  for (int c = 0; c < 3; ++c) {
    table.raw.insert(table.raw.end(), kMerlBins,
                     kAlbedo[c] / kPi / kMerlScale[c]);
  }
  const Image image = RenderBrdfSpheres(
      {BrdfGrid::FromMerl(table, BrdfGridShape())}, map, size)[0];
  const Mask mask = BrdfSphereMask(size);
  for (size_t i = 0; i < mask.inside.size(); ++i) {
    for (int c = 0; c < 3; ++c) {
      EXPECT_NEAR(image.rgb[3 * i + c], mask.inside[i] ? 2.0 * kAlbedo[c] : 0.0,
                  kQuadratureTolerance);
    }
  }
}

// Against the slow renderer under the report's own sky: matte, glossy and a
// mirror of some degrees, the sun in each.
TEST(BrdfSphere, ShowsTheSkyAsTheReferenceDoes) {
  const Image sky = ProceduralSky(64, 128);
  const int size = 40;
  const std::vector<ShadingPoint> points =
      *FindShadingPoints(Scene::UnitSphere(), Camera(), size, size, Mask(), 1);
  for (const double roughness : {0.5, 0.2, 0.05}) {
    CookTorrance brdf;
    brdf.roughness.setConstant(roughness);
    brdf.f0.setConstant(0.5);
    const Image image = RenderBrdfSpheres(
        {BrdfGrid::FromFunction(brdf.Function(), BrdfGridShape())}, sky,
        size)[0];
    std::vector<double> L_o(3 * points.size());
    ReferenceRenderer(sky, {}).Render(points, brdf.Function(), L_o.data());
    const Image reference = PixelMeans(points, L_o.data(), size, size);
    double sum = 0.0, largest = 0.0;
    int count = 0;
    for (size_t i = 0; i < image.rgb.size(); ++i) {
      // At the limb the grid is off, not the sky.
      const int pixel = static_cast<int>(i / 3);
      Eigen::Vector3d n = Eigen::Vector3d::Zero();
      if (!NormalAt(pixel % size, pixel / size, size, &n) ||
          n.head<2>().norm() > 0.97) {
        continue;
      }
      const double d = std::abs(std::log(image.rgb[i] / reference.rgb[i]));
      sum += d;
      largest = std::max(largest, d);
      ++count;
    }
    EXPECT_GT(count, 3000);
    EXPECT_LT(sum / count, 0.02) << roughness;
    EXPECT_LT(largest, 0.2) << roughness;
  }
}

TEST(ProceduralSky, IsFinitePositiveAndBrightestInTheSun) {
  const Image map = ProceduralSky(64, 128);
  float largest = 0.0f;
  int at = 0;
  for (int i = 0; i < static_cast<int>(map.rgb.size()); ++i) {
    ASSERT_TRUE(std::isfinite(map.rgb[i]) && map.rgb[i] > 0.0f);
    if (map.rgb[i] > largest) {
      largest = map.rgb[i];
      at = i / 3;
    }
  }
  const Eigen::Vector3d brightest =
      MapDirection(at / 128 + 0.5, at % 128 + 0.5, 64, 128);
  EXPECT_GT(brightest.dot(Eigen::Vector3d(-0.55, 0.6, 0.6).normalized()), 0.99);
}

}  // namespace
}  // namespace ibrdf
