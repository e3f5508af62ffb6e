#include "ibrdf/visibility/visibility.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <memory>
#include <random>
#include <vector>

#include "ibrdf/transport/transport.h"
#include "tests/support/render_testing.h"
#include "tests/support/shadow_testing.h"

namespace ibrdf {
namespace {
using namespace testing;  // NOLINT

// Points from which something is hidden.
int NumShadowed(const Visibility& visibility,
                const std::vector<ShadingPoint>& points) {
  return static_cast<int>(std::count_if(
      points.begin(), points.end(),
      [&](const ShadingPoint& p) { return visibility.Hidden(p) != nullptr; }));
}

// Shares of a hemisphere from a grid of 1.4 degrees: an edge of the shadow
// passes up to half a step beside the true one, by chance to either side.
constexpr double kGridEdge = 4e-3;

// Cosine-weighted share of the hemisphere that a point sees.
double SkyShare(const Scene& scene, const ShadingPoint& point) {
  const Visibility visibility(scene, {point}, {});
  const uint64_t* hidden = visibility.Hidden(point);
  if (hidden == nullptr) return 1.0;
  const Eigen::Vector3d n = point.normal.cast<double>();
  const int rows = visibility.grid().rows();
  double all = 0.0, seen = 0.0;
  for (int r = 0; r < rows; ++r) {
    for (int c = 0; c < 2 * rows; ++c) {
      const double weight =
          TexelSolidAngle(r, rows, 2 * rows) *
          std::max(n.dot(MapDirection(r + 0.5, c + 0.5, rows, 2 * rows)), 0.0);
      all += weight;
      seen += weight *
              visibility.grid().VisibleShare(hidden, n, {r, r + 1, c, c + 1});
    }
  }
  return seen / all;
}

ShadingPoint FloorPoint(double x, double y, double z) {
  ShadingPoint p = PointAt(0.0, 0.0);
  p.position = {x, y, z};
  return p;
}

// Constant light from a wall's side is lost: a wall of height h and endless
// width at distance d hides (1 - d / sqrt(d^2 + h^2)) / 2 of a floor's light.
TEST(Visibility, PointBesideAWallSeesTheKnownShare) {
  for (const double height : {0.3, 1.0, 3.0}) {
    TriangleMesh mesh;
    AddQuad({{0, -500, 0}, {0, 500, 0}, {0, 500, height}, {0, -500, height}},
            &mesh);
    const Scene scene = Scene::FromMesh(mesh).value();
    const double expected = 0.5 + 0.5 / std::sqrt(1.0 + height * height);
    EXPECT_NEAR(expected, SkyShare(scene, FloorPoint(1, 0, 0)), kGridEdge);
    EXPECT_NEAR(expected, SkyShare(scene, FloorPoint(-1, 0, 0)), kGridEdge);
  }
}

// A side of a V-groove of half-angle a, endless both ways: a point of it sees
// (1 + cos(opening)) / 2 less than all: the opposite side hides all within the
// opening 2 a of its own plane, (1 + cos(2 a)) / 2.
TEST(Visibility, PointInAVGrooveSeesTheKnownShare) {
  for (const double degrees : {25.0, 45.0, 60.0}) {
    const double a = degrees * kPi / 180;
    TriangleMesh mesh;
    const double x = 2e3 * std::sin(a), z = 2e3 * std::cos(a);
    AddQuad({{0, -2e3, 0}, {0, 2e3, 0}, {x, 2e3, z}, {x, -2e3, z}}, &mesh);
    AddQuad({{0, -2e3, 0}, {0, 2e3, 0}, {-x, 2e3, z}, {-x, -2e3, z}}, &mesh);
    ShadingPoint p{};
    p.normal = Eigen::Vector3f(static_cast<float>(-std::cos(a)), 0,
                               static_cast<float>(std::sin(a)));
    p.position = Eigen::Vector3d(std::sin(a), 0, std::cos(a)) +
                 0.02 * p.normal.cast<double>();
    EXPECT_NEAR(0.5 * (1 - std::cos(2 * a)),
                SkyShare(Scene::FromMesh(mesh).value(), p), kGridEdge)
        << degrees;
  }
}

// A disc of radius r at height h above a floor point hides r^2 / (r^2 + h^2).
TEST(Visibility, DiscHidesTheKnownShare) {
  for (const double radius : {0.2, 0.5, 2.0}) {
    TriangleMesh mesh;
    AddDisc({0, 0, 1}, radius, 256, &mesh);
    const double expected = 1.0 / (1.0 + radius * radius);
    EXPECT_NEAR(expected,
                SkyShare(Scene::FromMesh(mesh).value(), FloorPoint(0, 0, 0)),
                kGridEdge);
  }
}

TEST(Visibility, ShadowedTransportOfAPlaneUnderADiscIsTheClosedForm) {
  TriangleMesh mesh;
  AddDisc({0, 0, 1}, 0.5, 256, &mesh);
  const std::vector<ShadingPoint> points = {FloorPoint(0, 0, 0)};
  TransportOptions options;
  options.visibility = std::make_shared<Visibility>(
      Scene::FromMesh(mesh).value(), points, VisibilityOptions());
  const BrdfGrid white = BrdfGrid::FromFunction(Lambertian(1), options.grid);
  for (const int height : {16, 32, 64, 128}) {
    const Image map = ConstantMap(height, 2 * height, 1.0f);
    double L_o[3];
    Transport(points, height, 2 * height, options)
        .Render(white, map.rgb.data(), L_o);
    // The edge is concentric with the near rule's rings, which are 4 degrees of
    // light apart there, and each is in the light or not.
    EXPECT_NEAR(0.8, L_o[0], 0.008) << height;
  }
}

TEST(Visibility, ConvexObjectsAreUnshadowedBitForBit) {
  TransportOptions with, without;
  const std::vector<ShadingPoint> sphere = SpherePoints(12);
  auto visibility = std::make_shared<Visibility>(Scene::UnitSphere(), sphere,
                                                 VisibilityOptions());
  EXPECT_EQ(0, NumShadowed(*visibility, sphere));
  with.visibility = visibility;
  const Image map = RandomMap(64, 128, 3);
  const BrdfGrid glossy =
      BrdfGrid::FromFunction(Glossy(0.1, 0.5, 3), BrdfGridShape());
  std::vector<double> a(3 * sphere.size()), b(a.size());
  Transport(sphere, 64, 128, with).Render(glossy, map.rgb.data(), a.data());
  Transport(sphere, 64, 128, without).Render(glossy, map.rgb.data(), b.data());
  EXPECT_EQ(a, b);
}

// Interpolated normals on coarse facets: rays just above the shading horizon
// must not meet the next facet. Where the normal at the silhouette was turned
// to the viewer, the object itself is in the way, and that is right.
TEST(Visibility, FacetsOfASmoothSphereHideNothing) {
  for (const int rings : {12, 24, 96}) {
    const Scene scene = Scene::FromMesh(BallMesh(rings, 1.0)).value();
    auto points = FindShadingPoints(scene, Camera(), 24, 24, Mask(), 1).value();
    points.erase(std::remove_if(points.begin(), points.end(),
                                [](const ShadingPoint& p) {
                                  return p.normal.dot(p.wo) < 0.05f;
                                }),
                 points.end());
    ASSERT_GT(points.size(), 300u);
    const Visibility visibility(scene, points, {});
    EXPECT_EQ(0, NumShadowed(visibility, points)) << rings;
    EXPECT_GT(visibility.num_rays(), 0);
  }
}

TEST(Visibility, TorusMatchesARayForEveryDirection) {
  const Scene scene = Scene::FromMesh(UnitTorusMesh(48, 24)).value();
  const auto points =
      FindShadingPoints(scene, TorusCamera(), 14, 14, Mask(), 1).value();
  const Visibility visibility(scene, points, {});
  EXPECT_GT(NumShadowed(visibility, points),
            static_cast<int>(points.size()) / 3);
  EXPECT_LT(NumShadowed(visibility, points), static_cast<int>(points.size()));
  const int rows = visibility.grid().rows();
  int64_t differ = 0, above = 0, rays = 0;
  for (const ShadingPoint& p : points) {
    const Eigen::Vector3d n = p.normal.cast<double>().normalized();
    const uint64_t* hidden = visibility.Hidden(p);
    for (int r = 0; r < rows; ++r) {
      for (int c = 0; c < 2 * rows; ++c) {
        const Eigen::Vector3d d =
            MapDirection(r + 0.5, c + 0.5, rows, 2 * rows);
        if (n.dot(d) <= 0) continue;
        ++above;
        const bool bit =
            hidden != nullptr && visibility.grid().VisibleShare(
                                     hidden, n, {r, r + 1, c, c + 1}) < 0.5;
        if (bit != scene.Occluded(p.position, d)) ++differ;
        ++rays;
      }
    }
  }
  // Slivers between the lattice's directions.
  EXPECT_LT(differ, 2e-3 * above);
  EXPECT_LT(visibility.num_rays(), rays / 4);
}

TEST(Visibility, BilinearAndSharesAgreeWithTheirDefinition) {
  TriangleMesh mesh;
  AddQuad({{0, -500, 0}, {0, 500, 0}, {0, 500, 1}, {0, -500, 1}}, &mesh);
  const ShadingPoint p = FloorPoint(1, 0, 0);
  const Visibility v(Scene::FromMesh(mesh).value(), {p}, {});
  const uint64_t* hidden = v.Hidden(p);
  ASSERT_NE(nullptr, hidden);
  const Eigen::Vector3d n = p.normal.cast<double>();
  const int rows = v.grid().rows();
  int partial = 0;
  for (int r = 0; r < rows; ++r) {
    for (int c = 0; c < 2 * rows; ++c) {
      const Eigen::Vector3d d = MapDirection(r + 0.5, c + 0.5, rows, 2 * rows);
      if (n.dot(d) < 0.05) continue;
      // At a centre: the bit itself, and the wall's shadow.
      const double along = v.grid().VisibleAlong(hidden, n, d);
      const double share =
          v.grid().VisibleShare(hidden, n, {r, r + 1, c, c + 1});
      EXPECT_NEAR(share, along, 1e-6);
      const double margin = d.z() + d.x();  // < 0: below the wall's top
      if (d.x() < -1e-3 && std::abs(margin) > 0.05) {
        EXPECT_EQ(margin > 0 ? 1.0 : 0.0, share) << d.transpose();
      }
      const double between = v.grid().VisibleAlong(
          hidden, n, MapDirection(r + 0.8, c + 0.7, rows, 2 * rows));
      EXPECT_GE(between, 0.0);
      EXPECT_LE(between, 1.0);
      if (between > 0.0 && between < 1.0) ++partial;
    }
  }
  EXPECT_GT(partial, 20);
}

TEST(Visibility, SameBitsForAnyNumberOfThreadsAndAnySelection) {
  const Scene scene = Scene::FromMesh(UnitTorusMesh(32, 16)).value();
  const auto points =
      FindShadingPoints(scene, TorusCamera(), 20, 20, Mask(), 1).value();
  const Visibility one(scene, points, {64, 1}), three(scene, points, {64, 3});
  const std::vector<ShadingPoint> last(points.begin() + points.size() / 2,
                                       points.end());
  const Visibility some(scene, last, {64, 2});
  EXPECT_EQ(one.num_rays(), three.num_rays());
  EXPECT_GT(one.MemoryBytes(), size_t{100});
  const size_t words = one.grid().words();
  for (size_t i = 0; i < points.size(); ++i) {
    const uint64_t *a = one.Hidden(points[i]), *b = three.Hidden(points[i]);
    ASSERT_EQ(a == nullptr, b == nullptr);
    if (a != nullptr) {
      EXPECT_TRUE(std::equal(a, a + words, b));
    }
    if (i < points.size() / 2) continue;
    const uint64_t* c = some.Hidden(points[i]);
    ASSERT_EQ(a == nullptr, c == nullptr);
    if (a != nullptr) {
      EXPECT_TRUE(std::equal(a, a + words, c));
    }
  }
}

// The rule by which VisibilityGrid chooses its rays, depth first and ray by
// ray.
class PlainTrace {
 public:
  PlainTrace(const Scene& scene, const ShadingPoint& point, int rows)
      : scene_(scene), point_(point), rows_(rows), cast_(2 * rows * rows, -1) {
    bits.assign(size_t{2} * rows * rows / 64, 0);
    const int stride = rows / 32;
    for (int r = 0; r < rows; r += stride) {
      const int below = std::min(r + stride, rows - 1);
      for (int c = 0; c < 2 * rows && below > r; c += stride) {
        Refine(r, below, c, c + stride);
      }
    }
  }
  std::vector<uint64_t> bits;
  int64_t rays = 0;

 private:
  // 0: below the horizon, 1: visible, 2: hidden.
  int Look(int row, int column) {
    const int texel = row * 2 * rows_ + column % (2 * rows_);
    if (cast_[texel] >= 0) return cast_[texel];
    const double theta = kPi * (row + 0.5) / rows_;
    const double phi = kPi * (column % (2 * rows_) + 0.5) / rows_;
    const Eigen::Vector3d d(std::sin(theta) * std::sin(phi), std::cos(theta),
                            std::sin(theta) * std::cos(phi));
    int seen = 0;
    if (point_.normal.cast<double>().normalized().dot(d) > 0.0) {
      ++rays;
      seen = scene_.Occluded(point_.position, d) ? 2 : 1;
    }
    cast_[texel] = seen;
    const uint64_t bit = uint64_t{1} << (texel % 64);
    bits[texel / 64] =
        seen == 2 ? bits[texel / 64] | bit : bits[texel / 64] & ~bit;
    return seen;
  }

  void Refine(int r0, int r1, int c0, int c1) {
    const int a = Look(r0, c0), b = Look(r0, c1), c = Look(r1, c0),
              d = Look(r1, c1);
    if (a == b && a == c && a == d) {
      for (int k = 0; a == 2 && k < (r1 - r0 + 1) * (c1 - c0 + 1); ++k) {
        const int texel = (r0 + k / (c1 - c0 + 1)) * 2 * rows_ +
                          (c0 + k % (c1 - c0 + 1)) % (2 * rows_);
        if (cast_[texel] < 0) bits[texel / 64] |= uint64_t{1} << (texel % 64);
      }
      return;
    }
    const int rm = (r0 + r1) / 2, cm = (c0 + c1) / 2;
    const bool tall = rm > r0, wide = cm > c0;
    if (!tall && !wide) return;
    Refine(r0, tall ? rm : r1, c0, wide ? cm : c1);
    if (wide) Refine(r0, tall ? rm : r1, cm, c1);
    if (tall) Refine(rm, r1, c0, wide ? cm : c1);
    if (tall && wide) Refine(rm, r1, cm, c1);
  }

  const Scene& scene_;
  const ShadingPoint& point_;
  int rows_;
  std::vector<int> cast_;
};

TEST(VisibilityGrid, PacketsGiveTheBitsOfSingleRays) {
  const Scene scene = Scene::FromMesh(UnitTorusMesh(48, 24)).value();
  const std::vector<ShadingPoint> points =
      FindShadingPoints(scene, TorusCamera(), 16, 16, Mask(), 1).value();
  int shadowed = 0;
  for (const int rows : {32, 64, 128}) {
    const VisibilityGrid grid(scene, rows);
    VisibilityGrid::Scratch scratch;
    VisibilityGrid::Bits bits;
    for (const ShadingPoint& point : points) {
      int64_t rays = 0;
      shadowed += grid.Trace(point, &scratch, &bits, &rays) ? 1 : 0;
      const PlainTrace plain(scene, point, rows);
      ASSERT_EQ(plain.bits, bits);
      EXPECT_EQ(plain.rays, rays);
    }
  }
  EXPECT_GT(shadowed, 50);
}

TEST(Scene, ManyDirectionsAreAsOneByOne) {
  const Scene torus = Scene::FromMesh(UnitTorusMesh(48, 24)).value();
  const ShadingPoint point =
      FindShadingPoints(torus, TorusCamera(), 16, 16, Mask(), 1).value()[40];
  std::mt19937 rng(6);
  std::normal_distribution<double> g;
  for (const size_t count : {0, 1, 7, 8, 9, 500}) {
    std::vector<Eigen::Vector3f> directions;
    while (directions.size() < count) {
      directions.push_back(
          Eigen::Vector3d(g(rng), g(rng), g(rng)).normalized().cast<float>());
    }
    std::vector<uint8_t> hidden(count, 9);
    torus.Occluded(point.position, directions, hidden.data());
    int64_t hits = 0;
    for (size_t k = 0; k < count; ++k) {
      EXPECT_EQ(torus.Occluded(point.position, directions[k].cast<double>()),
                hidden[k] == 1);
      hits += hidden[k];
    }
    if (count == 500) {
      EXPECT_TRUE(hits > 50 && hits < 450) << hits;
    }
    Scene::UnitSphere().Occluded(point.position, directions, hidden.data());
    for (const uint8_t h : hidden) EXPECT_EQ(0, h);
  }
}

}  // namespace
}  // namespace ibrdf
