#include "ibrdf/light/map_frame.h"

#include <ImathBox.h>
#include <ImathVec.h>
#include <OpenEXR/ImfEnvmap.h>
#include <gtest/gtest.h>

#include <cmath>
#include <random>
#include <string>

#include "ibrdf/base/pi.h"
#include "tests/light/rounding.h"

namespace ibrdf {
namespace {

using Eigen::Vector3d;

const Vector3d kRight(1, 0, 0), kLeft(-1, 0, 0), kUp(0, 1, 0), kDown(0, -1, 0),
    kBack(0, 0, 1), kAhead(0, 0, -1);

void ExpectDirection(const MapGrid& grid, double column, double row,
                     const Vector3d& expected) {
  const std::optional<Vector3d> found = grid.Direction({column, row});
  ASSERT_TRUE(found.has_value())
      << MapFrameName(grid.frame()) << " " << column << ", " << row;
  EXPECT_LT((*found - expected.normalized()).norm(), kRounding)
      << MapFrameName(grid.frame()) << " " << column << ", " << row << ": "
      << found->transpose();
}

// Sizes of every shape of every frame.
std::vector<MapGrid> AllGrids() {
  std::vector<MapGrid> grids;
  for (const MapFrame frame : kMapFrames) {
    if (frame == MapFrame::kDebevecProbe) {
      grids.emplace_back(frame, MapSize{16, 16});
      grids.emplace_back(frame, MapSize{15, 15});
    } else if (frame == MapFrame::kCubeCross) {
      grids.emplace_back(frame, MapSize{15, 20});
      grids.emplace_back(frame, MapSize{24, 18});
      grids.emplace_back(frame, MapSize{5, 30});
    } else {
      grids.emplace_back(frame, MapSize{16, 8});
      grids.emplace_back(frame, MapSize{14, 7});
    }
  }
  grids.emplace_back(MapFrame::kOpenExr, MapSize{6, 36});
  grids.emplace_back(MapFrame::kOpenExr, MapSize{1, 6});
  grids.emplace_back(MapFrame::kOpenExr, MapSize{2, 1});
  return grids;
}

std::vector<Vector3d> RandomDirections(int count) {
  std::mt19937 rng(3);
  std::normal_distribution<double> gauss;
  std::vector<Vector3d> directions;
  for (int i = 0; i < count; ++i) {
    directions.push_back({gauss(rng), gauss(rng), gauss(rng)});
  }
  return directions;
}

// The left border, left quarter, middle and right quarter of the horizon.
void ExpectHorizon(MapFrame frame, const Vector3d& border,
                   const Vector3d& left_quarter, const Vector3d& middle,
                   const Vector3d& right_quarter) {
  const MapGrid grid(frame, {16, 8});
  ExpectDirection(grid, 0, 4, border);
  ExpectDirection(grid, 4, 4, left_quarter);
  ExpectDirection(grid, 8, 4, middle);
  ExpectDirection(grid, 12, 4, right_quarter);
  ExpectDirection(grid, 16, 4, border);
  ExpectDirection(grid, 5, 0, kUp);
  ExpectDirection(grid, 5, 8, kDown);
  // Halfway up, in the middle.
  ExpectDirection(grid, 8, 2, middle + kUp);
}

TEST(MapFrame, CameraLooksAtTheMiddle) {
  ExpectHorizon(MapFrame::kCamera, kBack, kLeft, kAhead, kRight);
}

TEST(MapFrame, MitsubaHasMinusZAtItsBorder) {
  // phi = 0: (sin 0, -cos 0) = -z; a quarter: (1, 0) = +x.
  ExpectHorizon(MapFrame::kMitsuba, kAhead, kRight, kBack, kLeft);
}

TEST(MapFrame, BlenderHasItsXInTheMiddle) {
  // Blender's X, Y, Z are right, ahead, up. u = 1/2 - atan2(Y, X) / (2 pi): X
  // is the middle, Y the left quarter.
  ExpectHorizon(MapFrame::kBlender, kLeft, kAhead, kRight, kBack);
}

TEST(MapFrame, PolyHavenIsThatOfThreeJs) {
  // u = 1/2 + atan2(z, x) / (2 pi): x is the middle, z the right quarter.
  ExpectHorizon(MapFrame::kPolyHavenYUp, kLeft, kAhead, kRight, kBack);
}

TEST(MapFrame, Ibrdf01IsTheMirroredMapOfThisProject) {
  ExpectHorizon(MapFrame::kIbrdf01, kBack, kRight, kAhead, kLeft);
  const MapGrid grid(MapFrame::kIbrdf01, {16, 8});
  for (const Vector3d& d : RandomDirections(200)) {
    double row = 0.0, column = 0.0;
    MapPosition(d, 8, 16, &row, &column);
    const MapPoint point = grid.Position(d);
    EXPECT_NEAR(row, point.row, 16 * kRounding);
    EXPECT_NEAR(column, point.column, 16 * kRounding);
  }
}

TEST(MapFrame, OpenExrHasCentresOnTheBorders) {
  // "Pixel (min.x, min.y) has latitude +pi/2 and longitude +pi; pixel (max.x,
  // max.y) has latitude -pi/2 and longitude -pi"; longitude 0 is +z, pi/2 +x.
  const MapGrid grid(MapFrame::kOpenExr, {18, 9});
  ExpectDirection(grid, 0.5, 0.5, kUp);
  ExpectDirection(grid, 17.5, 8.5, kDown);
  ExpectDirection(grid, 0.5, 4.5, kAhead);
  ExpectDirection(grid, 17.5, 4.5, kAhead);
  ExpectDirection(grid, 9, 4.5, kBack);
  ExpectDirection(grid, 0.5 + 17 * 0.25, 4.5, kRight);
  ExpectDirection(grid, 0.5 + 17 * 0.75, 4.5, kLeft);
  EXPECT_FALSE(grid.Direction({0.4, 4.5}).has_value());
  EXPECT_FALSE(grid.Direction({9, 8.6}).has_value());
}

TEST(MapFrame, OpenExrLatLongIsThatOfItsLibrary) {
  const MapGrid grid(MapFrame::kOpenExr, {18, 9});
  const Imath::Box2i window(Imath::V2i(0, 0), Imath::V2i(17, 8));
  for (int r = 0; r < 9; ++r) {
    for (int c = 0; c < 18; ++c) {
      const Imath::V3f d = Imf::LatLongMap::direction(window, Imath::V2f(c, r));
      const std::optional<Vector3d> ours = grid.TexelDirection(r * 18 + c);
      EXPECT_LT((*ours - Vector3d(d.x, d.y, d.z)).norm(), kFloatRounding);
    }
  }
  for (const Vector3d& d : RandomDirections(200)) {
    const Imath::V2f theirs =
        Imf::LatLongMap::pixelPosition(window, Imath::V3f(d.x(), d.y(), d.z()));
    const MapPoint ours = grid.Position(d);
    EXPECT_NEAR(theirs.x + 0.5, ours.column, 18 * kFloatRounding);
    EXPECT_NEAR(theirs.y + 0.5, ours.row, 18 * kFloatRounding);
  }
}

TEST(MapFrame, OpenExrCubeIsThatOfItsLibrary) {
  constexpr int kFace = 5;
  const Imath::Box2i window(Imath::V2i(0, 0),
                            Imath::V2i(kFace - 1, 6 * kFace - 1));
  for (const MapFrame frame : {MapFrame::kOpenExr, MapFrame::kCubeCross}) {
    const MapGrid grid(frame, {kFace, 6 * kFace});
    for (int f = 0; f < 6; ++f) {
      const Imf::CubeMapFace face = static_cast<Imf::CubeMapFace>(f);
      for (int k = 0; k < kFace * kFace; ++k) {
        const Imath::V2f in_face(k % kFace, k / kFace);
        const Imath::V3f d =
            Imf::CubeMap::direction(face, window, in_face).normalized();
        const Imath::V2f pixel =
            Imf::CubeMap::pixelPosition(face, window, in_face);
        const std::optional<Vector3d> ours =
            grid.Direction({pixel.x + 0.5, pixel.y + 0.5});
        EXPECT_LT((*ours - Vector3d(d.x, d.y, d.z)).norm(), kFloatRounding)
            << "face " << f << " point " << k;
      }
    }
  }
}

TEST(MapFrame, OpenExrCubeIsThatOfItsDrawing) {
  // The corners 0 to 7 of the drawing in ImfEnvmap.h: bit 0 is +x, and 0 1 4 5
  // are below, 0 to 3 behind. Per face: top left, top right, bottom left.
  const auto corner = [](int i) {
    return Vector3d(i & 1 ? 1 : -1, i & 2 ? 1 : -1, i & 4 ? 1 : -1);
  };
  const int corners[6][3] = {{3, 7, 1}, {6, 2, 4}, {6, 7, 2},
                             {0, 1, 4}, {7, 6, 5}, {2, 3, 0}};
  const MapGrid grid(MapFrame::kOpenExr, {4, 24});
  for (int f = 0; f < 6; ++f) {
    ExpectDirection(grid, 0.5, 4 * f + 0.5, corner(corners[f][0]));
    ExpectDirection(grid, 3.5, 4 * f + 0.5, corner(corners[f][1]));
    ExpectDirection(grid, 0.5, 4 * f + 3.5, corner(corners[f][2]));
  }
}

TEST(MapFrame, ProbeLooksAheadInTheMiddleAndBackAtItsRim) {
  const MapGrid grid(MapFrame::kDebevecProbe, {16, 16});
  ExpectDirection(grid, 8, 8, kAhead);
  ExpectDirection(grid, 12, 8, kRight);
  ExpectDirection(grid, 4, 8, kLeft);
  ExpectDirection(grid, 8, 4, kUp);
  ExpectDirection(grid, 8, 12, kDown);
  ExpectDirection(grid, 16, 8, kBack);
  ExpectDirection(grid, 8, 0, kBack);
  // The angle is linear along the radius: 45 degrees at a quarter of it.
  ExpectDirection(grid, 10, 8, kAhead + kRight);
  ExpectDirection(grid, 14, 8, kBack + kRight);
  EXPECT_FALSE(grid.Direction({1, 1}).has_value());
}

// Middle, right border and upper border of the face in a cell.
void ExpectFace(const MapGrid& grid, int n, int across, int down,
                const Vector3d& middle, const Vector3d& right,
                const Vector3d& up) {
  const double x = n * (across + 0.5), y = n * (down + 0.5);
  // A quarter of a face from the middle is half the way to its border.
  ExpectDirection(grid, x, y, middle);
  ExpectDirection(grid, x + 0.25 * n, y, middle + 0.5 * right);
  ExpectDirection(grid, x, y - 0.25 * n, middle + 0.5 * up);
  ExpectDirection(grid, x - 0.25 * n, y + 0.25 * n,
                  middle - 0.5 * right - 0.5 * up);
}

TEST(MapFrame, VerticalCrossFolds) {
  const MapGrid grid(MapFrame::kCubeCross, {12, 16});
  ExpectFace(grid, 4, 1, 0, kUp, kRight, kBack);
  ExpectFace(grid, 4, 0, 1, kLeft, kAhead, kUp);
  ExpectFace(grid, 4, 1, 1, kAhead, kRight, kUp);
  ExpectFace(grid, 4, 2, 1, kRight, kBack, kUp);
  ExpectFace(grid, 4, 1, 2, kDown, kRight, kAhead);
  ExpectFace(grid, 4, 1, 3, kBack, kRight, kDown);  // on its head
  EXPECT_FALSE(grid.Direction({1, 1}).has_value());
  EXPECT_FALSE(grid.Direction({11, 15}).has_value());
}

TEST(MapFrame, HorizontalCrossFolds) {
  const MapGrid grid(MapFrame::kCubeCross, {16, 12});
  ExpectFace(grid, 4, 1, 0, kUp, kRight, kBack);
  ExpectFace(grid, 4, 0, 1, kLeft, kAhead, kUp);
  ExpectFace(grid, 4, 1, 1, kAhead, kRight, kUp);
  ExpectFace(grid, 4, 2, 1, kRight, kBack, kUp);
  ExpectFace(grid, 4, 3, 1, kBack, kLeft, kUp);
  ExpectFace(grid, 4, 1, 2, kDown, kRight, kAhead);
  EXPECT_FALSE(grid.Direction({13, 1}).has_value());
}

TEST(MapFrame, FacesOfACrossMeetWhereTheirCellsDo) {
  constexpr double kStep = 1e-9;
  for (const MapSize size : {MapSize{12, 16}, MapSize{16, 12}}) {
    const MapGrid grid(MapFrame::kCubeCross, size);
    int borders = 0;
    for (int k = 0; k < 2 * 12; ++k) {
      const bool vertical = k % 2 == 0;  // border to the right, or below
      const int across = (k / 2) % (size.width / 4);
      const int down = (k / 2) / (size.width / 4);
      for (const double along : {0.3, 2.0, 3.9}) {
        const MapPoint before =
            vertical ? MapPoint{4.0 * across + 4 - kStep, 4 * down + along}
                     : MapPoint{4 * across + along, 4.0 * down + 4 - kStep};
        const MapPoint after =
            vertical ? MapPoint{4.0 * across + 4 + kStep, 4 * down + along}
                     : MapPoint{4 * across + along, 4.0 * down + 4 + kStep};
        const std::optional<Vector3d> a = grid.Direction(before);
        const std::optional<Vector3d> b = grid.Direction(after);
        if (!a.has_value() || !b.has_value()) continue;
        EXPECT_LT((*a - *b).norm(), 2 * kStep) << across << ", " << down;
        ++borders;
      }
    }
    EXPECT_EQ(5 * 3, borders);  // a tree of six faces
  }
}

TEST(MapFrame, MapsSeenFromWithinAreNotMirrored) {
  // To the right, then up, is counterclockwise as seen from within.
  for (const MapGrid& grid : AllGrids()) {
    const double sign = grid.frame() == MapFrame::kIbrdf01 ? -1.0 : 1.0;
    for (const Vector3d& d : RandomDirections(100)) {
      constexpr double kStep = 1e-6;
      const MapPoint p = grid.Position(d);
      const auto right = grid.Direction({p.column + kStep, p.row});
      const auto up = grid.Direction({p.column, p.row - kStep});
      const auto here = grid.Direction(p);
      if (!right || !up || !here) continue;  // at a border
      // d . (right x up) < 0: we stand in the sphere and look outward.
      EXPECT_LT(sign * here->dot((*right - *here).cross(*up - *here)), 0.0)
          << MapFrameName(grid.frame());
    }
  }
}

TEST(MapFrame, PositionInvertsDirection) {
  for (const MapGrid& grid : AllGrids()) {
    for (const Vector3d& d : RandomDirections(500)) {
      const std::optional<Vector3d> again = grid.Direction(grid.Position(d));
      ASSERT_TRUE(again.has_value()) << MapFrameName(grid.frame());
      EXPECT_LT((*again - d.normalized()).norm(), 10 * kRounding)
          << MapFrameName(grid.frame());
    }
    // Poles and axes lie on seams.
    for (const Vector3d& d : {kRight, kLeft, kUp, kDown, kBack, kAhead,
                              Vector3d(1, 1, 1), Vector3d(-1, -1, 1)}) {
      const std::optional<Vector3d> again = grid.Direction(grid.Position(d));
      ASSERT_TRUE(again.has_value()) << MapFrameName(grid.frame());
      EXPECT_LT((*again - d.normalized()).norm(), 10 * kRounding)
          << MapFrameName(grid.frame());
    }
  }
}

TEST(MapFrame, TexelsOwnTheirCentres) {
  for (const MapGrid& grid : AllGrids()) {
    const std::vector<double> angles = grid.SolidAngles();
    double total = 0.0;
    for (size_t t = 0; t < angles.size(); ++t) {
      total += angles[t];
      const int texel = static_cast<int>(t);
      const std::optional<Vector3d> d = grid.TexelDirection(texel);
      EXPECT_EQ(d.has_value(), angles[t] > 0.0)
          << MapFrameName(grid.frame()) << " " << t;
      const double x = texel % grid.size().width + 0.5;
      const double y = texel / grid.size().width + 0.5;
      if (d.has_value()) {
        EXPECT_EQ(texel, grid.TexelAt({x, y}));
      }
    }
    EXPECT_NEAR(4.0 * kPi, total, 1e-11) << MapFrameName(grid.frame());
    for (const Vector3d& d : RandomDirections(2000)) {
      EXPECT_GT(angles[grid.TexelOf(d)], 0.0);
    }
    for (const Vector3d& d :
         {kRight, kLeft, kUp, kDown, kBack, kAhead, Vector3d(1, 1, 1),
          Vector3d(1, -1, 1), Vector3d(-1, -1, -1), Vector3d(1, -1, 0)}) {
      EXPECT_GT(angles[grid.TexelOf(d)], 0.0) << MapFrameName(grid.frame());
    }
  }
}

TEST(MapFrame, SolidAnglesAreThoseOfRandomDirections) {
  constexpr int kCount = 400000;
  const std::vector<Vector3d> directions = RandomDirections(kCount);
  for (const MapGrid& grid : AllGrids()) {
    const std::vector<double> angles = grid.SolidAngles();
    std::vector<int> hits(angles.size());
    for (const Vector3d& d : directions) ++hits[grid.TexelOf(d)];
    for (size_t t = 0; t < angles.size(); ++t) {
      const double expected = kCount * angles[t] / (4.0 * kPi);
      // Five standard deviations of a count, and its unit.
      EXPECT_NEAR(expected, hits[t], 5.0 * std::sqrt(expected) + 1.0)
          << MapFrameName(grid.frame()) << " " << t;
    }
  }
}

TEST(MapFrame, DensityIsTheSolidAngleOfAnArea) {
  constexpr double kStep = 1e-4;
  for (const MapGrid& grid : AllGrids()) {
    for (const Vector3d& d : RandomDirections(100)) {
      const MapPoint p = grid.Position(d);
      const auto here = grid.Direction(p);
      const auto right = grid.Direction({p.column + kStep, p.row});
      const auto down = grid.Direction({p.column, p.row + kStep});
      if (!right || !down || !here) continue;
      const double area =
          (*right - *here).cross(*down - *here).norm() / (kStep * kStep);
      EXPECT_NEAR(area, grid.Density(p), 1e-3 * area + 1e-5)
          << MapFrameName(grid.frame());
    }
  }
}

TEST(MapFrame, NamesAreRead) {
  for (const MapFrame frame : kMapFrames) {
    const StatusOr<MapFrame> read = ParseMapFrame("file", MapFrameName(frame));
    ASSERT_TRUE(read.ok());
    EXPECT_EQ(frame, *read);
  }
  const StatusOr<MapFrame> wrong = ParseMapFrame("a.yaml: frame", "maya");
  ASSERT_FALSE(wrong.ok());
  EXPECT_EQ(
      "a.yaml: frame: expected one of camera, openexr, mitsuba, blender, "
      "polyhaven_y_up, debevec_probe, cube_cross, ibrdf_0_1, found maya",
      wrong.status().message());
}

TEST(MapFrame, SizesThatAreNoMapsAreRefused) {
  const auto ok = [](MapFrame frame, int width, int height) {
    return CheckMapSize("f", frame, {width, height}).ok();
  };
  for (const MapFrame frame : kMapFrames) {
    const bool probe = frame == MapFrame::kDebevecProbe;
    const bool cross = frame == MapFrame::kCubeCross;
    const bool openexr = frame == MapFrame::kOpenExr;
    EXPECT_EQ(!probe && !cross, ok(frame, 64, 32));
    EXPECT_EQ(!probe && !cross, ok(frame, 2, 1));
    EXPECT_EQ(probe, ok(frame, 64, 64));
    EXPECT_EQ(probe, ok(frame, 1, 1));
    EXPECT_EQ(cross, ok(frame, 12, 16));
    EXPECT_EQ(cross, ok(frame, 16, 12));
    EXPECT_EQ(cross || openexr, ok(frame, 5, 30));
    for (const auto& [w, h] : {std::pair{0, 0},
                               {0, 1},
                               {1, 0},
                               {-2, -1},
                               {64, 31},
                               {65, 32},
                               {3, 5},
                               {30, 5},
                               {64, 48 + 1},
                               {2147483647, 2147483647},
                               {32, 64},
                               {1 << 16, 1 << 15},
                               {1 << 30, 1 << 29}}) {
      EXPECT_FALSE(ok(frame, w, h)) << MapFrameName(frame) << w << "x" << h;
    }
  }
}

TEST(MapFrame, RefusalsNameFrameAndSizes) {
  EXPECT_EQ(
      "a.exr: frame openexr expects a width of twice the height (2:1, latlong) "
      "or a column of faces (1:6), found 512x512 texels, which fits "
      "debevec_probe",
      CheckMapSize("a.exr", MapFrame::kOpenExr, {512, 512}).message());
  EXPECT_EQ(
      "a.exr: frame camera expects a width of twice the height (2:1), found "
      "7x5 texels, which fits no frame",
      CheckMapSize("a.exr", MapFrame::kCamera, {7, 5}).message());
  EXPECT_EQ(
      "a.exr: frame debevec_probe expects a square image, found 4x24 texels, "
      "which fits openexr, cube_cross",
      CheckMapSize("a.exr", MapFrame::kDebevecProbe, {4, 24}).message());
}

TEST(MapFrame, SizesForRowsAreMaps) {
  for (const MapFrame frame : kMapFrames) {
    for (const int rows : {1, 2, 7, 64, 1000}) {
      EXPECT_TRUE(CheckMapSize("f", frame, SizeForRows(frame, rows)).ok());
    }
  }
  for (const MapFrame frame : kMapFrames) {
    for (const int rows : {1, 2, 7, 64, 1000}) {
      // Faces of a cube have whole texels.
      const int even =
          frame == MapFrame::kCubeCross ? (rows + 1) / 2 * 2 : rows;
      EXPECT_EQ(even, RowsForSize(frame, SizeForRows(frame, rows)));
    }
  }
  EXPECT_EQ(10, RowsForSize(MapFrame::kOpenExr, {5, 30}));
  EXPECT_EQ(10, RowsForSize(MapFrame::kCubeCross, {20, 15}));
  EXPECT_EQ(4, RowsForSize(MapFrame::kDebevecProbe, {7, 7}));
  EXPECT_EQ((MapSize{128, 64}), SizeForRows(MapFrame::kCamera, 64));
  EXPECT_EQ((MapSize{128, 128}), SizeForRows(MapFrame::kDebevecProbe, 64));
  EXPECT_EQ((MapSize{96, 128}), SizeForRows(MapFrame::kCubeCross, 64));
}

}  // namespace
}  // namespace ibrdf
