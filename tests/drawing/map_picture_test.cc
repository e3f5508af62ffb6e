#include "ibrdf/solvers/drawing/map_picture.h"

#include <gtest/gtest.h>

#include <cmath>

#include "ibrdf/light/convert_map.h"

namespace ibrdf {
namespace {

using Eigen::Vector3d;

constexpr int kBall = 129;

// A lamp of some texels around a direction, on black.
Image Lamp(MapFrame frame, MapSize size, const Vector3d& direction,
           double degrees) {
  const MapGrid grid(frame, size);
  Image map(size.width, size.height);
  for (int t = 0; t < static_cast<int>(size.num_texels()); ++t) {
    const auto d = grid.TexelDirection(t);
    if (!d.has_value()) continue;
    const bool lit = d->dot(direction) > std::cos(degrees * 3.14159265 / 180);
    for (int c = 0; c < 3; ++c) {
      map.rgb[size_t{3} * t + c] = lit ? 1.0f : 0.0f;
    }
  }
  return map;
}

struct Spot {
  double x = 0.0, y = 0.0;  // in [-1, 1], y up
  int pixels = 0;
};

// The middle of what is white.
Spot WhiteSpot(const Rgb8Image& ball) {
  Spot spot;
  for (int v = 0; v < ball.height; ++v) {
    for (int u = 0; u < ball.width; ++u) {
      const double x = 2 * (u + 0.5) / ball.width - 1;
      const double y = 1 - 2 * (v + 0.5) / ball.height;
      if (x * x + y * y > 0.98 || ball.At(u, v)[0] < 128) continue;
      spot.x += x;
      spot.y += y;
      ++spot.pixels;
    }
  }
  if (spot.pixels > 0) {
    spot.x /= spot.pixels;
    spot.y /= spot.pixels;
  }
  return spot;
}

TEST(MapPicture, BallShowsALampWhereTheReflectionLawSays) {
  // The normal halves the angle between the lamp and the camera, +z.
  for (const MapFrame frame : kMapFrames) {
    const MapSize size = SizeForRows(frame, 64);
    for (const Vector3d& towards :
         {Vector3d(1, 0, 0), Vector3d(-1, 0, 0), Vector3d(0, 1, 0),
          Vector3d(0, -1, 0), Vector3d(0, 0, 1), Vector3d(0.5, 0.6, -0.3),
          Vector3d(-0.4, 0.2, 0.8)}) {
      const Vector3d d = towards.normalized();
      const Vector3d n = (d + Vector3d(0, 0, 1)).normalized();
      const Spot spot =
          WhiteSpot(DrawMirrorBall(Lamp(frame, size, d, 8.0), frame, kBall));
      ASSERT_GT(spot.pixels, 3) << MapFrameName(frame);
      // The lamp's 8 degrees are 4 of the normal, 0.07 at most; its middle is
      // off by a part of that where the ball foreshortens it.
      EXPECT_NEAR(n.x(), spot.x, 0.03) << MapFrameName(frame);
      EXPECT_NEAR(n.y(), spot.y, 0.03) << MapFrameName(frame);
    }
  }
}

TEST(MapPicture, BallIsTheSameInEveryFrame) {
  const MapSize size = SizeForRows(MapFrame::kCamera, 64);
  const Image map =
      Lamp(MapFrame::kCamera, size, Vector3d(0.5, 0.6, -0.3).normalized(), 20);
  const Spot expected =
      WhiteSpot(DrawMirrorBall(map, MapFrame::kCamera, kBall));
  for (const MapFrame frame : kMapFrames) {
    const Image other =
        ConvertMap("map", map, MapFrame::kCamera, frame, SizeForRows(frame, 64))
            .value();
    const Spot spot = WhiteSpot(DrawMirrorBall(other, frame, kBall));
    EXPECT_NEAR(expected.x, spot.x, 0.02) << MapFrameName(frame);
    EXPECT_NEAR(expected.y, spot.y, 0.02) << MapFrameName(frame);
  }
  // As another frame it is elsewhere.
  const Spot mirrored =
      WhiteSpot(DrawMirrorBall(map, MapFrame::kIbrdf01, kBall));
  EXPECT_NEAR(-expected.x, mirrored.x, 0.02);
}

TEST(MapPicture, BallIsADiscOnTheGround) {
  Image map(16, 8);
  map.rgb[0] = 1.0f;
  const Rgb8Image ball = DrawMirrorBall(map, MapFrame::kCamera, 64);
  EXPECT_EQ(64, ball.width);
  EXPECT_EQ(64, ball.height);
  EXPECT_EQ(250, ball.At(0, 0)[0]);
  EXPECT_EQ(250, ball.At(63, 63)[2]);
}

// Whether a pixel is of an arrow.
bool IsRed(const uint8_t* rgb) { return rgb[0] > 150 && rgb[1] < 80; }
bool IsBlue(const uint8_t* rgb) { return rgb[2] > 150 && rgb[0] < 80; }

TEST(MapPicture, ArrowsPointToTheRightAndUp) {
  for (const MapFrame frame : kMapFrames) {
    const MapSize size = SizeForRows(frame, 64);
    const Image map = Lamp(frame, size, Vector3d(0, 0, 1), 1.0);  // dark
    const Rgb8Image picture = DrawMapAxes(map, frame, 256);
    EXPECT_EQ(256, std::max(picture.width, picture.height));
    const MapGrid grid(frame, size);
    const MapPoint tip = grid.Position(Vector3d(0.3, 0, -1));
    const MapPoint top = grid.Position(Vector3d(0, 0.3, -1));
    const double scale = static_cast<double>(picture.width) / size.width;
    int red = 0, blue = 0;  // beside where the arrows must pass
    for (int v = 0; v < picture.height; ++v) {
      for (int u = 0; u < picture.width; ++u) {
        const auto near = [&](const MapPoint& p) {
          return std::hypot(u + 0.5 - p.column * scale,
                            v + 0.5 - p.row * scale) < 4.0;
        };
        red += near(tip) && IsRed(picture.At(u, v));
        blue += near(top) && IsBlue(picture.At(u, v));
      }
    }
    EXPECT_GT(red, 3) << MapFrameName(frame);
    EXPECT_GT(blue, 3) << MapFrameName(frame);
  }
}

TEST(MapPicture, TexelsThatStandForNothingAreGrey) {
  const Image map = Lamp(MapFrame::kCubeCross, {48, 64}, Vector3d(0, 1, 0), 90);
  const Rgb8Image picture = DrawMapAxes(map, MapFrame::kCubeCross, 64);
  const uint8_t* corner = picture.At(2, 2);
  EXPECT_NEAR(178, corner[0], 2);
  EXPECT_EQ(corner[0], corner[1]);
}

TEST(MapPicture, TheSmallestMapsAreDrawn) {
  for (const auto& [frame, size] :
       {std::pair{MapFrame::kCamera, MapSize{2, 1}},
        std::pair{MapFrame::kOpenExr, MapSize{2, 1}},
        std::pair{MapFrame::kDebevecProbe, MapSize{1, 1}},
        std::pair{MapFrame::kCubeCross, MapSize{3, 4}},
        std::pair{MapFrame::kCubeCross, MapSize{1, 6}}}) {
    const Image map(size.width, size.height);
    EXPECT_FALSE(DrawMapFrame(map, frame).empty());
    EXPECT_EQ(1, DrawMapAxes(map, frame, 1).width);
  }
}

}  // namespace
}  // namespace ibrdf
