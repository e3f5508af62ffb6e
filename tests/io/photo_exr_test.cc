// OpenEXR pictures: windows, aspect, colours, layers, parts, damage.
#include <ImfChannelList.h>
#include <ImfChromaticitiesAttribute.h>
#include <ImfFrameBuffer.h>
#include <ImfHeader.h>
#include <ImfMultiPartOutputFile.h>
#include <ImfOutputFile.h>
#include <ImfOutputPart.h>
#include <ImfPartType.h>
#include <ImfRgbaFile.h>
#include <ImfStandardAttributes.h>
#include <ImfTileDescription.h>
#include <ImfTiledOutputFile.h>
#include <gtest/gtest.h>

#include <cmath>
#include <cstring>

#include "ibrdf/io/exr.h"
#include "ibrdf/io/photo_file.h"
#include "tests/support/corruption.h"
#include "tests/support/temp_dir.h"

namespace ibrdf {
namespace {

struct NamedPlane {
  std::string name;
  float first;  // values are first, first + 1, ... over the data window
};

Imf::Header HeaderOf(const Imath::Box2i& display, const Imath::Box2i& data,
                     const std::vector<NamedPlane>& planes,
                     const std::string& part = "",
                     const std::string& view = "") {
  Imf::Header header(display, data);
  if (!part.empty()) {
    header.setName(part);
    header.setType(Imf::SCANLINEIMAGE);
  }
  if (!view.empty()) header.setView(view);
  for (const NamedPlane& p : planes) {
    header.channels().insert(p.name, Imf::Channel(Imf::FLOAT));
  }
  return header;
}

// Pixels of the planes, and a frame that shows them.
struct Frame {
  std::vector<std::vector<float>> values;
  Imf::FrameBuffer buffer;

  Frame(const Imath::Box2i& data, const std::vector<NamedPlane>& planes) {
    const size_t width = static_cast<size_t>(data.max.x - data.min.x + 1);
    const size_t height = static_cast<size_t>(data.max.y - data.min.y + 1);
    values.resize(planes.size());
    for (size_t k = 0; k < planes.size(); ++k) {
      for (size_t i = 0; i < width * height; ++i) {
        values[k].push_back(planes[k].first + static_cast<float>(i));
      }
      buffer.insert(planes[k].name,
                    Imf::Slice::Make(Imf::FLOAT, values[k].data(), data,
                                     sizeof(float), sizeof(float) * width));
    }
  }
};

class PhotoExr : public testing::Test {
 protected:
  void Write(const Imf::Header& header, const std::vector<NamedPlane>& planes) {
    Frame frame(header.dataWindow(), planes);
    Imf::OutputFile file(path().c_str(), header);
    file.setFrameBuffer(frame.buffer);
    file.writePixels(header.dataWindow().max.y - header.dataWindow().min.y + 1);
  }
  void Write(const std::vector<NamedPlane>& planes) {
    const Imath::Box2i window({0, 0}, {2, 1});
    Write(HeaderOf(window, window, planes), planes);
  }
  struct Part {
    std::string name;
    std::vector<NamedPlane> planes;
    std::string view;
  };
  void WriteParts(const std::vector<Part>& parts) {
    const Imath::Box2i window({0, 0}, {2, 1});
    std::vector<Imf::Header> headers;
    for (const Part& p : parts) {
      headers.push_back(HeaderOf(window, window, p.planes, p.name, p.view));
    }
    Imf::MultiPartOutputFile file(path().c_str(), headers.data(),
                                  static_cast<int>(headers.size()));
    for (size_t k = 0; k < parts.size(); ++k) {
      Frame frame(window, parts[k].planes);
      Imf::OutputPart part(file, static_cast<int>(k));
      part.setFrameBuffer(frame.buffer);
      part.writePixels(2);
    }
  }
  std::string path() const { return dir_.File("a.exr"); }
  StatusOr<Photo> Read(const std::string& layer = "",
                       PhotoContent content = PhotoContent::kColour) const {
    PhotoOptions options;
    options.layer = layer;
    options.content = content;
    return ReadPhoto(path(), options);
  }
  // The first red value; -1 of a failure.
  float First(const std::string& layer = "",
              PhotoContent content = PhotoContent::kColour) const {
    const StatusOr<Photo> photo = Read(layer, content);
    return photo.ok() ? photo->image.rgb[0] : -1.0f;
  }

  const TempDir dir_;
};

std::vector<NamedPlane> Rgb(const std::string& prefix, float first) {
  return {{prefix + "R", first}, {prefix + "G", first}, {prefix + "B", first}};
}

std::vector<NamedPlane> Both(std::vector<NamedPlane> a,
                             const std::vector<NamedPlane>& b) {
  a.insert(a.end(), b.begin(), b.end());
  return a;
}

TEST_F(PhotoExr, ValuesOfAPlainFileKeepTheirBits) {
  Image image(5, 4);
  for (size_t i = 0; i < image.rgb.size(); ++i) {
    image.rgb[i] = std::pow(10.0f, static_cast<float>(i) - 30.0f);
  }
  image.rgb[7] = -2.0f;
  image.rgb[8] = INFINITY;
  ASSERT_TRUE(WriteExr(image, path()).ok());
  const StatusOr<Photo> photo = Read();
  ASSERT_TRUE(photo.ok()) << photo.status().message();
  EXPECT_EQ(0, std::memcmp(image.rgb.data(), photo->image.rgb.data(),
                           image.rgb.size() * sizeof(float)));
  EXPECT_EQ(PhotoFormat::kExr, photo->format);
  EXPECT_EQ(0, photo->bits);
  EXPECT_EQ(CurveKind::kLinear, photo->curve.kind);
  EXPECT_EQ("OpenEXR", photo->curve.source);
  EXPECT_TRUE(photo->notes.empty());
  EXPECT_TRUE(photo->has_data.empty());
}

TEST_F(PhotoExr, EveryCompression) {
  const Imath::Box2i window({0, 0}, {40, 36});
  for (int c = 0; c < Imf::NUM_COMPRESSION_METHODS; ++c) {
    Imf::Header header = HeaderOf(window, window, Rgb("", 1.0f));
    header.compression() = static_cast<Imf::Compression>(c);
    Write(header, Rgb("", 1.0f));
    const StatusOr<Photo> photo = Read();
    ASSERT_TRUE(photo.ok()) << c << photo.status().message();
    for (size_t i = 0; i < photo->image.rgb.size(); ++i) {
      // PXR24 drops 8 bits; B44 keeps floats; DWA loses some percent.
      const float value = 1.0f + static_cast<float>(i / 3);
      EXPECT_NEAR(value, photo->image.rgb[i], 0.05f * value + 1.0f) << c;
    }
  }
}

TEST_F(PhotoExr, DataWindowInsideTheDisplayWindow) {
  const auto planes = Both(Rgb("", 1.0f), {{"A", 1.0f}});
  Write(HeaderOf({{10, 20}, {15, 23}}, {{12, 21}, {13, 22}}, planes), planes);
  const StatusOr<Photo> photo = Read();
  ASSERT_TRUE(photo.ok()) << photo.status().message();
  ASSERT_EQ(6, photo->image.width);
  ASSERT_EQ(4, photo->image.height);
  EXPECT_EQ(1.0f, *photo->image.At(2, 1));
  EXPECT_EQ(2.0f, *photo->image.At(3, 1));
  EXPECT_EQ(4.0f, *photo->image.At(3, 2));
  EXPECT_EQ(0.0f, *photo->image.At(1, 1));
  ASSERT_EQ(24u, photo->has_data.inside.size());
  EXPECT_EQ(4u, photo->has_data.CountInside());
  EXPECT_EQ(1, photo->has_data.inside[6 + 2]);
  EXPECT_TRUE(photo->opaque.empty());  // alpha has no say where no data are
  ASSERT_EQ(1u, photo->notes.size());
  EXPECT_NE(std::string::npos, photo->notes[0].find("2x2 at (12, 21)"));
}

TEST_F(PhotoExr, OverscanIsCut) {
  const auto planes = Rgb("", 0.0f);
  Write(HeaderOf({{0, 0}, {2, 1}}, {{-2, -1}, {4, 3}}, planes), planes);
  const StatusOr<Photo> photo = Read();
  ASSERT_TRUE(photo.ok()) << photo.status().message();
  ASSERT_EQ(3, photo->image.width);
  ASSERT_EQ(2, photo->image.height);
  EXPECT_TRUE(photo->has_data.empty());
  for (int y = 0; y < 2; ++y) {
    for (int x = 0; x < 3; ++x) {
      EXPECT_EQ(static_cast<float>(7 * (y + 1) + x + 2),
                *photo->image.At(x, y));
    }
  }
  ASSERT_EQ(1u, photo->notes.size());
  // Both: cut on one side, missing on the other.
  Write(HeaderOf({{0, 0}, {2, 1}}, {{1, -1}, {4, 3}}, planes), planes);
  EXPECT_EQ(4u, Read()->has_data.CountInside());
  // No pixel in common.
  Write(HeaderOf({{0, 0}, {2, 1}}, {{3, 0}, {4, 3}}, planes), planes);
  EXPECT_NE(std::string::npos, Read().status().message().find("dataWindow"));
}

TEST_F(PhotoExr, PixelAspectIsReported) {
  const Imath::Box2i window({0, 0}, {2, 1});
  Imf::Header header = HeaderOf(window, window, Rgb("", 1.0f));
  header.pixelAspectRatio() = 2.0f;
  Write(header, Rgb("", 1.0f));
  EXPECT_EQ(2.0, Read()->pixel_aspect);
}

TEST_F(PhotoExr, AlphaBecomesAMask) {
  // 0.5, 1.5, ...: the first pixel is half transparent.
  Write(Both(Rgb("", 1.0f), {{"A", 0.5f}}));
  const StatusOr<Photo> photo = Read();
  ASSERT_TRUE(photo.ok());
  EXPECT_EQ((std::vector<uint8_t>{0, 1, 1, 1, 1, 1}), photo->opaque.inside);
}

TEST_F(PhotoExr, ChromaticitiesBecomeRec709) {
  const Imath::Box2i window({0, 0}, {2, 1});
  // CIE XYZ as R, G, B: of equal amounts, equal energy, whose linear sRGB is
  // the row sums of the matrix of IEC 61966-2-1.
  Imf::Header header = HeaderOf(window, window, Rgb("", 1.0f));
  Imf::addChromaticities(header, Imf::Chromaticities({1, 0}, {0, 1}, {0, 0},
                                                     {1.0f / 3, 1.0f / 3}));
  Write(header, Rgb("", 1.0f));
  const StatusOr<Photo> photo = Read();
  ASSERT_TRUE(photo.ok()) << photo.status().message();
  EXPECT_NEAR(3.2406 - 1.5372 - 0.4986, photo->image.rgb[0], 1e-3);
  EXPECT_NEAR(-0.9689 + 1.8758 + 0.0415, photo->image.rgb[1], 1e-3);
  EXPECT_NEAR(0.0557 - 0.2040 + 1.0570, photo->image.rgb[2], 1e-3);
  ASSERT_EQ(1u, photo->notes.size());
  EXPECT_NE(std::string::npos, photo->notes[0].find("Rec. 709"));
  // Normals are no colours.
  EXPECT_EQ(1.0f, First("", PhotoContent::kNormals));
  // Rec. 709 itself changes nothing.
  Imf::addChromaticities(header, Imf::Chromaticities());
  Write(header, Rgb("", 1.0f));
  EXPECT_EQ(1.0f, First());
  EXPECT_TRUE(Read()->notes.empty());
}

TEST_F(PhotoExr, ChromaticitiesThatSpanNothingAreRefused) {
  const Imath::Box2i window({0, 0}, {2, 1});
  for (const float x : {0.3f, NAN}) {
    Imf::Header header = HeaderOf(window, window, Rgb("", 1.0f));
    Imf::addChromaticities(header, Imf::Chromaticities({x, 0.3f}, {0.3f, 0.3f},
                                                       {0.3f, 0.3f}, {1, 0}));
    Write(header, Rgb("", 1.0f));
    EXPECT_NE(std::string::npos,
              Read().status().message().find("a.exr: chromaticities"));
  }
}

// A smooth picture through OpenEXR's own writer of luminance and chroma.
TEST_F(PhotoExr, LuminanceAndChroma) {
  constexpr int kWidth = 64, kHeight = 48;
  std::vector<Imf::Rgba> pixels;
  for (int y = 0; y < kHeight; ++y) {
    for (int x = 0; x < kWidth; ++x) {
      const float r = 1.0f + 0.5f * std::sin(0.1f * static_cast<float>(x));
      const float b = 1.0f + 0.5f * std::cos(0.1f * static_cast<float>(y));
      pixels.emplace_back(r, 0.8f, b, 1.0f);
    }
  }
  {
    Imf::RgbaOutputFile file(path().c_str(), kWidth, kHeight,
                             Imf::RgbaChannels(Imf::WRITE_YC));
    file.setFrameBuffer(pixels.data(), 1, kWidth);
    file.writePixels(kHeight);
  }
  const StatusOr<Photo> photo = Read();
  ASSERT_TRUE(photo.ok()) << photo.status().message();
  EXPECT_FALSE(photo->grey);
  std::vector<Imf::Rgba> expected(pixels.size());
  {
    Imf::RgbaInputFile file(path().c_str());
    file.setFrameBuffer(expected.data(), 1, kWidth);
    file.readPixels(0, kHeight - 1);
  }
  // Halves of OpenEXR's reader, and of chroma in the file.
  constexpr float kTolerance = 4e-3f;
  for (size_t i = 0; i < pixels.size(); ++i) {
    EXPECT_NEAR(expected[i].r, photo->image.rgb[3 * i], kTolerance) << i;
    EXPECT_NEAR(expected[i].g, photo->image.rgb[3 * i + 1], kTolerance) << i;
    EXPECT_NEAR(expected[i].b, photo->image.rgb[3 * i + 2], kTolerance) << i;
    // The writer rounds Y to 7 bits and RY to 5; the last column repeats the
    // chroma before it.
    if (i % kWidth < kWidth - 2) {
      EXPECT_NEAR(pixels[i].r, photo->image.rgb[3 * i], 2e-2f) << i;
    }
  }
}

TEST_F(PhotoExr, ChromaOfEveryPixelAndGrey) {
  Write({{"Y", 2.0f}, {"RY", 0.0f}, {"BY", 0.0f}});
  const StatusOr<Photo> photo = Read();
  ASSERT_TRUE(photo.ok()) << photo.status().message();
  EXPECT_FALSE(photo->grey);
  for (size_t c = 0; c < 3; ++c) EXPECT_EQ(2.0f, photo->image.rgb[c]);
  // RY = BY = 1 in the second pixel: R = B = 2 Y, and G from the luminance.
  const double green = (1.0 - 2.0 * (0.2126 + 0.0722)) / 0.7152;
  EXPECT_NEAR(2.0 * 3.0, photo->image.rgb[3], 1e-5);
  EXPECT_NEAR(3.0 * green, photo->image.rgb[4], 1e-3);
  Write({{"Y", 2.0f}});
  EXPECT_TRUE(Read()->grey);
  EXPECT_EQ(2.0f, First());
}

TEST_F(PhotoExr, LayersByNameAndTheBeautyByDefault) {
  Write(Both(
      Both(Rgb("ViewLayer.DiffCol.", 10.0f), Rgb("ViewLayer.Combined.", 20.0f)),
      {{"ViewLayer.Normal.X", 30.0f},
       {"ViewLayer.Normal.Y", 31.0f},
       {"ViewLayer.Normal.Z", 32.0f},
       {"ViewLayer.Depth.Z", 40.0f}}));
  EXPECT_EQ(20.0f, First());
  EXPECT_EQ("ViewLayer.Combined", Read()->layer);
  EXPECT_EQ(
      (std::vector<std::string>{"ViewLayer.Combined", "ViewLayer.DiffCol"}),
      Read()->layers);
  EXPECT_EQ(1u, Read()->notes.size());
  EXPECT_EQ(10.0f, First("ViewLayer.DiffCol"));
  EXPECT_EQ(10.0f, First("diffcol"));
  EXPECT_TRUE(Read("diffcol")->notes.empty());
  EXPECT_EQ(30.0f, First("", PhotoContent::kNormals));
  EXPECT_EQ(32.0f, Read("", PhotoContent::kNormals)->image.rgb[2]);
  const Status status = Read("glossy").status();
  EXPECT_NE(std::string::npos,
            status.message().find("ViewLayer.Combined, ViewLayer.DiffCol"))
      << status.message();
}

TEST_F(PhotoExr, TheRuleOfTheDefault) {
  // Without a name before all others.
  Write(Both(Rgb("beauty.", 1.0f), Rgb("", 2.0f)));
  EXPECT_EQ(2.0f, First());
  // The only one, whatever its name.
  Write(Both(Rgb("albedo.", 1.0f), {{"Z", 2.0f}}));
  EXPECT_EQ(1.0f, First());
  // Two of names that say nothing.
  Write(Both(Rgb("albedo.", 1.0f), Rgb("direct.", 2.0f)));
  EXPECT_NE(std::string::npos,
            Read().status().message().find("`layer`: albedo, direct"));
  // Blender's compositor gives way to its render; Cryptomatte is no picture.
  Write(Both(
      Both(Rgb("Composite.Combined.", 1.0f), Rgb("View Layer.Combined.", 2.0f)),
      {{"View Layer.CryptoObject00.r", 3.0f},
       {"View Layer.CryptoObject00.g", 3.0f},
       {"View Layer.CryptoObject00.b", 3.0f}}));
  EXPECT_EQ(2.0f, First());
  Write(Both(Rgb("diffuse.", 1.0f), {{"CryptoMaterial00.r", 3.0f},
                                     {"CryptoMaterial00.g", 3.0f},
                                     {"CryptoMaterial00.b", 3.0f}}));
  EXPECT_EQ(1.0f, First());
  // Colours before grey.
  Write(Both(Rgb("light.", 1.0f), {{"ao.Y", 2.0f}}));
  EXPECT_EQ(1.0f, First());
  EXPECT_EQ(2.0f, First("ao"));
}

TEST_F(PhotoExr, DepthByItsName) {
  const auto depth = PhotoContent::kDepth;
  Write({{"Z", 3.0f}});
  EXPECT_EQ(3.0f, First("", depth));
  EXPECT_EQ(3.0f, Read("", depth)->image.rgb[2]);
  Write(Both(Rgb("", 5.0f), {{"Z", 3.0f}}));  // beside colours
  EXPECT_EQ(3.0f, First("", depth));
  Write(
      Both(Rgb("ViewLayer.Combined.", 20.0f), {{"ViewLayer.Depth.Z", 4.0f},
                                               {"ViewLayer.Normal.X", 30.0f},
                                               {"ViewLayer.Normal.Y", 31.0f},
                                               {"ViewLayer.Normal.Z", 32.0f}}));
  EXPECT_EQ(4.0f, First("", depth));
  Write({{"Y", 6.0f}});
  EXPECT_EQ(6.0f, First("", depth));
  Write({{"X", 1.0f}, {"Y", 2.0f}, {"Z", 3.0f}});  // a position or normal
  EXPECT_NE(std::string::npos,
            Read("", depth).status().message().find("found: X Y Z"));
}

TEST_F(PhotoExr, NormalsByTheirNames) {
  const auto normals = PhotoContent::kNormals;
  Write({{"X", 1.0f}, {"Y", 2.0f}, {"Z", 3.0f}});
  EXPECT_EQ(1.0f, First("", normals));
  EXPECT_EQ(3.0f, Read("", normals)->image.rgb[2]);
  // As a colour image it is refused: Y is no luminance here.
  EXPECT_NE(std::string::npos, Read().status().message().find("found: X Y Z"));
  Write(Rgb("", 5.0f));
  EXPECT_EQ(5.0f, First("", normals));
  // Colours beside normals and positions.
  Write(Both(Rgb("", 5.0f), {{"N.X", 6.0f},
                             {"N.Y", 6.0f},
                             {"N.Z", 6.0f},
                             {"P.X", 7.0f},
                             {"P.Y", 7.0f},
                             {"P.Z", 7.0f}}));
  EXPECT_EQ(6.0f, First("", normals));
  EXPECT_EQ(7.0f, First("P", normals));
  EXPECT_EQ(5.0f, First());
  Write({{"Y", 2.0f}});
  EXPECT_FALSE(Read("", normals).ok());
}

TEST_F(PhotoExr, Parts) {
  WriteParts({{"albedo", Rgb("", 1.0f), ""}, {"beauty", Rgb("", 2.0f), ""}});
  EXPECT_EQ(2.0f, First());
  EXPECT_EQ("beauty", Read()->layer);
  EXPECT_EQ(1.0f, First("albedo"));
  WriteParts({{"depth", {{"Z", 1.0f}}, ""}, {"rgba", Rgb("", 2.0f), ""}});
  EXPECT_EQ(2.0f, First());
  WriteParts({{"depth", {{"Z", 1.0f}}, ""}, {"any", Rgb("", 2.0f), ""}});
  EXPECT_EQ(2.0f, First());
  WriteParts({{"one", Rgb("", 1.0f), ""}, {"two", Rgb("", 2.0f), ""}});
  EXPECT_FALSE(Read().ok());
  EXPECT_EQ(2.0f, First("two"));
  // Blender's parts bear their layers' names.
  WriteParts({{"ViewLayer.Depth", {{"ViewLayer.Depth.Z", 1.0f}}, ""},
              {"ViewLayer.Combined", Rgb("ViewLayer.Combined.", 2.0f), ""},
              {"ViewLayer.DiffDir", Rgb("ViewLayer.DiffDir.", 3.0f), ""}});
  EXPECT_EQ(2.0f, First());
  EXPECT_EQ("ViewLayer.Combined", Read()->layer);
  EXPECT_EQ(3.0f, First("ViewLayer.DiffDir"));
  // Two eyes: the first.
  WriteParts({{"rgba.left", Rgb("", 1.0f), "left"},
              {"rgba.right", Rgb("", 2.0f), "right"}});
  EXPECT_EQ(1.0f, First());
  EXPECT_NE(std::string::npos, Read()->notes[0].find("view left"));
}

TEST_F(PhotoExr, TilesAndOtherChannelsThatAreSubsampled) {
  const Imath::Box2i window({-5, 3}, {31, 23});
  Imf::Header header = HeaderOf(window, window, Rgb("", 1.0f));
  header.setTileDescription(Imf::TileDescription(16, 8));
  Frame frame(window, Rgb("", 1.0f));
  {
    Imf::TiledOutputFile file(path().c_str(), header);
    file.setFrameBuffer(frame.buffer);
    file.writeTiles(0, file.numXTiles() - 1, 0, file.numYTiles() - 1);
  }
  const StatusOr<Photo> photo = Read();
  ASSERT_TRUE(photo.ok()) << photo.status().message();
  for (size_t i = 0; i < photo->image.rgb.size(); ++i) {
    EXPECT_EQ(1.0f + static_cast<float>(i / 3), photo->image.rgb[i]);
  }
}

TEST_F(PhotoExr, DamagedFilesAreRefused) {
  Write(Both(Rgb("ViewLayer.Combined.", 1.0f), Rgb("b.", 2.0f)));
  const std::string layers = ReadBytes(path());
  WriteParts({{"albedo", Rgb("", 1.0f), ""}, {"beauty", Rgb("", 2.0f), ""}});
  const std::string parts = ReadBytes(path());
  for (const std::string& whole : {layers, parts}) {
    ForEachTruncation(whole, 200, [&](const std::string& bytes) {
      const Status status = DecodePhoto("a.exr", bytes).status();
      EXPECT_EQ(StatusCode::kInvalidInput, status.code());
      EXPECT_EQ(0u, status.message().find("a.exr"));
    });
    ForEachCorruption(whole, 800, 1000, 7, [&](const std::string& bytes) {
      PhotoOptions options;
      options.limits = {256, 1 << 14};
      const StatusOr<Photo> photo = DecodePhoto("a.exr", bytes, options);
      if (photo.ok()) {
        EXPECT_EQ(3 * photo->image.num_pixels(), photo->image.rgb.size());
      }
    });
  }
}

TEST_F(PhotoExr, LargeClaimsAreRefused) {
  // The display window is what is allocated.
  const auto planes = Rgb("", 1.0f);
  Write(HeaderOf({{0, 0}, {29999, 29999}}, {{0, 0}, {2, 1}}, planes), planes);
  EXPECT_NE(std::string::npos,
            Read().status().message().find("displayWindow: size"));
  // So is the data window of a part that is not asked for.
  WriteParts({{"beauty", Rgb("", 1.0f), ""}, {"other", Rgb("", 2.0f), ""}});
  std::string bytes = ReadBytes(path());
  const size_t at = bytes.rfind(std::string("dataWindow\0box2i\0", 17));
  ASSERT_NE(std::string::npos, at);
  const int32_t last = 31622;
  std::memcpy(&bytes[at + 17 + 4 + 8], &last, 4);
  std::memcpy(&bytes[at + 17 + 4 + 12], &last, 4);
  EXPECT_NE(std::string::npos,
            DecodePhoto("a.exr", bytes).status().message().find("a.exr: size"));
}

}  // namespace
}  // namespace ibrdf
