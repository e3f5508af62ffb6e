#include "ibrdf/render/reference_renderer.h"

#include <gtest/gtest.h>

#include <cmath>

#include "tests/support/render_testing.h"

namespace ibrdf {
namespace {
using namespace testing;  // NOLINT

std::vector<ShadingPoint> Fan() {
  std::vector<ShadingPoint> points;
  for (const double degrees : {0.0, 20.0, 45.0, 65.0, 80.0}) {
    points.push_back(PointAt(degrees * kPi / 180, 0.4 + degrees));
  }
  return points;
}

TEST(ReferenceRenderer, WhiteFurnaceIsOne) {
  const std::vector<ShadingPoint> points = SpherePoints(12);
  std::vector<double> L_o(3 * points.size());
  ReferenceRenderer(ConstantMap(64, 128, 1.0f), {})
      .Render(points, Lambertian(1.0), L_o.data());
  for (const double e : L_o) EXPECT_NEAR(1.0, e, 1e-6);
}

TEST(ReferenceRenderer, LambertUnderACosineLobeMatchesTheClosedForm) {
  // L = max(u.w, 0) on albedo 1 with normal n = u: L_o = 1/pi int cos^2 = 2/3.
  // L = 1 + u.w: L_o = 1 + (2/3) n.u for any n.
  const int height = 128, width = 256;
  const Eigen::Vector3d u = Eigen::Vector3d(0.3, 0.5, 0.8).normalized();
  Image map(width, height);
  for (int r = 0; r < height; ++r) {
    for (int c = 0; c < width; ++c) {
      const double d = u.dot(MapDirection(r + 0.5, c + 0.5, height, width));
      map.At(c, r)[0] = static_cast<float>(std::max(d, 0.0));
      map.At(c, r)[1] = static_cast<float>(1.0 + d);
    }
  }
  std::vector<ShadingPoint> points = Fan();
  points.push_back(points[0]);
  points.back().normal = u.cast<float>();
  std::vector<double> L_o(3 * points.size());
  ReferenceOptions options;
  options.far_width = width;
  ReferenceRenderer(map, options).Render(points, Lambertian(1.0), L_o.data());
  // Midpoint rule on texels of 1.4 degrees.
  constexpr double kTolerance = 2e-4;
  EXPECT_NEAR(2.0 / 3.0, L_o[3 * (points.size() - 1)], kTolerance);
  for (size_t i = 0; i < points.size(); ++i) {
    const double cosine = points[i].normal.cast<double>().dot(u);
    EXPECT_NEAR(1.0 + cosine * 2.0 / 3.0, L_o[3 * i + 1], kTolerance);
  }
}

TEST(ReferenceRenderer, AgreesWithHalfVectorQuadratureOnASmoothMap) {
  const Image map = SmoothMap(64, 128);
  const std::vector<ShadingPoint> points = Fan();
  const ReferenceRenderer renderer(map, {});
  for (const BrdfFunction& brdf :
       {Lambertian(0.7), Glossy(0.1, 0.5, 10), Glossy(0.02, 0.5, 2)}) {
    std::vector<double> L_o(3 * points.size());
    renderer.Render(points, brdf, L_o.data());
    for (size_t i = 0; i < points.size(); ++i) {
      const Eigen::Array3d slow =
          BruteForceRadiance(points[i], brdf, map, 240, 360);
      // Cells of 2.8 degrees against texel interpolation: second order in the
      // cell, (2.8 degrees)^2 = 0.24 % times curvatures of order one.
      for (int c = 0; c < 3; ++c) {
        EXPECT_NEAR(1.0, L_o[3 * i + c] / slow[c], 4e-3) << i << " " << c;
      }
    }
  }
}

TEST(ReferenceRenderer, AgreesWithHalfVectorQuadratureUnderAOneTexelSun) {
  Image map = ConstantMap(64, 128, 0.05f);
  // Beside the mirror direction of some points and far from that of others.
  for (int c = 0; c < 3; ++c) map.At(10, 20)[c] = 1e4f;
  const std::vector<ShadingPoint> points = Fan();
  const ReferenceRenderer renderer(map, {});
  for (const BrdfFunction& brdf : {Lambertian(0.7), Glossy(0.1, 0.5, 10)}) {
    std::vector<double> L_o(3 * points.size());
    renderer.Render(points, brdf, L_o.data());
    for (size_t i = 0; i < points.size(); ++i) {
      const Eigen::Array3d slow =
          BruteForceRadiance(points[i], brdf, map, 600, 1200);
      // The far rule has the sun as a point of the texel's solid angle, the
      // slow one as the bilinear hat around it, 2.8 degrees to its edges.
      for (int c = 0; c < 3; ++c) {
        EXPECT_NEAR(1.0, L_o[3 * i + c] / slow[c], 0.02) << i << " " << c;
      }
    }
  }
}

TEST(ReferenceRenderer, TableAndCallableAgree) {
  const BrdfFunction brdf = Glossy(0.1, 0.5, 8);
  MerlTable table;
  table.raw.resize(size_t{3} * kMerlBins);
  for (int i = 0; i < kMerlThetaH; ++i) {
    for (int j = 0; j < kMerlThetaD; ++j) {
      for (int k = 0; k < kMerlPhiD; ++k) {
        const Eigen::Array3d f =
            brdf(MerlThetaH(i), MerlThetaD(j), MerlPhiD(k));
        for (int c = 0; c < 3; ++c) {
          table.raw[static_cast<size_t>(c) * kMerlBins +
                    MerlTable::Bin(i, j, k)] =
              MerlBinAboveHorizon(i, j, k) ? f[c] / kMerlScale[c] : -1.0;
        }
      }
    }
  }
  const std::vector<ShadingPoint> points = Fan();
  const ReferenceRenderer renderer(SmoothMap(32, 64), {});
  std::vector<double> fast(3 * points.size()), slow(3 * points.size());
  renderer.Render(points, table, fast.data());
  renderer.Render(
      points,
      [&](double h, double d, double p) {
        return InterpolateMerl(table, h, d, p);
      },
      slow.data());
  // Float against double lookups.
  for (size_t i = 0; i < fast.size(); ++i) {
    EXPECT_NEAR(1.0, fast[i] / slow[i], 1e-5);
  }
}

TEST(ReferenceRenderer, RulesAddUpToBoth) {
  // With a sun that is split off, so that all parts are there.
  Image map = SmoothMap(32, 64);
  for (int c = 0; c < 3; ++c) map.At(20, 8)[c] = 3000.0f;
  const ReferenceRenderer renderer(map, {});
  const BrdfFunction brdf = Glossy(0.1, 0.5, 8);
  const std::vector<ShadingPoint> points = Fan();
  std::vector<double> both(3 * points.size()), near(both), far(both);
  renderer.Render(points, brdf, both.data());
  renderer.Render(points, brdf, near.data(), {}, QuadratureRules::kNear);
  renderer.Render(points, brdf, far.data(), {}, QuadratureRules::kFar);
  for (size_t k = 0; k < both.size(); ++k) {
    EXPECT_GT(near[k], 0.0);
    EXPECT_GT(far[k], 0.0);
    EXPECT_NEAR(both[k], near[k] + far[k], 1e-12 * both[k]);
  }
}

TEST(ReferenceRenderer, BlocksOfAWideMapAgreeWithItsTexels) {
  Image map = RandomMap(128, 256, 7);
  map.At(70, 40)[1] = 1e5f;
  const std::vector<ShadingPoint> points = Fan();
  ReferenceOptions coarse, fine;
  coarse.far_width = 64;
  fine.far_width = 256;
  std::vector<double> a(3 * points.size()), b(3 * points.size());
  const BrdfFunction brdf = Glossy(0.1, 0.5, 6);
  ReferenceRenderer(map, coarse).Render(points, brdf, a.data());
  ReferenceRenderer(map, fine).Render(points, brdf, b.data());
  // White noise at texel scale in 4x4 blocks taken at their centroids.
  for (size_t i = 0; i < a.size(); ++i) EXPECT_NEAR(1.0, a[i] / b[i], 5e-3);
}

TEST(ReferenceRenderer, PixelMeansWeighByCoverage) {
  std::vector<ShadingPoint> points(3, PointAt(0, 0));
  points[1].pixel = points[2].pixel = 2;
  points[2].coverage = 0.5f;
  const double L_o[] = {1, 2, 3, 3, 3, 3, 6, 6, 6};
  const Image image = PixelMeans(points, L_o, 2, 2);
  EXPECT_FLOAT_EQ(2.0f, image.At(0, 0)[1]);
  EXPECT_FLOAT_EQ(4.0f, image.At(0, 1)[0]);
  EXPECT_FLOAT_EQ(0.0f, image.At(1, 1)[2]);
}

}  // namespace
}  // namespace ibrdf
