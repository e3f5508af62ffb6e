// Light from the object to itself: closed forms, brute force, derivatives.
#include "ibrdf/visibility/radiosity_patches.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <memory>
#include <random>
#include <tuple>

#include "ibrdf/brdf/cook_torrance.h"
#include "ibrdf/render/reference_renderer.h"
#include "ibrdf/transport/transport.h"
#include "tests/support/render_testing.h"
#include "tests/support/shadow_testing.h"

namespace ibrdf {
namespace {
using namespace testing;  // NOLINT

// Sums of some thousand float products.
constexpr double kFloatSums = 2e-5;

TransportOptions WithBounces(const Scene& scene,
                             const std::vector<ShadingPoint>& points,
                             int bounces, RadiosityOptions how = {}) {
  TransportOptions options;
  VisibilityOptions rays;
  options.num_threads = rays.num_threads = how.num_threads;
  auto visibility = std::make_shared<Visibility>(scene, points, rays);
  options.visibility = visibility;
  if (bounces == 0) return options;
  how.bounces = bounces;
  options.patches =
      std::make_shared<RadiosityPatches>(scene, points, visibility, how);
  return options;
}

std::vector<ShadingPoint> BowlPoints(
    double opening_degrees,
    const std::vector<double>& shares = {0.1, 0.35, 0.6, 0.9},
    const std::vector<double>& phis = {0.4, 2.0, 4.4}) {
  std::vector<ShadingPoint> points;
  for (const double share : shares) {
    for (const double phi : phis) {
      const double theta =
          opening_degrees * kPi / 180 * (1 - share) + share * kPi;
      const Eigen::Vector3d p(std::sin(theta) * std::sin(phi), std::cos(theta),
                              std::sin(theta) * std::cos(phi));
      ShadingPoint point{};
      point.normal = -p.cast<float>();
      point.wo = -p.cast<float>();
      point.position = 0.999 * p;
      point.index = static_cast<int>(points.size());
      points.push_back(point);
    }
  }
  return points;
}

// Every point of a sphere sees equal areas of it alike: within a cap that
// covers a share F of it, F of a point's light comes from the cap, and under
// constant light 1 a matte cap of albedo a has, after b bounces,
// a (1 - F) sum_(k <= b) (a F)^k.
TEST(Interreflection, MatteBowlIsTheClosedFormAfterEveryBounce) {
  for (const double degrees : {90.0, 50.0}) {
    const double share = (1 + std::cos(degrees * kPi / 180)) / 2;
    const Scene scene = Scene::FromMesh(BowlMesh(degrees)).value();
    const std::vector<ShadingPoint> points = BowlPoints(degrees);
    RadiosityOptions few;
    few.max_patches = 500;
    const TransportOptions options = WithBounces(scene, points, 3, few);
    const Transport transport(points, 32, 64, options);
    for (const double albedo : {0.3, 0.9}) {
      const Image map = ConstantMap(32, 64, 1.0f);
      double expected = 0.0;
      for (int b = 0; b <= 3; ++b) {
        expected += albedo * (1 - share) * std::pow(albedo * share, b);
        const BrdfGrid matte =
            BrdfGrid::FromFunction(Lambertian(albedo), options.grid);
        std::vector<double> L_o(3 * points.size());
        transport.RenderBounces(matte, map.rgb.data(), b, L_o.data());
        for (size_t i = 0; i < points.size(); ++i) {
          // Edges of the opening fall between the visibility's directions.
          EXPECT_NEAR(expected, L_o[3 * i], 0.015 * expected)
              << "opening " << degrees << ", albedo " << albedo << ", bounces "
              << b << ", point " << i;
        }
      }
    }
  }
}

// Every point of a cap whose halves have albedos a and b sees as much of one as
// of the other: (a + b) / 2 takes the place of a in the sum above.
TEST(Interreflection, PatchesAreOfTheMaterialOfThePointsNearThem) {
  const double share = 0.5;
  const Scene scene = Scene::FromMesh(BowlMesh(90)).value();
  std::vector<double> shares, phis;
  for (int k = 0; k < 12; ++k) shares.push_back((k + 0.5) / 12);
  for (int k = 0; k < 20; ++k) phis.push_back((k + 0.5) * kPi / 10);
  std::vector<ShadingPoint> points = BowlPoints(90, shares, phis);
  for (ShadingPoint& p : points) p.material = p.position.x() > 0.0 ? 1 : 0;
  RadiosityOptions few;
  few.max_patches = 500;
  const TransportOptions options = WithBounces(scene, points, 3, few);
  const Transport transport(points, 32, 64, options);
  const double albedo[] = {0.9, 0.3};
  const BrdfGrid grids[] = {
      BrdfGrid::FromFunction(Lambertian(albedo[0]), options.grid),
      BrdfGrid::FromFunction(Lambertian(albedo[1]), options.grid)};
  const Image map = ConstantMap(32, 64, 1.0f);
  std::vector<double> L_o(3 * points.size()), by_light(L_o.size());
  double sum = 0.0;
  for (int b = 0; b <= 3; ++b) {
    sum += (1 - share) * std::pow(0.6 * share, b);
    transport.RenderBounces({&grids[0], &grids[1]}, map.rgb.data(), b,
                            L_o.data());
    for (size_t i = 0; i < points.size(); ++i) {
      const double expected = albedo[points[i].material] * sum;
      // And patches at the border are of one material as a whole.
      EXPECT_NEAR(expected, L_o[3 * i], 0.025 * expected)
          << "bounces " << b << ", point " << i;
    }
  }
  transport.ByLight({&grids[0], &grids[1]})
      .Apply(map.rgb.data(), by_light.data());
  for (size_t i = 0; i < L_o.size(); ++i) {
    EXPECT_NEAR(L_o[i], by_light[i], kFloatSums);
  }
}

// White walls under constant light look like the light, whatever their shape.
TEST(Interreflection, WhiteObjectInConstantLightDisappears) {
  const Scene scene = Scene::FromMesh(UnitTorusMesh(64, 32)).value();
  const std::vector<ShadingPoint> points =
      FindShadingPoints(scene, TorusCamera(), 24, 24, Mask(), 1).value();
  const Image map = ConstantMap(32, 64, 1.0f);
  const TransportOptions options = WithBounces(scene, points, 12);
  const Transport transport(points, 32, 64, options);
  const BrdfGrid white = BrdfGrid::FromFunction(Lambertian(1), options.grid);
  std::vector<double> L_o(3 * points.size());
  const auto darkest = [&](int bounces) {
    transport.RenderBounces(white, map.rgb.data(), bounces, L_o.data());
    return *std::min_element(L_o.begin(), L_o.end());
  };
  const double dark = darkest(0), one = darkest(1), all = darkest(12);
  EXPECT_LT(dark, 0.8);
  EXPECT_GT(one, dark);
  EXPECT_GT(all, 0.97);
  EXPECT_LT(*std::max_element(L_o.begin(), L_o.end()), 1.02);
  double mean = 0.0;
  for (const double e : L_o) mean += e / static_cast<double>(L_o.size());
  EXPECT_NEAR(1.0, mean, 0.005);
}

// A large image is transported slice by slice.
TEST(Interreflection, SlicesOfThePointsHaveTheRadianceOfAll) {
  const Scene scene = Scene::FromMesh(UnitTorusMesh(64, 32)).value();
  const std::vector<ShadingPoint> all =
      FindShadingPoints(scene, TorusCamera(), 24, 24, Mask(), 1).value();
  const Image map = SmoothMap(32, 64);
  const TransportOptions options = WithBounces(scene, all, 2);
  const BrdfGrid grid =
      BrdfGrid::FromFunction(Glossy(0.3, 0.5, 12), options.grid);
  std::vector<double> L_o(3 * all.size()), slices;
  Transport(all, 32, 64, options).Render(grid, map.rgb.data(), L_o.data());
  const auto middle = all.begin() + all.size() / 3;
  for (const auto& [begin, end] :
       {std::pair(all.begin(), middle), std::pair(middle, all.end())}) {
    const std::vector<ShadingPoint> some(begin, end);
    std::vector<double> of_some(3 * some.size());
    Transport(some, 32, 64, options)
        .Render(grid, map.rgb.data(), of_some.data());
    slices.insert(slices.end(), of_some.begin(), of_some.end());
  }
  EXPECT_EQ(L_o, slices);
}

// Patches are patches seen from a few sides; brute force knows none. The
// sharper the lobe, the more of the bounce that misses.
TEST(Interreflection, AgreesWithBruteForceFromMatteToGlossy) {
  const Scene scene = Scene::FromMesh(UnitTorusMesh(64, 32)).value();
  const std::vector<ShadingPoint> all =
      FindShadingPoints(scene, TorusCamera(), 40, 40, Mask(), 1).value();
  const Image map = SmoothMap(32, 64);
  struct Case {
    BrdfFunction brdf;
    double share;  // of |log ratio|, mean, that a missing bounce would have
  };
  for (const Case& c :
       {Case{Lambertian(0.9), 0.06}, Case{Glossy(0.3, 0.5, 12), 0.1},
        Case{Glossy(0.02, 0.9, 4), 0.3}}) {
    const TransportOptions options = WithBounces(scene, all, 1);
    const TransportOptions bare = WithBounces(scene, all, 0);
    const BrdfGrid grid = BrdfGrid::FromFunction(c.brdf, options.grid);
    std::vector<double> L_o(3 * all.size()), direct(L_o.size());
    Transport(all, 32, 64, options).Render(grid, map.rgb.data(), L_o.data());
    Transport(all, 32, 64, bare).Render(grid, map.rgb.data(), direct.data());
    // From where least of the light of the map is seen to where most is.
    std::vector<size_t> order;
    for (size_t i = 0; i < all.size(); ++i) {
      if (options.visibility->Hidden(all[i]) != nullptr) order.push_back(i);
    }
    std::sort(order.begin(), order.end(), [&](size_t a, size_t b) {
      return direct[3 * a] < direct[3 * b];
    });
    double error = 0.0, without = 0.0;
    int count = 0;
    for (size_t k = 5; k < order.size() / 2; k += order.size() / 20) {
      const size_t i = order[k];
      const Eigen::Array3d expected =
          BruteForceShadowed(scene, all[i], c.brdf, map, 1, 24, 48, 2);
      for (int ch = 0; ch < 3; ++ch) {
        error += std::abs(std::log(L_o[3 * i + ch] / expected[ch]));
        without += std::abs(std::log(direct[3 * i + ch] / expected[ch]));
        ++count;
      }
    }
    EXPECT_GT(without / count, 0.1);
    EXPECT_LT(error / without, c.share) << error / count;
  }
}

// A mirror-like torus in itself: patches blur what narrow lobes show, rays of
// the lobes' own do not. One bounce, at points whose mirrored view is hidden.
TEST(Interreflection, RaysOfNarrowLobesAgreeWithBruteForce) {
  const Scene scene = Scene::FromMesh(UnitTorusMesh(64, 32)).value();
  const std::vector<ShadingPoint> all =
      FindShadingPoints(scene, TorusCamera(), 32, 32, Mask(), 1).value();
  std::vector<ShadingPoint> points;
  for (const ShadingPoint& p : all) {
    const Eigen::Vector3d n = p.normal.cast<double>();
    const Eigen::Vector3d wo = p.wo.cast<double>();
    if (scene.Occluded(p.position, 2 * n.dot(wo) * n - wo)) points.push_back(p);
  }
  ASSERT_GT(points.size(), 20u);
  const Image map = SmoothMap(32, 64);
  const BrdfFunction brdf = Glossy(0.0, 0.9, 2.0);
  const TransportOptions options = WithBounces(scene, all, 1);
  const std::vector<double> emitted =
      Transport({}, 32, 64, options)
          .Emitted(BrdfGrid::FromFunction(brdf, options.grid), map.rgb.data())
          .back();
  const auto render = [&](int lobe_rays, const double* light) {
    ReferenceOptions reference;
    reference.shadows = std::make_shared<VisibilityGrid>(scene, 256);
    reference.patches = options.patches;
    reference.lobe_rays = lobe_rays;
    std::vector<double> L_o(3 * points.size());
    ReferenceRenderer(map, reference)
        .Render(points, brdf, L_o.data(), {light, 1});
    return L_o;
  };
  const std::vector<double> bare = render(0, nullptr),
                            blurred = render(0, emitted.data()),
                            few = render(4, emitted.data()),
                            many = render(32, emitted.data());
  double of_bare = 0.0, of_blurred = 0.0, of_few = 0.0, of_many = 0.0;
  for (size_t i = 0; i < points.size(); i += points.size() / 12) {
    const Eigen::Array3d expected =
        BruteForceShadowed(scene, points[i], brdf, map, 1, 36, 72, 4);
    for (int c = 0; c < 3; ++c) {
      const size_t k = 3 * i + c;
      of_bare += std::abs(std::log(bare[k] / expected[c]));
      of_blurred += std::abs(std::log(blurred[k] / expected[c]));
      of_few += std::abs(std::log(few[k] / expected[c]));
      of_many += std::abs(std::log(many[k] / expected[c]));
    }
  }
  EXPECT_GT(of_blurred, 0.05 * of_bare);
  EXPECT_LT(of_few, 0.5 * of_blurred);
  EXPECT_LT(of_many, 0.1 * of_blurred);
  EXPECT_LT(of_many, 0.01 * of_bare);
}

TEST(Interreflection, ConvexObjectsHaveNoPatchesAndTheSameBits) {
  const Scene scene = Scene::FromMesh(BallMesh(24, 1.0)).value();
  const std::vector<ShadingPoint> points =
      FindShadingPoints(scene, Camera(), 12, 12, Mask(), 1).value();
  const TransportOptions with = WithBounces(scene, points, 2);
  EXPECT_EQ(0, with.patches->count());
  const Image map = RandomMap(32, 64, 1);
  const BrdfGrid grid = BrdfGrid::FromFunction(Glossy(0.2, 0.5, 8), with.grid);
  std::vector<double> a(3 * points.size()), b(a.size());
  const Transport transport(points, 32, 64, with);
  EXPECT_EQ(0, transport.bounces());
  transport.Render(grid, map.rgb.data(), a.data());
  Transport(points, 32, 64, TransportOptions())
      .Render(grid, map.rgb.data(), b.data());
  EXPECT_EQ(a, b);
}

// Patches stand for what is seen: next to no light is lost, and their number
// is kept.
TEST(Interreflection, PatchesCoverWhatIsSeenWithinTheirNumber) {
  const Scene scene = Scene::FromMesh(UnitTorusMesh(64, 32)).value();
  const std::vector<ShadingPoint> points =
      FindShadingPoints(scene, TorusCamera(), 48, 48, Mask(), 1).value();
  for (const int most : {6000, 200}) {
    RadiosityOptions how;
    how.max_patches = most;
    how.max_points = 256;
    how.bounces = 2;
    const auto patches = WithBounces(scene, points, 2, how).patches;
    EXPECT_GT(patches->count(), 20);
    // The second bounce may add to them.
    EXPECT_LT(patches->count(), 1.2 * most);
    int64_t cells = 0, lost = 0;
    const auto count = [&](const SeenPatches& seen) {
      cells += seen.end - seen.begin;
      lost += std::count_if(seen.begin, seen.end, [](const SeenPatch& s) {
        return s.patch == kNoPatch;
      });
    };
    for (const ShadingPoint& p : points) count(patches->SeenFrom(p));
    for (const ShadingPoint& p : patches->points()) {
      count(patches->SeenFromPatch(p));
    }
    EXPECT_GT(cells, 1000);
    EXPECT_LT(lost, 1e-3 * cells);
    for (const ShadingPoint& p : patches->points()) {
      EXPECT_GE(p.normal.dot(p.wo), 0.9f * kMinViewCosine);
    }
  }
}

// Smooth surfaces give back nearly all light at grazing angles, where a table
// between its nodes gives back more: bounces must not build that up.
TEST(Interreflection, GlossyObjectsInConstantLightStayDarkerThanIt) {
  const Scene scene = Scene::FromMesh(UnitTorusMesh(64, 32)).value();
  const std::vector<ShadingPoint> points =
      FindShadingPoints(scene, TorusCamera(), 24, 24, Mask(), 1).value();
  const TransportOptions options = WithBounces(scene, points, 4);
  const Transport transport(points, 32, 64, options);
  const Image map = ConstantMap(32, 64, 1.0f);
  for (const double roughness : {0.2, 0.05, 0.01}) {
    CookTorrance brdf;
    brdf.diffuse = {0.3, 0.2, 0.0};
    brdf.specular = Eigen::Array3d::Constant(0.6);
    brdf.roughness = Eigen::Array3d::Constant(roughness);
    brdf.f0 = 0.3;
    const BrdfGrid grid = BrdfGrid::FromFunction(brdf.Function(), options.grid);
    const auto emitted = transport.Emitted(grid, map.rgb.data());
    for (const double e : emitted.back()) {
      EXPECT_GT(e, 0.0);
      EXPECT_LT(e, 1.0) << roughness;
    }
  }
}

class BouncedDerivatives : public ::testing::TestWithParam<int> {
 protected:
  BouncedDerivatives()
      : scene_(Scene::FromMesh(UnitTorusMesh(64, 32)).value()),
        points_(
            FindShadingPoints(scene_, TorusCamera(), 9, 9, Mask(), 1).value()),
        options_(WithBounces(scene_, points_, GetParam(), Few())),
        transport_(points_, 32, 64, options_),
        glossy_(BrdfGrid::FromFunction(Glossy(0.5, 0.4, 10), options_.grid)) {}

  static RadiosityOptions Few() {
    RadiosityOptions how;
    how.max_patches = 300;
    return how;
  }
  std::vector<double> Render(const BrdfGrid& grid, const Image& map) const {
    std::vector<double> L_o(3 * points_.size());
    transport_.Render(grid, map.rgb.data(), L_o.data());
    return L_o;
  }
  std::vector<double> Adjoint() {
    std::normal_distribution<double> gauss;
    std::vector<double> adjoint(3 * points_.size(), 0.0);
    for (double& a : adjoint) a = gauss(rng_);
    return adjoint;
  }
  static double Dot(const std::vector<double>& a,
                    const std::vector<double>& b) {
    double sum = 0.0;
    for (size_t i = 0; i < a.size(); ++i) sum += a[i] * b[i];
    return sum;
  }

  std::mt19937 rng_{11};
  const Scene scene_;
  const std::vector<ShadingPoint> points_;
  const TransportOptions options_;
  const Transport transport_;
  const BrdfGrid glossy_;
};

TEST_P(BouncedDerivatives, LightOperatorIsTheRenderAndItsTransposeItsAdjoint) {
  ASSERT_GT(transport_.bounces(), 0);
  const Image map = RandomMap(32, 64, 2);
  const LightOperator op = transport_.ByLight(glossy_);
  const std::vector<double> L_o = Render(glossy_, map), adjoint = Adjoint();
  std::vector<double> applied(L_o.size());
  op.Apply(map.rgb.data(), applied.data());
  for (size_t i = 0; i < L_o.size(); ++i) {
    EXPECT_NEAR(L_o[i], applied[i], kFloatSums * L_o[i]);
  }
  std::vector<float> gradient(map.rgb.size());
  op.ApplyTranspose(adjoint.data(), gradient.data());
  double right = 0.0, size = 0.0;
  for (size_t i = 0; i < gradient.size(); ++i) {
    right += static_cast<double>(gradient[i]) * map.rgb[i];
    size += std::abs(static_cast<double>(gradient[i]) * map.rgb[i]);
  }
  EXPECT_NEAR(Dot(adjoint, applied), right, 1e-6 * size);
}

// A sun of one texel, far above all else.
TEST_P(BouncedDerivatives, LightGradientMatchesDifferencesUnderASun) {
  Image map = SmoothMap(32, 64);
  map.At(20, 4)[0] = map.At(20, 4)[1] = 3e5f;
  const std::vector<double> adjoint = Adjoint();
  std::vector<float> gradient(map.rgb.size());
  transport_.ByLight(glossy_).ApplyTranspose(adjoint.data(), gradient.data());
  const double at = Dot(adjoint, Render(glossy_, map));
  for (const auto& [c, r] : {std::pair(20, 4), {40, 10}, {0, 0}, {63, 31}}) {
    for (int k = 0; k < 3; ++k) {
      Image moved = map;
      moved.At(c, r)[k] *= 1.5f;
      const double step = moved.At(c, r)[k] - map.At(c, r)[k];
      double size = 0.0;
      for (const double e : Render(glossy_, moved)) size += std::abs(e);
      // Linear: rounding alone is left.
      EXPECT_NEAR(
          (Dot(adjoint, Render(glossy_, moved)) - at) / step,
          gradient[3 * (r * 64 + c) + k],
          1e-3 * std::abs(gradient[3 * (r * 64 + c) + k]) + 1e-6 * size / step)
          << c << " " << r << " " << k;
    }
  }
}

// Along random directions of the grid, from a matte floor to a sharp peak;
// radiance is a polynomial of degree bounces + 1 in the grid's values, to which
// five differences are exact up to degree four.
TEST_P(BouncedDerivatives, GridGradientMatchesDifferences) {
  const Image map = RandomMap(32, 64, 4);
  for (const BrdfGrid& at :
       {glossy_, BrdfGrid::FromFunction(Lambertian(0.95), options_.grid),
        BrdfGrid::FromFunction(Glossy(0.01, 0.9, 2), options_.grid)}) {
    const std::vector<double> adjoint = Adjoint();
    std::vector<float> gradient(at.values.size());
    transport_.GridGradient(at, map.rgb.data(), adjoint.data(),
                            gradient.data());
    std::uniform_real_distribution<float> uniform(-1.0f, 1.0f);
    BrdfGrid direction = at;
    for (float& v : direction.values) v *= uniform(rng_);
    double slope = 0.0;
    for (size_t i = 0; i < gradient.size(); ++i) {
      slope += static_cast<double>(gradient[i]) * direction.values[i];
    }
    const auto value = [&](float step) {
      BrdfGrid moved = at;
      for (size_t i = 0; i < moved.values.size(); ++i) {
        moved.values[i] += step * direction.values[i];
      }
      return Dot(adjoint, Render(moved, map));
    };
    const double numeric =
        (8 * (value(0.25f) - value(-0.25f)) - (value(0.5f) - value(-0.5f))) /
        (12 * 0.25);
    double size = 0.0;
    for (const double e : Render(at, map)) size += std::abs(e);
    EXPECT_NEAR(numeric, slope, 1e-5 * size);
  }
}

TEST_P(BouncedDerivatives, SameBitsForAnyNumberOfThreads) {
  const Image map = RandomMap(32, 64, 6);
  const auto compute = [&](int threads) {
    RadiosityOptions how = Few();
    how.num_threads = threads;
    const Transport t(points_, 32, 64,
                      WithBounces(scene_, points_, GetParam(), how));
    std::vector<double> L_o(3 * points_.size());
    t.Render(glossy_, map.rgb.data(), L_o.data());
    std::vector<float> light(map.rgb.size()), grid(glossy_.values.size());
    t.ByLight(glossy_).ApplyTranspose(L_o.data(), light.data());
    t.GridGradient(glossy_, map.rgb.data(), L_o.data(), grid.data());
    return std::make_tuple(L_o, light, grid);
  };
  const auto one = compute(1);
  EXPECT_EQ(one, compute(2));
  EXPECT_EQ(one, compute(3));
}

INSTANTIATE_TEST_SUITE_P(Bounces, BouncedDerivatives, ::testing::Values(1, 3));

}  // namespace
}  // namespace ibrdf
