#include "ibrdf/io/map_file.h"

#include <gtest/gtest.h>

#include <cmath>
#include <limits>

#include "ibrdf/base/pi.h"
#include "ibrdf/image/rgb8_image.h"
#include "ibrdf/io/exr.h"
#include "ibrdf/io/png.h"
#include "ibrdf/io/radiance_hdr.h"
#include "ibrdf/light/environment_map.h"
#include "tests/support/temp_dir.h"

namespace ibrdf {
namespace {

using Eigen::Vector3d;

constexpr char kNoWord[] = "";

// One bright texel on a dim ground.
Image OneHot(int width, int height, int column, int row) {
  Image map(width, height);
  for (float& v : map.rgb) v = 0.25f;
  for (int c = 0; c < 3; ++c) map.At(column, row)[c] = 8.0f;
  return map;
}

// Where the library's brightest texel looks.
Vector3d Brightest(const Image& map) {
  size_t best = 0;
  for (size_t i = 0; i < map.num_pixels(); ++i) {
    if (map.rgb[3 * i] > map.rgb[3 * best]) best = i;
  }
  return MapDirection(static_cast<double>(best / map.width) + 0.5,
                      static_cast<double>(best % map.width) + 0.5, map.height,
                      map.width);
}

class MapFileTest : public ::testing::Test {
 protected:
  std::string Write(const std::string& name, const Image& map,
                    const ExrMapAttributes& attributes = {}) const {
    const std::string path = dir_.File(name);
    EXPECT_TRUE(WriteExr(map, path, ExrPixelType::kFloat, attributes).ok());
    return path;
  }
  // The one warning of a map; empty where there is none.
  static std::string Warning(const StatusOr<StoredMap>& map) {
    EXPECT_TRUE(map.ok()) << map.status().message();
    if (!map.ok()) return "";
    EXPECT_LE(map->warnings.size(), size_t{1});
    return map->warnings.empty() ? "" : map->warnings[0];
  }

  const TempDir dir_;
};

TEST_F(MapFileTest, AFileThatSaysNothingIsSeenFromWithin) {
  // Texel 6 of 8 is centred at phi = 2 pi 6.5 / 8 - pi = 5/8 pi: right, a
  // little behind.
  const std::string path = Write("a.exr", OneHot(8, 4, 6, 1));
  const StatusOr<StoredMap> stored = ReadStoredMap(path, std::nullopt);
  EXPECT_EQ(kNoWord, Warning(stored));
  EXPECT_EQ(MapFrame::kCamera, stored->frame);
  EXPECT_EQ(8.0f, stored->image.At(6, 1)[0]);
  const double theta = kPi * 1.5 / 4, phi = 0.625 * kPi;
  const Vector3d expected(std::sin(theta) * std::sin(phi), std::cos(theta),
                          -std::sin(theta) * std::cos(phi));
  const Image map = ReadMap(path, std::nullopt).value();
  EXPECT_LT((Brightest(map) - expected).norm(), 1e-12);
  // The files of before are mirrored.
  const Image old = ReadMap(path, MapFrame::kIbrdf01).value();
  EXPECT_LT((Brightest(old) - expected.cwiseProduct(Vector3d(-1, 1, 1))).norm(),
            1e-12);
}

TEST_F(MapFileTest, HeadersAreObeyed) {
  const Image map = OneHot(8, 4, 2, 1);
  ExrMapAttributes latlong;
  latlong.envmap = ExrEnvmap::kLatLong;
  StatusOr<StoredMap> stored =
      ReadStoredMap(Write("l.exr", map, latlong), std::nullopt);
  EXPECT_EQ(kNoWord, Warning(stored));
  EXPECT_EQ(MapFrame::kOpenExr, stored->frame);

  ExrMapAttributes cube;
  cube.envmap = ExrEnvmap::kCube;
  // The middle of the fifth face from the top, +z: behind the camera.
  const std::string path = Write("c.exr", OneHot(3, 18, 1, 4 * 3 + 1), cube);
  stored = ReadStoredMap(path, std::nullopt);
  EXPECT_EQ(kNoWord, Warning(stored));
  EXPECT_EQ(MapFrame::kCubeCross, stored->frame);
  EXPECT_LT((Brightest(ReadMap(path, std::nullopt).value()) - Vector3d(0, 0, 1))
                .norm(),
            0.5);

  // Ours says more than envmap.
  latlong.map_frame = "blender";
  stored = ReadStoredMap(Write("o.exr", map, latlong), std::nullopt);
  EXPECT_EQ(kNoWord, Warning(stored));
  EXPECT_EQ(MapFrame::kBlender, stored->frame);
}

TEST_F(MapFileTest, TheUsersWordWinsWithAWarning) {
  ExrMapAttributes latlong;
  latlong.envmap = ExrEnvmap::kLatLong;
  const std::string path = Write("l.exr", OneHot(8, 4, 2, 1), latlong);
  StatusOr<StoredMap> stored = ReadStoredMap(path, MapFrame::kMitsuba);
  EXPECT_EQ(path +
                ": the frame mitsuba is taken as asked for; the file's "
                "attribute envmap says openexr",
            Warning(stored));
  EXPECT_EQ(MapFrame::kMitsuba, stored->frame);
  EXPECT_EQ(kNoWord, Warning(ReadStoredMap(path, MapFrame::kOpenExr)));

  // Two words for one thing.
  ExrMapAttributes cube;
  cube.envmap = ExrEnvmap::kCube;
  EXPECT_EQ(kNoWord,
            Warning(ReadStoredMap(Write("c.exr", OneHot(2, 12, 0, 0), cube),
                                  MapFrame::kOpenExr)));
  ExrMapAttributes blender;
  blender.map_frame = "blender";
  EXPECT_EQ(kNoWord,
            Warning(ReadStoredMap(Write("b.exr", OneHot(8, 4, 2, 1), blender),
                                  MapFrame::kPolyHavenYUp)));
}

TEST_F(MapFileTest, AttributesThatNameNoFrameAreRefused) {
  ExrMapAttributes attributes;
  attributes.map_frame = "maya\n";
  const std::string path = Write("m.exr", OneHot(8, 4, 2, 1), attributes);
  const Status status = ReadStoredMap(path, std::nullopt).status();
  EXPECT_EQ(StatusCode::kInvalidInput, status.code());
  EXPECT_EQ(
      0u, status.message().find(path + ": attribute ibrdf:frame: expected one "
                                       "of camera, "))
      << status.message();
  EXPECT_EQ(std::string::npos, status.message().find('\n'));
  // Whoever says the frame needs no attribute.
  EXPECT_TRUE(ReadStoredMap(path, MapFrame::kCamera).ok());
}

TEST_F(MapFileTest, OtherShapesNeedAWord) {
  const std::string path = Write("square.exr", OneHot(8, 8, 2, 1));
  EXPECT_EQ(path +
                ": frame camera expects a width of twice the height (2:1), "
                "found 8x8 texels, which fits debevec_probe; the file says no "
                "frame: state it",
            ReadStoredMap(path, std::nullopt).status().message());
  EXPECT_TRUE(ReadStoredMap(path, MapFrame::kDebevecProbe).ok());
  EXPECT_FALSE(ReadStoredMap(path, MapFrame::kCubeCross).ok());
  ExrMapAttributes cube;
  cube.envmap = ExrEnvmap::kCube;
  const std::string wrong = Write("wrong.exr", OneHot(8, 4, 2, 1), cube);
  const std::string message =
      ReadStoredMap(wrong, std::nullopt).status().message();
  EXPECT_NE(std::string::npos, message.find("file's attribute envmap"))
      << message;
}

TEST_F(MapFileTest, FilesOfCodesAreRefused) {
  Rgb8Image picture(8, 4);
  const std::string path = dir_.File("a.png");
  ASSERT_TRUE(WritePng(picture, path).ok());
  const Status status = ReadStoredMap(path, std::nullopt).status();
  EXPECT_EQ(path +
                ": expected radiance in floats (OpenEXR, Radiance HDR, PFM, "
                "TIFF, .npy), found a PNG file of 8 bits, which cuts off lamps "
                "and the sun",
            status.message());
}

TEST_F(MapFileTest, FormatsOfFloatsAreReadByTheirBytes) {
  const Image map = OneHot(8, 4, 2, 1);
  const std::string path = dir_.File("map.bin");
  ASSERT_TRUE(WriteRadianceHdr(map, path).ok());
  EXPECT_EQ(map.rgb, ReadStoredMap(path, std::nullopt)->image.rgb);
  for (const char* bytes : {"", "PF\n8 4\n-1\n", "no map"}) {
    WriteBytes(path, bytes);
    const Status status = ReadStoredMap(path, std::nullopt).status();
    EXPECT_EQ(StatusCode::kInvalidInput, status.code());
    EXPECT_EQ(0u, status.message().find(path)) << status.message();
  }
  EXPECT_EQ(StatusCode::kInvalidInput,
            ReadStoredMap(dir_.File("none.exr"), std::nullopt).status().code());
}

TEST_F(MapFileTest, ValuesBelowZeroAreCountedInTheirFrame) {
  Image map = OneHot(12, 16, 5, 5);  // a vertical cross of faces of 4
  map.At(4, 0)[1] = -1e-4f;
  map.At(7, 15)[2] = -2e-4f;
  map.At(0, 0)[0] = -100.0f;  // a blank corner
  const std::string path = Write("cross.exr", map);
  const StatusOr<StoredMap> stored = ReadStoredMap(path, MapFrame::kCubeCross);
  const std::string warning = Warning(stored);
  EXPECT_EQ(0u, warning.find(path + ": 2 values below 0, down to -0.0002"))
      << warning;
  for (const float v : stored->image.rgb) EXPECT_GE(v, 0.0f);
  map.At(5, 5)[0] = -1.0f;  // too much of the light
  EXPECT_FALSE(ReadStoredMap(Write("bad.exr", map), MapFrame::kCubeCross).ok());
  map.At(5, 5)[0] = std::numeric_limits<float>::quiet_NaN();
  EXPECT_FALSE(ReadStoredMap(Write("nan.exr", map), MapFrame::kCubeCross).ok());
}

TEST_F(MapFileTest, WhatIsWrittenIsReadAsTheSameLight) {
  // Smooth, so that resampling does little: log radiance changes by 1 per
  // radian at most.
  Image map(64, 32);
  for (int r = 0; r < 32; ++r) {
    for (int c = 0; c < 64; ++c) {
      const Vector3d d = MapDirection(r + 0.5, c + 0.5, 32, 64);
      for (int k = 0; k < 3; ++k) {
        map.At(c, r)[k] = static_cast<float>(std::exp(d[k]));
      }
    }
  }
  // Two resamplings, each by less than half a texel, and the ripple of each
  // (convert_map.h).
  constexpr double kResampled = kPi / 32 + 2 * 0.003;
  for (const MapFrame frame : kMapFrames) {
    const std::string path =
        dir_.File(std::string(MapFrameName(frame)) + ".exr");
    ASSERT_TRUE(WriteMap(map, frame, path).ok());
    const StatusOr<StoredMap> stored = ReadStoredMap(path, std::nullopt);
    EXPECT_EQ(kNoWord, Warning(stored));
    EXPECT_EQ(frame, stored->frame);
    const Image again = ReadMap(path, std::nullopt).value();
    ASSERT_EQ(64, again.width);
    ASSERT_EQ(32, again.height);
    const bool moved = frame != MapFrame::kOpenExr &&
                       frame != MapFrame::kDebevecProbe &&
                       frame != MapFrame::kCubeCross;
    if (moved) {
      EXPECT_EQ(map.rgb, again.rgb) << MapFrameName(frame);
      continue;
    }
    double worst = 0.0;
    for (size_t i = 0; i < map.rgb.size(); ++i) {
      worst = std::max<double>(worst,
                               std::abs(std::log(again.rgb[i] / map.rgb[i])));
    }
    EXPECT_LT(worst, kResampled) << MapFrameName(frame);
  }
}

TEST_F(MapFileTest, MapsOfOtherShapesAreWrittenTwiceAsWideAsHigh) {
  const std::string path = dir_.File("a.exr");
  const Image square = OneHot(8, 8, 2, 1);
  ASSERT_TRUE(WriteMap(square, MapFrame::kCamera, path).ok());
  const Image again = ReadMap(path, std::nullopt).value();
  ASSERT_EQ(16, again.width);
  ASSERT_EQ(8, again.height);
  for (int r = 0; r < 8; ++r) {
    for (int c = 0; c < 16; ++c) {
      EXPECT_FLOAT_EQ(square.At(c / 2, r)[0], again.At(c, r)[0]);
    }
  }
}

}  // namespace
}  // namespace ibrdf
