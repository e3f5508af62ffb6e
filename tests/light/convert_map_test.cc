#include "ibrdf/light/convert_map.h"

#include <gtest/gtest.h>

#include <cmath>
#include <cstring>
#include <random>

#include "ibrdf/base/pi.h"
#include "ibrdf/light/texel_overlaps.h"
#include "tests/light/rounding.h"

namespace ibrdf {
namespace {

using Eigen::Array3d;
using Eigen::Vector3d;

// How far the balance of sampled overlaps has converged (convert_map.h).
constexpr double kRipple = 4e-3;

// Every frame, in every shape, about as fine as a latlong map of `rows` rows.
std::vector<MapGrid> Grids(int rows) {
  std::vector<MapGrid> grids;
  for (const MapFrame frame : kMapFrames) {
    grids.emplace_back(frame, SizeForRows(frame, rows));
  }
  const int face = (rows + 1) / 2;
  grids.emplace_back(MapFrame::kCubeCross, MapSize{4 * face, 3 * face});
  grids.emplace_back(MapFrame::kCubeCross, MapSize{face, 6 * face});
  return grids;
}

std::string Name(const MapGrid& from, const MapGrid& to) {
  return std::string(MapFrameName(from.frame())) + " " +
         std::to_string(from.size().width) + "x" +
         std::to_string(from.size().height) + " to " +
         MapFrameName(to.frame()) + " " + std::to_string(to.size().width) +
         "x" + std::to_string(to.size().height);
}

Array3d SmoothRadiance(const Vector3d& d) {
  return {1.0 + 0.5 * d.x(), 0.2 + d.y() * d.y(), std::exp(d.z() - d.x())};
}

Image SmoothMap(const MapGrid& grid) {
  Image map(grid.size().width, grid.size().height);
  for (size_t t = 0; t < map.num_pixels(); ++t) {
    const auto d = grid.TexelDirection(static_cast<int>(t));
    if (!d.has_value()) continue;
    for (int k = 0; k < 3; ++k) {
      map.rgb[3 * t + k] = static_cast<float>(SmoothRadiance(*d)[k]);
    }
  }
  return map;
}

// Noise over six orders of magnitude and a sun: what light is.
Image RoughMap(const MapGrid& grid) {
  std::mt19937 rng(5);
  std::normal_distribution<double> gauss;
  Image map(grid.size().width, grid.size().height);
  const std::vector<double> angles = grid.SolidAngles();
  for (size_t t = 0; t < map.num_pixels(); ++t) {
    for (int k = 0; k < 3; ++k) {
      const double value = std::exp(2.0 * gauss(rng));
      if (angles[t] > 0.0) map.rgb[3 * t + k] = static_cast<float>(value);
    }
  }
  const int sun = grid.TexelOf(Vector3d(0.4, 0.7, -0.5));
  for (int k = 0; k < 3; ++k) map.rgb[3 * sun + k] = 1e5f;
  return map;
}

Image Converted(const Image& map, const MapGrid& from, const MapGrid& to) {
  StatusOr<Image> out =
      ConvertMap("test", map, from.frame(), to.frame(), to.size());
  EXPECT_TRUE(out.ok()) << out.status().message();
  return *std::move(out);
}

int Brightest(const Image& map) {
  size_t best = 0;
  for (size_t t = 0; t < map.num_pixels(); ++t) {
    if (map.rgb[3 * t] > map.rgb[3 * best]) best = t;
  }
  return static_cast<int>(best);
}

// One bright texel at row 3, column `column` of a 16 x 8 map.
Image OneHot(int column) {
  Image map(16, 8);
  for (int k = 0; k < 3; ++k) map.At(column, 3)[k] = 1.0f + k;
  return map;
}

void ExpectHotColumn(MapFrame from, int column, int expected) {
  const StatusOr<Image> out =
      ConvertMap("test", OneHot(column), from, MapFrame::kCamera, {16, 8});
  ASSERT_TRUE(out.ok());
  EXPECT_EQ(OneHot(expected).rgb, out->rgb) << MapFrameName(from);
}

TEST(ConvertMap, MovesOneHotTexelsByHand) {
  // The column just right of the middle, seen in the camera's frame.
  ExpectHotColumn(MapFrame::kCamera, 8, 8);
  ExpectHotColumn(MapFrame::kIbrdf01, 8, 7);   // mirrored
  ExpectHotColumn(MapFrame::kMitsuba, 8, 0);   // the middle is +z, the border
  ExpectHotColumn(MapFrame::kBlender, 8, 12);  // the middle is +x, 3/4
  ExpectHotColumn(MapFrame::kPolyHavenYUp, 8, 12);
  // The first column.
  ExpectHotColumn(MapFrame::kIbrdf01, 0, 15);
  ExpectHotColumn(MapFrame::kMitsuba, 0, 8);
  ExpectHotColumn(MapFrame::kBlender, 0, 4);
}

TEST(ConvertMap, MovesTexelsBitwiseAndBack) {
  const std::vector<MapFrame> frames = {
      MapFrame::kCamera, MapFrame::kMitsuba, MapFrame::kBlender,
      MapFrame::kPolyHavenYUp, MapFrame::kIbrdf01};
  // An odd height has no quarter turn in whole columns.
  for (const MapSize size : {MapSize{16, 8}, MapSize{20, 10}, MapSize{14, 7}}) {
    for (const MapFrame a : frames) {
      for (const MapFrame b : frames) {
        const MapGrid from(a, size), to(b, size);
        const bool quarter = (from.latlong()->quarters % 2 != 0) !=
                             (to.latlong()->quarters % 2 != 0);
        if (quarter && size.height % 2 != 0) continue;
        Image map = RoughMap(from);
        map.rgb[4] = -0.0f;
        map.rgb[7] = std::nanf("");
        const Image there = Converted(map, from, to);
        // Every texel keeps its direction.
        for (size_t t = 0; t < map.num_pixels(); ++t) {
          const int target = to.TexelOf(*from.TexelDirection(t));
          EXPECT_EQ(
              0, std::memcmp(map.rgb.data() + 3 * t,
                             there.rgb.data() + 3 * target, 3 * sizeof(float)));
        }
        const Image back = Converted(there, to, from);
        EXPECT_EQ(0, std::memcmp(map.rgb.data(), back.rgb.data(),
                                 map.rgb.size() * sizeof(float)));
      }
    }
  }
}

TEST(ConvertMap, KeepsAnyMapOfTheSameFrameAndSize) {
  for (const MapGrid& grid : Grids(6)) {
    const Image map = RoughMap(grid);
    EXPECT_EQ(map.rgb, Converted(map, grid, grid).rgb);
  }
}

TEST(ConvertMap, KeepsDirectionsBetweenAllFrames) {
  // A bright texel is brightest where its direction is.
  for (const MapGrid& from : Grids(8)) {
    for (const MapGrid& to : Grids(16)) {
      for (const Vector3d& d :
           {Vector3d(0.3, 0.5, -0.7), Vector3d(-0.8, 0.3, 0.2),
            Vector3d(0.5, -0.6, 0.4), Vector3d(0.1, 0.2, 0.9)}) {
        Image map(from.size().width, from.size().height);
        const int texel = from.TexelOf(d);
        map.rgb[3 * texel] = 1.0f;
        const Image out = Converted(map, from, to);
        const double cosine =
            to.TexelDirection(Brightest(out))->dot(*from.TexelDirection(texel));
        // The distance of the centres of overlapping texels: half diagonals of
        // texels of 22 and 11 degrees, and a probe's are twice as long at its
        // rim.
        EXPECT_GT(cosine, std::cos(0.5)) << Name(from, to);
      }
    }
  }
}

TEST(ConvertMap, RoundTripsOfSmoothMapsBetweenAllFrames) {
  double worst = 0.0;
  for (const MapGrid& from : Grids(24)) {
    const Image map = SmoothMap(from);
    for (const MapGrid& to : Grids(32)) {
      const Image back = Converted(Converted(map, from, to), to, from);
      const std::vector<double> angles = from.SolidAngles();
      double error = 0.0, norm = 0.0;
      for (size_t i = 0; i < map.rgb.size(); ++i) {
        error += angles[i / 3] * std::pow(map.rgb[i] - back.rgb[i], 2);
        norm += angles[i / 3] * std::pow(map.rgb[i], 2);
      }
      worst = std::max(worst, std::sqrt(error / norm));
      // A texel of 8 degrees takes over from its neighbours, whose radiance
      // differs by up to 10 %, a fraction of that.
      EXPECT_LT(std::sqrt(error / norm), 0.03) << Name(from, to);
    }
  }
  RecordProperty("worst_round_trip", std::to_string(worst));
}

TEST(ConvertMap, KeepsSmoothRadianceBetweenAllFrames) {
  double worst = 0.0;
  for (const MapGrid& from : Grids(24)) {
    for (const MapGrid& to : Grids(16)) {
      const Image out = Converted(SmoothMap(from), from, to);
      const Image expected = SmoothMap(to);
      const std::vector<double> angles = to.SolidAngles();
      double error = 0.0, norm = 0.0;
      for (size_t i = 0; i < out.rgb.size(); ++i) {
        error += angles[i / 3] * std::pow(expected.rgb[i] - out.rgb[i], 2);
        norm += angles[i / 3] * std::pow(expected.rgb[i], 2);
      }
      worst = std::max(worst, std::sqrt(error / norm));
      // Up to a quarter of a texel of 8 degrees at the borders of openexr's
      // faces, whose texels are centred there and lose an outer half.
      EXPECT_LT(std::sqrt(error / norm), 0.05) << Name(from, to);
    }
  }
  RecordProperty("worst_smooth", std::to_string(worst));
}

TEST(ConvertMap, KeepsTheLightBetweenAllFrames) {
  for (const int rows : {7, 20}) {
    for (const MapGrid& from : Grids(12)) {
      const Image map = RoughMap(from);
      const Array3d before = TotalRadiance(map, from);
      for (const MapGrid& to : Grids(rows)) {
        const Array3d after = TotalRadiance(Converted(map, from, to), to);
        for (int k = 0; k < 3; ++k) {
          EXPECT_NEAR(before[k], after[k], kFloatRounding * before[k])
              << Name(from, to);
        }
      }
    }
  }
}

TEST(ConvertMap, KeepsConstantMaps) {
  double worst = 0.0;
  for (const int rows : {7, 24}) {
    for (const MapGrid& from : Grids(16)) {
      Image map(from.size().width, from.size().height);
      std::fill(map.rgb.begin(), map.rgb.end(), 3.0f);
      for (const MapGrid& to : Grids(rows)) {
        const bool exact =
            from.latlong().has_value() && to.latlong().has_value();
        const Image out = Converted(map, from, to);
        const std::vector<double> angles = to.SolidAngles();
        for (size_t i = 0; i < out.rgb.size(); ++i) {
          if (angles[i / 3] == 0.0) {
            EXPECT_EQ(from.frame() == to.frame() && from.size() == to.size()
                          ? 3.0f
                          : 0.0f,
                      out.rgb[i]);
            continue;
          }
          worst = std::max(worst, std::abs(out.rgb[i] / 3.0 - 1.0));
          EXPECT_NEAR(3.0, out.rgb[i], 3.0 * (exact ? kFloatRounding : kRipple))
              << Name(from, to) << " texel " << i / 3;
        }
      }
    }
  }
  RecordProperty("worst_ripple", std::to_string(worst));
}

// Integral of direction times radiance, texels constant, by the slow reference:
// 12 x 12 points in each texel.
Eigen::Matrix3d SlowMoment(const Image& map, const MapGrid& grid) {
  constexpr int kSide = 12;
  Eigen::Matrix3d moment = Eigen::Matrix3d::Zero();
  for (int r = 0; r < grid.size().height * kSide; ++r) {
    for (int c = 0; c < grid.size().width * kSide; ++c) {
      const MapPoint point = {(c + 0.5) / kSide, (r + 0.5) / kSide};
      const auto d = grid.Direction(point);
      if (!d.has_value()) continue;
      const float* rgb = map.rgb.data() + 3 * grid.TexelAt(point);
      const double weight = grid.Density(point) / (kSide * kSide);
      for (int k = 0; k < 3; ++k) moment.col(k) += weight * rgb[k] * *d;
    }
  }
  return moment;
}

TEST(ConvertMap, KeepsTheDirectionOfTheLight) {
  double worst = 0.0;
  for (const MapGrid& from : Grids(24)) {
    const Image map = RoughMap(from);
    const Eigen::Matrix3d before = SlowMoment(map, from);
    const Array3d total = TotalRadiance(map, from);
    for (const MapGrid& to : Grids(24)) {
      const Eigen::Matrix3d after = SlowMoment(Converted(map, from, to), to);
      for (int k = 0; k < 3; ++k) {
        const double error = (after - before).col(k).norm() / total[k];
        worst = std::max(worst, error);
        // Half a texel of 7.5 degrees, if all light is one texel's.
        EXPECT_LT(error, 0.065) << Name(from, to);
      }
    }
  }
  RecordProperty("worst_moment", std::to_string(worst));
}

TEST(ConvertMap, ResizesAsResizeMapDoes) {
  const MapGrid from(MapFrame::kCamera, {48, 24}),
      to(MapFrame::kCamera, {20, 10});
  const Image map = RoughMap(from);
  const Image ours = Converted(map, from, to);
  const Image theirs = ResizeMap(map, 10, 20);
  for (size_t i = 0; i < ours.rgb.size(); ++i) {
    EXPECT_NEAR(theirs.rgb[i], ours.rgb[i], kFloatRounding * theirs.rgb[i]);
  }
}

TEST(ConvertMap, SampledOverlapsAreNearlyTheExactOnes) {
  // The way for probes and cubes, on latlong maps, whose overlaps are products.
  const MapGrid from(MapFrame::kCamera, {30, 15}),
      to(MapFrame::kOpenExr, {22, 11});
  const Image map = RoughMap(from);
  const Image exact = Converted(map, from, to);
  const std::vector<double> angles = to.SolidAngles();
  std::vector<double> sum(angles.size());
  double difference = 0.0, total = 0.0;
  for (const TexelOverlap& o :
       SampledOverlaps(from, from.SolidAngles(), to, angles, 1)) {
    sum[o.target] += o.solid_angle * map.rgb[3 * o.source];
  }
  for (size_t t = 0; t < sum.size(); ++t) {
    difference += std::abs(sum[t] - angles[t] * exact.rgb[3 * t]);
    total += sum[t];
  }
  RecordProperty("share_misplaced", std::to_string(difference / total));
  // Measured 0.006; nearly all of the light is the sun's.
  EXPECT_LT(difference / total, 0.02);
}

TEST(ConvertMap, ThreadsDoNotChangeTheBits) {
  const MapGrid from(MapFrame::kDebevecProbe, {33, 33});
  const Image map = RoughMap(from);
  for (const MapGrid& to : Grids(20)) {
    const StatusOr<Image> one =
        ConvertMap("t", map, from.frame(), to.frame(), to.size(), 1);
    const StatusOr<Image> three =
        ConvertMap("t", map, from.frame(), to.frame(), to.size(), 3);
    ASSERT_TRUE(one.ok() && three.ok());
    EXPECT_EQ(one->rgb, three->rgb);
  }
}

TEST(ConvertMap, TakesTheSmallestMaps) {
  for (const MapGrid& from : Grids(1)) {
    for (const MapGrid& to : Grids(2)) {
      const Image map = RoughMap(from);
      const Array3d before = TotalRadiance(map, from);
      const Array3d after = TotalRadiance(Converted(map, from, to), to);
      EXPECT_NEAR(before[0], after[0], kFloatRounding * before[0])
          << Name(from, to);
    }
  }
}

TEST(ConvertMap, TheLibrarysFrameIsTheCamerasMirrored) {
  const Image map = RoughMap(MapGrid(kLibraryMapFrame, {16, 8}));
  const Image file = FromLibraryFrame("m", map, MapFrame::kCamera).value();
  ASSERT_EQ(16, file.width);
  for (int r = 0; r < 8; ++r) {
    for (int c = 0; c < 16; ++c) {
      EXPECT_EQ(
          0, std::memcmp(map.At(15 - c, r), file.At(c, r), 3 * sizeof(float)));
    }
  }
  EXPECT_EQ(map.rgb, ToLibraryFrame("m", file, MapFrame::kCamera)->rgb);
  EXPECT_EQ(map.rgb, ToLibraryFrame("m", map, MapFrame::kIbrdf01)->rgb);
  EXPECT_FALSE(ToLibraryFrame("m", map, MapFrame::kCubeCross).ok());
  // As fine as a cross of faces of 4, and of a probe.
  const Image cross = RoughMap(MapGrid(MapFrame::kCubeCross, {12, 16}));
  EXPECT_EQ(16, ToLibraryFrame("m", cross, MapFrame::kCubeCross)->width);
  const Image probe = RoughMap(MapGrid(MapFrame::kDebevecProbe, {7, 7}));
  EXPECT_EQ(8, ToLibraryFrame("m", probe, MapFrame::kDebevecProbe)->width);
}

TEST(ConvertMap, RefusesSizesOfOtherFrames) {
  const Image square(8, 8);
  EXPECT_EQ(
      "a.exr: frame camera expects a width of twice the height (2:1), found "
      "8x8 texels, which fits debevec_probe",
      ConvertMap("a.exr", square, MapFrame::kCamera, MapFrame::kOpenExr,
                 {16, 8})
          .status()
          .message());
  EXPECT_EQ(
      "a.exr: frame cube_cross expects a vertical cross (3:4), a horizontal "
      "cross (4:3) or a column of faces (1:6), found 16x8 texels, which fits "
      "camera, openexr, mitsuba, blender, polyhaven_y_up, ibrdf_0_1",
      ConvertMap("a.exr", square, MapFrame::kDebevecProbe, MapFrame::kCubeCross,
                 {16, 8})
          .status()
          .message());
  EXPECT_FALSE(ConvertMap("a.exr", Image(), MapFrame::kCamera,
                          MapFrame::kCamera, {16, 8})
                   .ok());
}

TEST(PeriodicParts, CoverEachIntervalOnce) {
  const std::vector<double> edges = {0.0, 0.2, 0.5, 1.0};
  const std::vector<double> from = {-0.1, 0.3, 0.9, -1.5, 0.0, 2.0};
  const std::vector<double> to = {0.1, 0.4, 1.3, -0.5, 1.0, 2.2};
  const auto parts = PeriodicParts(from, to, edges);
  ASSERT_EQ(from.size(), parts.size());
  for (size_t i = 0; i < from.size(); ++i) {
    double sum = 0.0;
    for (const IntervalPart& part : parts[i]) sum += part.length;
    EXPECT_NEAR(to[i] - from[i], sum, 1e-15) << i;
  }
  ASSERT_EQ(2u, parts[0].size());
  EXPECT_EQ(2, parts[0][0].source);
  EXPECT_EQ(0, parts[0][1].source);
  ASSERT_EQ(3u, parts[2].size());
  EXPECT_NEAR(0.1, parts[2][2].length, 1e-15);
  EXPECT_EQ(1, parts[2][2].source);
}

}  // namespace
}  // namespace ibrdf
