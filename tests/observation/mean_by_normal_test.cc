#include "ibrdf/solvers/observation/mean_by_normal.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <limits>
#include <random>

#include "tests/support/solver_testing.h"

namespace ibrdf {
namespace {
using namespace testing;  // NOLINT

constexpr double kMinCosine = 0.2;
// Logarithms and exponentials of doubles of size 1.
constexpr double kRounding = 1e-13;

std::vector<double> RandomRadiance(size_t points, unsigned seed) {
  std::mt19937 rng(seed);
  std::normal_distribution<double> g;
  std::vector<double> radiance(3 * points);
  for (double& e : radiance) e = std::exp(g(rng));
  return radiance;
}

void ExpectSame(const BinMeans& a, const BinMeans& b) {
  ASSERT_EQ(a.points.size(), b.points.size());
  EXPECT_EQ(a.observed.radiance, b.observed.radiance);
  for (size_t i = 0; i < a.points.size(); ++i) {
    EXPECT_EQ(a.points[i].normal, b.points[i].normal);
    EXPECT_EQ(a.points[i].wo, b.points[i].wo);
    EXPECT_EQ(a.points[i].pixel, b.points[i].pixel);
  }
}

TEST(MeanByNormal, ASphereBecomesADiscOfCells) {
  const std::vector<ShadingPoint> points = SpherePoints(48);
  const std::vector<double> radiance = RandomRadiance(points.size(), 1);
  size_t before = 0;
  for (const int across : {1, 4, 12, 24}) {
    const BinMeans bins =
        MeanByNormal(points, MakeObservations(radiance), across, kMinCosine);
    ASSERT_EQ(3 * bins.points.size(), bins.observed.radiance.size());
    EXPECT_GT(bins.points.size(), before);
    EXPECT_LE(bins.points.size(),
              std::min<size_t>((across + 1) * (across + 1), points.size()));
    before = bins.points.size();
    for (const ShadingPoint& p : bins.points) {
      EXPECT_NEAR(1.0, p.normal.norm(), 1e-6);  // float
      EXPECT_EQ(Eigen::Vector3f(0, 0, 1), p.wo);
      // Near a member, within a bin's diagonal on the disc; a mean's depth
      // shortens it once more by less than that.
      const auto member = std::find_if(
          points.begin(), points.end(),
          [&](const ShadingPoint& m) { return m.pixel == p.pixel; });
      ASSERT_NE(points.end(), member);
      EXPECT_LT((member->normal - p.normal).head<2>().norm(),
                2 * std::sqrt(2.0) * 2 / across);
    }
  }
  // So fine that every point has a bin of its own.
  const BinMeans all =
      MeanByNormal(points, MakeObservations(radiance), 1000, 0.0);
  EXPECT_EQ(points.size(), all.points.size());
}

TEST(MeanByNormal, ConstantRadianceStays) {
  const std::vector<ShadingPoint> points = SpherePoints(24);
  std::vector<double> radiance;
  for (size_t i = 0; i < points.size(); ++i) {
    radiance.insert(radiance.end(), {2.0, 3e-5, 7e4});
  }
  const BinMeans bins =
      MeanByNormal(points, MakeObservations(radiance), 6, kMinCosine);
  for (size_t i = 0; i < bins.observed.radiance.size(); ++i) {
    EXPECT_NEAR(1.0, bins.observed.radiance[i] / radiance[i % 3],
                10 * kRounding);
  }
}

TEST(MeanByNormal, InvalidAndGrazingPointsAreLeftOut) {
  const std::vector<ShadingPoint> points = SpherePoints(24);
  std::vector<double> radiance = RandomRadiance(points.size(), 2);
  const double bad[] = {std::numeric_limits<double>::quiet_NaN(), 0.0,
                        std::numeric_limits<double>::infinity(), -1.0};
  for (size_t i = 0; i < points.size(); i += 5) {
    radiance[3 * i + i % 3] = bad[i / 5 % 4];
  }
  std::vector<ShadingPoint> kept;
  std::vector<double> kept_radiance;
  for (size_t i = 0; i < points.size(); ++i) {
    if (i % 5 == 0 || points[i].normal.z() < kMinCosine) continue;
    kept.push_back(points[i]);
    for (int c = 0; c < 3; ++c) kept_radiance.push_back(radiance[3 * i + c]);
  }
  ASSERT_LT(kept.size(), 0.8 * points.size() - 4);  // some graze
  ExpectSame(MeanByNormal(kept, MakeObservations(kept_radiance), 8, 0.0),
             MeanByNormal(points, MakeObservations(radiance), 8, kMinCosine));

  std::fill(radiance.begin(), radiance.end(), 0.0);
  EXPECT_TRUE(MeanByNormal(points, MakeObservations(radiance), 8, kMinCosine)
                  .points.empty());
}

TEST(MeanByNormal, ViewsStayApart) {
  ShadingPoint a = PointAt(0.3, 0.4), b = a;
  b.view = 1;
  const std::vector<double> radiance = {1, 2, 3, 4, 5, 6};
  const BinMeans means =
      MeanByNormal({a, b}, MakeObservations(radiance), 4, kMinCosine);
  ASSERT_EQ(2u, means.points.size());
  EXPECT_NEAR(4.0, means.observed.radiance[3], 1e-12);
}

TEST(MeanByNormal, ViewsFromOtherDirectionsStayApart) {
  ShadingPoint a = PointAt(0.3, 0.4), b = a;
  const std::vector<double> radiance = {1, 2, 3, 4, 5, 6};
  EXPECT_EQ(1u, MeanByNormal({a, b}, MakeObservations(radiance), 4, kMinCosine)
                    .points.size());
  // Around the normal, so that all cosines are the same.
  b.wo = Eigen::AngleAxisf(0.4f, a.normal) * a.wo;
  EXPECT_EQ(2u, MeanByNormal({a, b}, MakeObservations(radiance), 4, kMinCosine)
                    .points.size());
  // A whole image in perspective: a bin's members see along like directions.
  Camera camera;
  camera.type = CameraType::kPerspective;
  camera.fov_degrees = 50.0;
  camera.from = {0.0, 0.0, 2.5};
  const std::vector<ShadingPoint> points =
      FindShadingPoints(Scene::UnitSphere(), camera, 32, 32, Mask(), 1).value();
  const BinMeans bins =
      MeanByNormal(points, MakeObservations(RandomRadiance(points.size(), 3)),
                   4, kMinCosine);
  for (const ShadingPoint& p : bins.points) {
    const auto member =
        std::find_if(points.begin(), points.end(),
                     [&](const ShadingPoint& m) { return m.pixel == p.pixel; });
    // The diagonal of a bin of directions, some 3 degrees.
    EXPECT_LT((member->wo - p.wo).norm(), 0.06f);
  }
  // One view alone would leave fewer.
  const BinMeans one_view =
      MeanByNormal(SpherePoints(32),
                   MakeObservations(RandomRadiance(SpherePoints(32).size(), 3)),
                   4, kMinCosine);
  EXPECT_GT(bins.points.size(), one_view.points.size());
}

TEST(MeanByNormal, NoiseAveragesAsLogarithms) {
  const ShadingPoint p = PointAt(0.5, 1.0);
  const BinMeans two = MeanByNormal(
      {p, p}, MakeObservations({1.0, 2.0, 1e-3, 4.0, 2.0, 1e3}), 8, kMinCosine);
  ASSERT_EQ(3u, two.observed.radiance.size());
  EXPECT_NEAR(2.0, two.observed.radiance[0], kRounding);
  EXPECT_NEAR(2.0, two.observed.radiance[1], kRounding);
  EXPECT_NEAR(1.0, two.observed.radiance[2], kRounding);

  const int n = 400;
  const double sigma = 0.3;
  std::mt19937 rng(4);
  std::normal_distribution<double> g;
  std::vector<double> radiance(3 * n);
  for (double& e : radiance) e = std::exp(sigma * g(rng));
  const BinMeans many = MeanByNormal(std::vector<ShadingPoint>(n, p),
                                     MakeObservations(radiance), 8, kMinCosine);
  ASSERT_EQ(3u, many.observed.radiance.size());
  // Four standard deviations of a mean.
  for (const double e : many.observed.radiance) {
    EXPECT_LT(std::abs(std::log(e)), 4 * sigma / std::sqrt(n));
  }
}

TEST(MeanByNormal, OrderIsThatOfTheCells) {
  std::vector<ShadingPoint> points = SpherePoints(24);
  std::vector<double> radiance = RandomRadiance(points.size(), 5);
  const BinMeans bins =
      MeanByNormal(points, MakeObservations(radiance), 8, kMinCosine);
  ExpectSame(bins,
             MeanByNormal(points, MakeObservations(radiance), 8, kMinCosine));
  // Whatever order the points come in.
  std::reverse(points.begin(), points.end());
  std::reverse(radiance.begin(), radiance.end());
  for (size_t i = 0; i < points.size(); ++i) {
    std::swap(radiance[3 * i], radiance[3 * i + 2]);
  }
  const BinMeans reversed =
      MeanByNormal(points, MakeObservations(radiance), 8, kMinCosine);
  ASSERT_EQ(bins.points.size(), reversed.points.size());
  for (size_t i = 0; i < bins.points.size(); ++i) {
    EXPECT_LT((bins.points[i].normal - reversed.points[i].normal).norm(),
              1e-6f);
    for (int c = 0; c < 3; ++c) {
      EXPECT_NEAR(1.0,
                  bins.observed.radiance[3 * i + c] /
                      reversed.observed.radiance[3 * i + c],
                  kRounding);
    }
  }
}

// Members spread over one bin in each of some places on a Lambertian sphere,
// in a map of contrast 2, and the renders of members and of their mean point.
struct RenderedCells {
  double worst_error = 0.0;   // of the mean point's log radiance
  double worst_spread = 0.0;  // of a member's log radiance from the mean
};

RenderedCells RenderCells(int across) {
  constexpr int kMapHeight = 32, kMapWidth = 64, kMembers = 12;
  Image map(kMapWidth, kMapHeight);
  for (int r = 0; r < kMapHeight; ++r) {
    for (int c = 0; c < kMapWidth; ++c) {
      const Eigen::Vector3d d =
          MapDirection(r + 0.5, c + 0.5, kMapHeight, kMapWidth);
      for (int k = 0; k < 3; ++k) {
        map.At(c, r)[k] = static_cast<float>(1.5 + 0.5 * d[k]);
      }
    }
  }
  TransportOptions options = TinyTransportOptions();
  const BrdfGrid grid = BrdfGrid::FromFunction(Lambertian(0.5), options.grid);
  const auto render = [&](const std::vector<ShadingPoint>& points) {
    std::vector<double> L_o(3 * points.size());
    Transport(points, kMapHeight, kMapWidth, options)
        .Render(grid, map.rgb.data(), L_o.data());
    return L_o;
  };
  // |t.grad L_o| <= (max L - min L) pi / 2 and |t.H t L_o| <= pi max L (a great
  // circle's integral of cos^2, and L_o itself) in units of albedo / pi, with
  // L_o >= pi min L: of log L_o's curvature, max L / min L + (contrast / 2)^2.
  constexpr double kCurvature = 2.0 + 0.25;
  std::mt19937 rng(6);
  std::uniform_real_distribution<double> uniform(-0.49, 0.49);
  const double side = 2.0 / across;
  std::vector<ShadingPoint> members, means;
  for (const double centre_x : {-0.5, 0.0, 0.5}) {
    for (const double centre_y : {-0.5, 0.0, 0.25}) {
      for (int m = 0; m < kMembers; ++m) {
        const double x = centre_x + side * uniform(rng);
        const double y = centre_y + side * uniform(rng);
        members.push_back(
            PointAt(std::asin(std::hypot(x, y)), std::atan2(y, x)));
      }
    }
  }
  const std::vector<double> L_o = render(members);
  std::vector<double> radiance;  // of the bins
  for (size_t first = 0; first < members.size(); first += kMembers) {
    const BinMeans bin = MeanByNormal(
        {members.begin() + first, members.begin() + first + kMembers},
        MakeObservations(
            {L_o.begin() + 3 * first, L_o.begin() + 3 * (first + kMembers)}),
        across, 0.05);
    EXPECT_EQ(1u, bin.points.size());
    means.push_back(bin.points[0]);
    radiance.insert(radiance.end(), bin.observed.radiance.begin(),
                    bin.observed.radiance.end());
  }
  const std::vector<double> at_mean = render(means);
  RenderedCells out;
  for (size_t i = 0; i < means.size(); ++i) {
    double mean_square = 0.0;
    for (size_t m = kMembers * i; m < kMembers * (i + 1); ++m) {
      mean_square +=
          (members[m].normal - means[i].normal).cast<double>().squaredNorm() /
          kMembers;
    }
    for (size_t c = 0; c < 3; ++c) {
      const double mean = std::log(radiance[3 * i + c]);
      const double error = std::abs(std::log(at_mean[3 * i + c]) - mean);
      EXPECT_LT(error, 0.5 * kCurvature * mean_square);
      out.worst_error = std::max(out.worst_error, error);
      for (size_t m = kMembers * i; m < kMembers * (i + 1); ++m) {
        out.worst_spread = std::max(out.worst_spread,
                                    std::abs(std::log(L_o[3 * m + c]) - mean));
      }
    }
  }
  return out;
}

TEST(MeanByNormal, AMeanPointRendersTheMeanToSecondOrder) {
  const RenderedCells coarse = RenderCells(8), fine = RenderCells(32);
  // A member in the place of the mean would be off by the first order.
  EXPECT_LT(coarse.worst_error, coarse.worst_spread / 4);
  EXPECT_LT(fine.worst_error, fine.worst_spread / 8);
  // Bins of a quarter of the size: 16 times less, were there no quadrature.
  EXPECT_LT(fine.worst_error, coarse.worst_error / 8);
}

TEST(MeanByNormal, MaterialsDoNotShareBins) {
  std::vector<ShadingPoint> points = SpherePoints(20);
  std::vector<double> radiance;
  for (size_t i = 0; i < points.size(); ++i) {
    points[i].material = i % 2;
    radiance.insert(radiance.end(), 3, i % 2 == 0 ? 1.0 : 5.0);
  }
  const BinMeans means =
      MeanByNormal(points, MakeObservations(radiance), 6, 0.2);
  ASSERT_FALSE(means.points.empty());
  for (size_t i = 0; i < means.points.size(); ++i) {
    EXPECT_NEAR(means.points[i].material == 0 ? 1.0 : 5.0,
                means.observed.radiance[3 * i], 1e-12);
  }
}

}  // namespace
}  // namespace ibrdf
