#include "ibrdf/solvers/observation/observation.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <set>

#include "ibrdf/base/pi.h"
#include "ibrdf/solvers/observation/mean_by_normal.h"
#include "tests/support/solver_testing.h"

namespace ibrdf {
namespace {
using namespace testing;  // NOLINT

constexpr int kSize = 72;    // pixels a side
constexpr int kAcross = 24;  // 3x3 pixels to a bin
constexpr double kMinBinCosine = 0.1;

// Its radiance is another in every pixel; one of them is black.
Observation SphereObservation() {
  Image image(kSize, kSize);
  for (size_t i = 0; i < image.rgb.size(); ++i) {
    image.rgb[i] = static_cast<float>(std::exp(std::sin(7.0 * i)));
  }
  image.rgb[size_t{3} * (kSize / 2 * kSize + kSize / 2)] = 0.0f;
  return Observe(image, nullptr, SpherePoints(kSize));
}

TEST(ObservationPair, IsANinthOfTheImageAndItsBins) {
  const Observation all = SphereObservation();
  const ObservationPair pair = MakePair(all, kSize, kAcross);
  const double share =
      static_cast<double>(pair.pixels.points.size()) / all.points.size();
  EXPECT_NEAR(1.0 / 9.0, share, 0.02);
  std::set<int> blocks;
  for (const ShadingPoint& p : pair.pixels.points) {
    blocks.insert(p.pixel / kSize / 8 * 100 + p.pixel % kSize / 8);
  }
  EXPECT_GE(blocks.size(), 8u);  // of nine, corners may miss the sphere
  const BinMeans bins = MeanByNormal(pair.pixels.points, pair.pixels.observed,
                                     kAcross, kMinBinCosine);
  ASSERT_EQ(bins.points.size(), pair.bins.points.size());
  EXPECT_LT(3 * bins.points.size(), pair.pixels.points.size());
  EXPECT_EQ(bins.observed.radiance, pair.bins.observed.radiance);
}

// All pixels of the pair are transported at once.
TEST(ObservationPair, OfALargeImageIsThinner) {
  Image image(700, 700);
  std::fill(image.rgb.begin(), image.rgb.end(), 1.0f);
  const Observation all = Observe(image, nullptr, SpherePoints(700));
  ASSERT_GT(all.points.size() / 9, 40000u);
  const ObservationPair pair = MakePair(all, 700, kAcross);
  EXPECT_LT(pair.pixels.points.size(), 9000u);
  EXPECT_GT(pair.pixels.points.size(), 4000u);
  EXPECT_GT(pair.bins.points.size(), 300u);
}

TEST(BinningError, IsTheMeanDifferenceOfLogarithms) {
  const Observation all = SphereObservation();
  const ObservationPair pair = MakePair(all, kSize, kAcross);
  const std::vector<double>& of_pixels = pair.pixels.observed.radiance;
  std::vector<double> of_bins = pair.bins.observed.radiance;
  const auto error = [&](const std::vector<double>& pixels,
                         const std::vector<double>& bins) {
    return BinningError(pair.pixels, pixels, bins, kAcross);
  };
  EXPECT_LT(error(of_pixels, of_bins), 1e-12);
  for (size_t i = 0; i < of_bins.size(); ++i) {
    of_bins[i] *= std::exp(i % 3 == 0 ? 0.3 : i % 3 == 1 ? -0.3 : 0.0);
  }
  EXPECT_NEAR(0.2, error(of_pixels, of_bins), 1e-12);
  // A model that is black where the image is not.
  EXPECT_EQ(0.0, error(std::vector<double>(of_pixels.size(), 0.0), of_bins));
  of_bins[0] = 0.0;
  EXPECT_EQ(0.0, error(of_pixels, of_bins));
}

TEST(OnePixelPerBin, KeepsPixelsAsTheyAre) {
  const Observation all = SphereObservation();
  const Observation some = OnePixelPerBin(all, kAcross);
  EXPECT_LT(4 * some.points.size(), all.points.size());
  EXPECT_GT(some.points.size(), 200u);
  size_t i = 0;  // both run by pixel within a bin, not over all
  for (size_t k = 0; k < some.points.size(); ++k) {
    for (i = 0; all.points[i].pixel != some.points[k].pixel; ++i) {
    }
    for (int c = 0; c < 3; ++c) {
      EXPECT_EQ(all.observed.radiance[3 * i + c],
                some.observed.radiance[3 * k + c]);
    }
  }
}

// A normal per degree along a great circle through the view.
Observation GreatCircle() {
  Observation o;
  std::vector<double> radiance;
  for (int k = -80; k <= 80; ++k) {
    ShadingPoint p;
    const double theta = k * kPi / 180;
    p.normal =
        Eigen::Vector3d(std::sin(theta), 0, std::cos(theta)).cast<float>();
    p.wo = Eigen::Vector3f::UnitZ();
    p.pixel = 1000 + k;
    p.coverage = 1.0f;
    o.points.push_back(p);
    for (int c = 0; c < 3; ++c) radiance.push_back(2000.0 + k);
  }
  o.observed = MakeObservations(std::move(radiance));
  return o;
}

TEST(Highlights, MirrorALight) {
  const Observation all = GreatCircle();
  const double degree = kPi / 180;
  const Eigen::Vector3d light(std::sin(60 * degree), 0, std::cos(60 * degree));
  const Observation found = Highlights(all, {light}, 3.5 * degree);
  ASSERT_EQ(size_t{7}, found.points.size());  // 27 to 33 degrees
  EXPECT_EQ(1027, found.points.front().pixel);
  EXPECT_EQ(2033.0, found.observed.radiance.back());
  EXPECT_TRUE(Highlights(all, {}, 1.0).points.empty());
}

TEST(Union, TakesEachPixelOnce) {
  const Observation all = GreatCircle();
  const Observation some =
      Highlights(all, {Eigen::Vector3d::UnitZ()}, 2.5 * kPi / 180);
  ASSERT_EQ(size_t{5}, some.points.size());
  const Observation both = Union(some, all);
  EXPECT_EQ(all.points.size(), both.points.size());
  EXPECT_EQ(static_cast<int>(all.points.size()), both.observed.num_valid);
  EXPECT_EQ(some.points[0].pixel, both.points[0].pixel);
  for (size_t i = 0; i < both.points.size(); ++i) {
    EXPECT_EQ(1000.0 + both.points[i].pixel, both.observed.radiance[3 * i]);
  }
  EXPECT_EQ(some.points.size(), Union(some, some).points.size());
}

TEST(Thin, KeepsEveryFewRowsAndColumnsOfALargeImage) {
  Image image(300, 300);
  std::fill(image.rgb.begin(), image.rgb.end(), 1.0f);
  const Observation all = Observe(image, nullptr, SpherePoints(300));
  const Observation thin = Thin(all, 300);
  ASSERT_GT(all.points.size(), 60000u);
  EXPECT_LE(thin.points.size(), 4100u);
  EXPECT_GT(thin.points.size(), 2000u);
  for (const ShadingPoint& p : thin.points) {
    EXPECT_EQ(0, p.pixel % 300 % 5);
    EXPECT_EQ(0, p.pixel / 300 % 5);
  }
}

// What cannot be used leaves nothing to thin.
TEST(Thin, OfABlackImageIsTheImage) {
  const Observation all = Observe(Image(300, 300), nullptr, SpherePoints(300));
  EXPECT_EQ(all.points.size(), Thin(all, 300).points.size());
}

}  // namespace
}  // namespace ibrdf
