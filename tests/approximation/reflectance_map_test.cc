#include "ibrdf/approximation/reflectance_map.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <string>
#include <tuple>

#include "ibrdf/render/reference_radiance.h"
#include "ibrdf/render/reference_renderer.h"
#include "ibrdf/transport/transport.h"
#include "tests/support/function_renderer.h"
#include "tests/support/render_testing.h"

namespace ibrdf {
namespace {
using namespace testing;  // NOLINT

// Coarse rings: what the map must follow is a renderer, not the truth.
ReferenceOptions QuickReference() {
  ReferenceOptions options;
  options.near_rings = 16;
  options.near_ring_samples = 48;
  options.far_width = 32;
  return options;
}

// As documented in ReflectanceMapOptions, but for the mean, which is of all
// points here.
double MeanLogError(const std::vector<double>& a,
                    const std::vector<double>& b) {
  double error = 0.0;
  const double count = static_cast<double>(b.size()) / 3;
  for (int c = 0; c < 3; ++c) {
    double log_mean = 0.0;
    for (size_t i = c; i < b.size(); i += 3) log_mean += std::log(b[i]) / count;
    const double dark = 1e-3 * std::exp(log_mean);
    for (size_t i = c; i < b.size(); i += 3) {
      error += std::abs(std::log(a[i] + dark) - std::log(b[i] + dark)) / count;
    }
  }
  return error / 3;
}

Image SunMap(int height, int width) {
  Image map = SmoothMap(height, width);
  for (int c = 0; c < 3; ++c) {
    map.At(width / 10, height * 2 / 5)[c] = 0.02f * height * width;
  }
  return map;
}

struct Case {
  const char* name;
  BrdfFunction brdf;
  bool sun;
  // At most this share of the points is rendered.
  double share;
};

class ReflectanceMapCases : public ::testing::TestWithParam<Case> {};

TEST_P(ReflectanceMapCases, MeetsTheErrorAskedForAndSavesWork) {
  const Case& test = GetParam();
  const std::vector<ShadingPoint> points = SpherePoints(128);
  const ReferenceRenderer renderer(
      test.sun ? SunMap(16, 32) : SmoothMap(16, 32), QuickReference());
  const ReferenceRadiance render(renderer, test.brdf);
  std::vector<double> direct(3 * points.size()), L_o(direct.size());
  ASSERT_TRUE(render.Render(points, {}, direct.data()));
  for (const double asked : {1e-2, 1e-3}) {
    ReflectanceMapOptions options;
    options.log_error = asked;
    const StatusOr<ReflectanceMapReport> report =
        RenderByNormal(points, render, {}, options, L_o.data());
    ASSERT_TRUE(report.ok());
    EXPECT_LE(MeanLogError(L_o, direct), asked);
    EXPECT_LE(report->log_error + 2.0 * report->standard_error, asked);
    EXPECT_EQ(points.size() + report->nodes,
              static_cast<size_t>(report->rendered + report->interpolated));
    if (asked == 1e-2) {
      EXPECT_LT(report->rendered,
                test.share * static_cast<double>(points.size()));
    }
  }
}

INSTANTIATE_TEST_SUITE_P(
    MaterialsAndLights, ReflectanceMapCases,
    ::testing::Values(Case{"MatteSoft", Lambertian(0.5), false, 0.1},
                      Case{"MatteSun", Lambertian(0.5), true, 0.1},
                      Case{"GlossySoft", Glossy(0.1, 0.5, 10), false, 0.1},
                      Case{"GlossySun", Glossy(0.1, 0.5, 10), true, 0.2},
                      Case{"MirrorSoft", Glossy(0.0, 0.9, 1), false, 0.5},
                      Case{"MirrorSun", Glossy(0.0, 0.9, 1), true, 0.7}),
    [](const auto& test) { return std::string(test.param.name); });

TEST(ReflectanceMap, WorksForTransportToo) {
  const std::vector<ShadingPoint> points = SpherePoints(64);
  TransportOptions options;
  options.grid = {24, 12, 8};
  const BrdfGrid grid =
      BrdfGrid::FromFunction(Glossy(0.2, 0.4, 15), options.grid);
  const Image map = SmoothMap(16, 32);
  const FunctionRenderer render(
      [&](const std::vector<ShadingPoint>& some, double* L_o) {
        Transport(some, 16, 32, options).Render(grid, map.rgb.data(), L_o);
        return true;
      });
  std::vector<double> direct(3 * points.size()), L_o(direct.size());
  ASSERT_TRUE(render.Render(points, {}, direct.data()));
  ReflectanceMapOptions coarse;
  coarse.log_error = 0.01;
  const StatusOr<ReflectanceMapReport> report =
      RenderByNormal(points, render, {}, coarse, L_o.data());
  ASSERT_TRUE(report.ok());
  EXPECT_GT(report->interpolated, 0);
  EXPECT_LE(MeanLogError(L_o, direct), 0.01);
}

TEST(ReflectanceMap, KeptItServesOtherPoints) {
  const ReferenceRenderer renderer(SmoothMap(16, 32), QuickReference());
  const ReferenceRadiance reference(renderer, Glossy(0.1, 0.5, 10));
  size_t rendered = 0;
  const FunctionRenderer render(
      [&](const std::vector<ShadingPoint>& points, double* L_o) {
        rendered += points.size();
        return reference.Render(points, {}, L_o);
      });
  ReflectanceMapOptions options;
  options.log_error = 1e-2;
  const StatusOr<ReflectanceMap> map =
      ReflectanceMap::Fit(SpherePoints(128), render, {}, options);
  ASSERT_TRUE(map.ok());
  EXPECT_EQ(rendered, static_cast<size_t>(map->report().rendered));
  const std::vector<ShadingPoint> others = SpherePoints(47);
  std::vector<double> direct(3 * others.size()), L_o(direct.size());
  ASSERT_TRUE(reference.Render(others, {}, direct.data()));
  rendered = 0;
  ASSERT_TRUE(map->Render(others, {}, L_o.data()));
  EXPECT_LT(rendered, others.size() / 10);
  EXPECT_LE(MeanLogError(L_o, direct), options.log_error);
}

// Where nothing could be interpolated it renders all.
TEST(ReflectanceMap, KeptOfTooFewPointsItIsTheRenderer) {
  const ReferenceRenderer renderer(SmoothMap(16, 32), QuickReference());
  const ReferenceRadiance render(renderer, Lambertian(0.5));
  const StatusOr<ReflectanceMap> map =
      ReflectanceMap::Fit(SpherePoints(8), render, {}, {});
  ASSERT_TRUE(map.ok());
  const std::vector<ShadingPoint> others = SpherePoints(16);
  std::vector<double> direct(3 * others.size()), L_o(direct.size());
  ASSERT_TRUE(render.Render(others, {}, direct.data()));
  ASSERT_TRUE(map->Render(others, {}, L_o.data()));
  EXPECT_EQ(direct, L_o);
}

TEST(ReflectanceMap, AnyViewDirectionAndRoughNormals) {
  const ReferenceRenderer renderer(SmoothMap(16, 32), QuickReference());
  const ReferenceRadiance render(renderer, Glossy(0.1, 0.5, 10));
  std::mt19937 rng(5);
  std::normal_distribution<double> g;
  std::vector<ShadingPoint> points;
  const Eigen::Vector3d wo = Eigen::Vector3d(0.6, -0.7, 0.2).normalized();
  while (points.size() < 6000) {
    ShadingPoint p = PointAt(0.0, 0.0);
    p.normal =
        Eigen::Vector3d(g(rng), g(rng), g(rng)).normalized().cast<float>();
    p.wo = wo.cast<float>();
    if (p.normal.dot(p.wo) >= kMinViewCosine) points.push_back(p);
  }
  std::vector<double> direct(3 * points.size()), L_o(direct.size());
  ASSERT_TRUE(render.Render(points, {}, direct.data()));
  ReflectanceMapOptions options;
  options.log_error = 3e-3;
  const StatusOr<ReflectanceMapReport> report =
      RenderByNormal(points, render, {}, options, L_o.data());
  ASSERT_TRUE(report.ok());
  EXPECT_GT(report->interpolated, 3000);
  EXPECT_LE(MeanLogError(L_o, direct), 3e-3);
}

TEST(ReflectanceMap, NoiseOfTheNormalDoesNotPayAndIsRenderedDirectly) {
  // No two normals have related radiance: nothing can be interpolated.
  const FunctionRenderer noise([](const std::vector<ShadingPoint>& points,
                                  double* L_o) {
    for (size_t i = 0; i < points.size(); ++i) {
      const double x = 1e4 * points[i].normal.x() + 7e4 * points[i].normal.y();
      for (int c = 0; c < 3; ++c) L_o[3 * i + c] = 1.5 + std::sin(x * (c + 1));
    }
    return true;
  });
  const std::vector<ShadingPoint> points = SpherePoints(128);
  std::vector<double> direct(3 * points.size()), L_o(direct.size());
  ASSERT_TRUE(noise.Render(points, {}, direct.data()));
  const StatusOr<ReflectanceMapReport> report =
      RenderByNormal(points, noise, {}, {}, L_o.data());
  ASSERT_TRUE(report.ok());
  EXPECT_EQ(0, report->interpolated);
  EXPECT_EQ(direct, L_o);
  // What was wasted is bounded.
  EXPECT_LT(report->rendered, 1.1 * static_cast<double>(points.size()));
}

TEST(ReflectanceMap, BlackAndFewPointsAreExact) {
  const FunctionRenderer black(
      [](const std::vector<ShadingPoint>& points, double* L_o) {
        std::fill_n(L_o, 3 * points.size(), 0.0);
        return true;
      });
  for (const int size : {1, 2, 8, 64}) {
    const std::vector<ShadingPoint> points = SpherePoints(size);
    std::vector<double> L_o(3 * points.size(), 1.0);
    ASSERT_TRUE(RenderByNormal(points, black, {}, {}, L_o.data()).ok());
    for (const double e : L_o) EXPECT_EQ(0.0, e);
  }
  EXPECT_TRUE(RenderByNormal({}, black, {}, {}, nullptr).ok());
}

TEST(ReflectanceMap, RefusesSeveralViewDirections) {
  Camera camera;
  camera.type = CameraType::kPerspective;
  const std::vector<ShadingPoint> points =
      FindShadingPoints(Scene::UnitSphere(), camera, 16, 16, Mask(), 1).value();
  std::vector<double> L_o(3 * points.size());
  int calls = 0;
  const FunctionRenderer count([&](const std::vector<ShadingPoint>&, double*) {
    ++calls;
    return true;
  });
  const StatusOr<ReflectanceMapReport> report =
      RenderByNormal(points, count, {}, {}, L_o.data());
  ASSERT_FALSE(report.ok());
  EXPECT_EQ(StatusCode::kInvalidInput, report.status().code());
  EXPECT_EQ(0, calls);
}

TEST(ReflectanceMap, StopsWhenTheRendererDoes) {
  const std::vector<ShadingPoint> points = SpherePoints(64);
  std::vector<double> L_o(3 * points.size());
  for (int last = 0; last < 3; ++last) {
    int calls = 0;
    const FunctionRenderer render(
        [&](const std::vector<ShadingPoint>& some, double* out) {
          for (size_t i = 0; i < some.size(); ++i) {
            const double x = some[i].normal.x();
            for (int c = 0; c < 3; ++c) out[3 * i + c] = 1.1 + std::sin(30 * x);
          }
          return ++calls <= last;
        });
    const StatusOr<ReflectanceMapReport> report =
        RenderByNormal(points, render, {}, {}, L_o.data());
    ASSERT_FALSE(report.ok());
    EXPECT_EQ(StatusCode::kInterrupted, report.status().code());
    EXPECT_EQ(last + 1, calls);
  }
}

// The renderer reports its progress in each call to whoever started the image.
TEST(ReflectanceMap, HandsProgressOn) {
  const std::vector<ShadingPoint> points = SpherePoints(64);
  const ReferenceRenderer renderer(SmoothMap(16, 32), QuickReference());
  const ReferenceRadiance render(renderer, Lambertian(0.5));
  std::vector<double> L_o(3 * points.size());
  int calls = 0;
  const StatusOr<ReflectanceMapReport> report = RenderByNormal(
      points, render, [&calls](double) { return ++calls < 2; }, {}, L_o.data());
  ASSERT_FALSE(report.ok());
  EXPECT_EQ(StatusCode::kInterrupted, report.status().code());
  EXPECT_EQ(2, calls);
}

}  // namespace
}  // namespace ibrdf
