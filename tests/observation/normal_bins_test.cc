#include "ibrdf/solvers/observation/normal_bins.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <set>

#include "tests/support/solver_testing.h"

namespace ibrdf {
namespace {
using namespace testing;  // NOLINT

TEST(NormalBins, RadianceIsTheMeanOfTheirPoints) {
  const std::vector<ShadingPoint> points = SpherePoints(20);
  std::vector<double> radiance;
  for (size_t i = 0; i < 3 * points.size(); ++i) radiance.push_back(1.0 + i);
  radiance[3 * 100 + 1] = -1.0;
  const NormalBins bins =
      BinByNormal(points, MakeObservations(radiance), {5, 3, 0.2});
  ASSERT_GT(bins.num_bins(), 10);
  ASSERT_LE(bins.num_bins(), 25);
  for (int i = 0; i < bins.num_bins(); ++i) {
    const int begin = bins.first[i], end = bins.first[i + 1];
    ASSERT_GT(end, begin);
    ASSERT_LE(end - begin, 3);
    double sum = 0.0;
    for (int k = begin; k < end; ++k) {
      EXPECT_NE(points[100].pixel, bins.points[k].pixel);
      EXPECT_GE(bins.points[k].normal.dot(bins.points[k].wo), 0.2f);
      const auto at = std::find_if(points.begin(), points.end(),
                                   [&](const ShadingPoint& p) {
                                     return p.pixel == bins.points[k].pixel;
                                   });
      sum += radiance[3 * (at - points.begin()) + 2];
      // Like normals: within a bin's diagonal.
      EXPECT_LT(
          (bins.points[k].normal - bins.points[begin].normal).head<2>().norm(),
          0.4f * std::sqrt(2.0f) + 1e-3f);
    }
    EXPECT_NEAR(std::log(sum / (end - begin)),
                bins.log_radiance[2 * bins.num_bins() + i], 1e-12);
  }
}

// Bins of one material alone, one material's after the other's.
TEST(NormalBins, MaterialsDoNotShareBins) {
  std::vector<ShadingPoint> points = SpherePoints(20);
  for (size_t i = 0; i < points.size(); ++i) points[i].material = i % 2;
  std::vector<double> radiance;
  for (size_t i = 0; i < 3 * points.size(); ++i) {
    radiance.push_back(i / 3 % 2 == 0 ? 1.0 : 5.0);
  }
  const Observations observed = MakeObservations(radiance);
  const NormalBins bins = BinByNormal(points, observed, {5, 3, 0.2});
  int last = 0;
  for (int i = 0; i < bins.num_bins(); ++i) {
    const int material = bins.points[bins.first[i]].material;
    EXPECT_GE(material, last);
    last = material;
    for (int k = bins.first[i]; k < bins.first[i + 1]; ++k) {
      EXPECT_EQ(material, bins.points[k].material);
    }
    EXPECT_NEAR(std::log(material == 0 ? 1.0 : 5.0), bins.log_radiance[i],
                1e-12);
  }
  EXPECT_EQ(1, last);
}

// Like normals of two views reflect other light: each view has its own bins,
// as if it were alone.
TEST(NormalBins, ViewsHaveBinsOfTheirOwn) {
  const std::vector<ShadingPoint> one = SpherePoints(32);
  std::vector<ShadingPoint> both = one;
  for (ShadingPoint point : one) {
    point.view = 1;
    both.push_back(point);
  }
  std::vector<double> radiance;
  for (size_t i = 0; i < both.size(); ++i) {
    const double value = i < one.size() ? 2.0 : 50.0;
    radiance.insert(radiance.end(), 3, value);
  }
  const NormalBinOptions options = {8, 4, 0.2};
  const NormalBins bins =
      BinByNormal(both, MakeObservations(radiance), options);
  const NormalBins alone = BinByNormal(
      one, MakeObservations(std::vector<double>(3 * one.size(), 2.0)), options);
  ASSERT_EQ(2 * alone.num_bins(), bins.num_bins());
  for (int i = 0; i < bins.num_bins(); ++i) {
    const int view = bins.points[bins.first[i]].view;
    for (int k = bins.first[i]; k < bins.first[i + 1]; ++k) {
      EXPECT_EQ(view, bins.points[k].view);
    }
    EXPECT_NEAR(view == 0 ? 2.0 : 50.0, std::exp(bins.log_radiance[i]), 1e-12);
  }
}

TEST(NormalBins, MoreBinsThanMayBeAreThinnedOverAllViews) {
  const std::vector<ShadingPoint> one = SpherePoints(32);
  std::vector<ShadingPoint> all;
  for (int view = 0; view < 7; ++view) {
    for (ShadingPoint point : one) {
      point.view = view;
      all.push_back(point);
    }
  }
  const Observations observed =
      MakeObservations(std::vector<double>(3 * all.size(), 2.0));
  const int unlimited = BinByNormal(all, observed, {8, 4, 0.2, 0}).num_bins();
  for (const int most : {1, 50, unlimited - 1, unlimited, 10 * unlimited}) {
    const NormalBins bins = BinByNormal(all, observed, {8, 4, 0.2, most});
    EXPECT_EQ(std::min(most, unlimited), bins.num_bins());
    std::set<int> views;
    for (const ShadingPoint& point : bins.points) views.insert(point.view);
    EXPECT_EQ(std::min<size_t>(7, most), views.size());
  }
}

}  // namespace
}  // namespace ibrdf
