// fuzz_seeds DIR: writes small valid inputs of every fuzzer into DIR/NAME/.
#include <ImfChannelList.h>
#include <ImfChromaticitiesAttribute.h>
#include <ImfFrameBuffer.h>
#include <ImfHeader.h>
#include <ImfMultiPartOutputFile.h>
#include <ImfOutputFile.h>
#include <ImfOutputPart.h>
#include <ImfPartType.h>
#include <ImfStandardAttributes.h>
#include <ImfTileDescription.h>
#include <ImfTiledOutputFile.h>
#include <glog/logging.h>
#include <png.h>

#include <algorithm>
#include <cstdio>
#include <cstring>
#include <filesystem>
#include <vector>

#include "ibrdf/io/exr.h"
#include "ibrdf/io/model_file.h"
#include "ibrdf/io/radiance_hdr.h"
#include "ibrdf/solvers/bench/results_table.h"
#include "tests/fuzz/parsers.h"
#include "tests/support/camera_files.h"
#include "tests/support/mesh_files.h"
#include "tests/support/photo_files.h"
#include "tests/support/temp_dir.h"
#include "tests/support/tiny_model.h"

namespace ibrdf {
namespace {

Image Gradient(int width, int height) {
  Image image(width, height);
  for (size_t i = 0; i < image.rgb.size(); ++i) {
    image.rgb[i] = 0.25f * static_cast<float>(i % 7);
  }
  return image;
}

// All compressions, as scanlines and as tiles.
void WriteExrs(const std::string& folder) {
  CHECK(WriteExr(Gradient(3, 2), folder + "/float.exr").ok());
  CHECK(
      WriteExr(Gradient(3, 2), folder + "/half.exr", ExrPixelType::kHalf).ok());
  CHECK(WriteExr(Gradient(4, 2), folder + "/map.exr", ExrPixelType::kFloat,
                 {ExrEnvmap::kLatLong, "camera"})
            .ok());
  const Image image = Gradient(17, 9);
  for (int c = 0; c < Imf::NUM_COMPRESSION_METHODS; ++c) {
    Imf::Header header(image.width, image.height);
    header.compression() = static_cast<Imf::Compression>(c);
    Imf::FrameBuffer frame;
    for (int k = 0; k < 3; ++k) {
      const char* const names[] = {"R", "G", "B"};
      header.channels().insert(names[k], Imf::Channel(Imf::FLOAT));
      frame.insert(names[k], Imf::Slice::Make(Imf::FLOAT, image.rgb.data() + k,
                                              header.dataWindow(), 12,
                                              size_t{12} * image.width));
    }
    const std::string name = folder + "/compression" + std::to_string(c);
    Imf::OutputFile lines((name + ".exr").c_str(), header);
    lines.setFrameBuffer(frame);
    lines.writePixels(image.height);
    header.setTileDescription(Imf::TileDescription(8, 8));
    Imf::TiledOutputFile tiles((name + "_tiles.exr").c_str(), header);
    tiles.setFrameBuffer(frame);
    tiles.writeTiles(0, tiles.numXTiles() - 1, 0, tiles.numYTiles() - 1);
  }
}

void WriteMeshes(const std::string& obj, const std::string& ply) {
  WriteBytes(obj + "/plain.obj", "v 0 0 0\nv 1 0 0\nv 0 1 0\nf 1 2 3\n");
  WriteBytes(obj + "/all.obj",
             "# c\nmtllib m.mtl\no a\nv 0 0 0 1\nv 1.5e0 -0 +2\nv 0 1 0\n"
             "v 1 1 0\nvt 0 0\nvn 0 0 1\nusemtl x\ns off\n"
             "f -4/1/-1 2/1/1 \\\n3/1/1 4//1\nf 1//1 2//1 3//1\nl 1 2\n");
  const std::string header =
      "comment c\nelement vertex 3\nproperty float x\nproperty float y\n"
      "property float z\nelement face 1\n"
      "property list uchar int vertex_indices\nend_header\n";
  WriteBytes(ply + "/ascii.ply", "ply\nformat ascii 1.0\n" + header +
                                     "0 0 0\n1 0 0\n0 1 0\n3 0 1 2\n");
  WriteBytes(ply + "/normals.ply",
             "ply\nformat ascii 1.0\nelement vertex 3\nproperty double x\n"
             "property double y\nproperty double z\nproperty float nx\n"
             "property float ny\nproperty float nz\nproperty uchar red\n"
             "element face 1\nproperty list uint8 uint32 vertex_index\n"
             "end_header\n0 0 0 0 0 1 9\n1 0 0 0 0 1 9\n0 1 0 0 0 1 9\n"
             "3 0 1 2\n");
  for (const bool big : {false, true}) {
    std::string body;
    const auto put = [&](const void* value, size_t size) {
      std::string bytes(static_cast<const char*>(value), size);
      if (big) std::reverse(bytes.begin(), bytes.end());
      body += bytes;
    };
    for (const float v : {0.f, 0.f, 0.f, 1.f, 0.f, 0.f, 0.f, 1.f, 0.f}) {
      put(&v, sizeof(v));
    }
    body += '\3';
    for (const int32_t v : {0, 1, 2}) put(&v, sizeof(v));
    WriteBytes(ply + (big ? "/big.ply" : "/little.ply"),
               std::string("ply\nformat binary_") + (big ? "big" : "little") +
                   "_endian 1.0\n" + header + body);
  }
}

// Triangles in every way of the other formats.
void WriteOtherMeshes(const std::string& ply, const std::string& stl,
                      const std::string& glb) {
  MeshSpec mesh = {{{0, 0, 0}, {1, 0, 0}, {0, 1, 0}},
                   {{0, 0, 1}, {0, 0, 1}, {0, 0, 1}},
                   {{0, 1, 2}}};
  WriteBytes(ply + "/strips.ply",
             "ply\nformat ascii 1.0\nelement vertex 4\nproperty float x\n"
             "property float y\nproperty float z\nelement tristrips 1\n"
             "property list int int vertex_indices\nend_header\n"
             "0 0 0\n1 0 0\n0 1 0\n1 1 0\n8 0 1 2 3 -1 2 1 3\n");
  WriteBytes(stl + "/binary.stl", StlBytes(mesh));
  WriteBytes(stl + "/text.stl", StlText(mesh));
  WriteBytes(glb + "/container", std::string(1, '\0') + GlbBytes(mesh));
  std::string buffer;
  nlohmann::json json = GltfJsonOf(mesh, &buffer);
  const auto write = [&](const std::string& name) {
    WriteBytes(glb + "/" + name, "\1" + json.dump() + "\xff" + buffer);
  };
  write("plain");
  json["nodes"] = {
      {{"children", {1}},
       {"rotation", {0, 0, 0, 1}},
       {"translation", {1, 2, 3}},
       {"scale", {1, -1, 2}}},
      {{"mesh", 0},
       {"matrix", {1, 0, 0, 0, 0, 1, 0, 0, 0, 0, 1, 0, 4, 5, 6, 1}}}};
  json["scene"] = 0;
  json["extensionsRequired"] = {"KHR_mesh_quantization"};
  nlohmann::json& primitive = json["meshes"][0]["primitives"][0];
  primitive.erase("indices");
  primitive["mode"] = 5;
  json["bufferViews"][0]["byteStride"] = 12;
  json["accessors"][1]["componentType"] = 5120;
  json["accessors"][1]["normalized"] = true;
  write("nodes");
}

// A byte of choice, then pictures that are maps, depth and normals.
void WriteGeometryImages(const std::string& map, const std::string& depth,
                         const std::string& normals) {
  const std::string pfm = "Pf\n4 2\n-1.0\n" + std::string(32, '?');
  const std::string cross = "Pf\n3 4\n-1.0\n" + std::string(48, '?');
  const std::string probe = "PF\n4 4\n-1.0\n" + std::string(192, '?');
  WriteBytes(map + "/latlong", std::string(1, '\0') + pfm);
  WriteBytes(map + "/probe", "\5" + probe);
  WriteBytes(map + "/cross", "\6" + cross);
  const TempDir dir;
  CHECK(WriteExr(Gradient(4, 2), dir.File("a.exr"), ExrPixelType::kFloat,
                 {ExrEnvmap::kLatLong, "mitsuba"})
            .ok());
  WriteBytes(map + "/attributes", "\x8" + ReadBytes(dir.File("a.exr")));
  WriteBytes(depth + "/orthographic", std::string(1, '\0') + pfm);
  WriteBytes(depth + "/perspective", "\3" + pfm);
  const std::string header =
      "{'descr': '|u1', 'fortran_order': False, 'shape': (2, 2, 3), }";
  const std::string npy =
      std::string("\x93NUMPY\1\0", 8) +
      LittleEndianBytes(static_cast<uint32_t>(header.size()), 2) + header +
      "\x80\x80\xff\x80\xff\x80\xff\x80\x80\x90\x90\xf0";
  WriteBytes(normals + "/codes", std::string(1, '\0') + npy);
  WriteBytes(normals + "/floats", "\4" + probe);
}

void WriteTexts(const std::string& config, const std::string& flags) {
  WriteBytes(config + "/kinds",
             "a: 1\nb: [x, 'y z', ~, -1.5e-3]\nc: {d: {}, e: {f: no}}\n"
             "\"g\": \"\\x41\\n\"\nh: null\n");
  WriteBytes(flags + "/all",
             "photo.exr\xffmask.png\xffsrgb\xffnormals.npy\xff\xffsky.hdr"
             "\xffsolver.seconds=5\xffimage.brackets=[a.png, b.png]"
             "\xffimage.bracket_exposures=[0.5, 2]");
  WriteBytes(flags + "/mesh",
             "photo.png\xff\xff"
             "auto\xff\xffvase.glb");
}

void WriteProblems(const std::string& folder) {
  WriteBytes(folder + "/joint.yaml",
             "problem: joint\nimage: {file: i.exr, mask: m.png}\n"
             "camera: {type: perspective, fov_degrees: 30, from: [0,0,4], "
             "to: [0,0,0], up: [0,1,0]}\n"
             "geometry: {mesh: b.obj, fit: unit_sphere}\n"
             "reflectance: {model: default, lobes: 2, prior_sigma: 0.5}\n"
             "illumination: {width: 128, height: 64, prior: unet, "
             "unet_channels: 8}\n"
             "likelihood: {scale: auto, epsilon: 1e-5}\neffects: auto\n"
             "solver: {estimator: marginal, method: auto, quadrature: fine, "
             "seconds: 120, tolerance: 1e-4, max_iterations: 3, seed: 1}\n"
             "truth: {brdf: g.binary, illumination: g.exr}\n"
             "\xffsolver.seconds=30\xff"
             "illumination={known: e.exr}");
  WriteBytes(folder + "/scene.yaml",
             "# a scene\nimage:\n  width: 128\n  height: 128\n"
             "geometry: {sphere: {}}\nreflectance:\n  known:\n"
             "    cook_torrance: {diffuse: [0.1, 0.2, 0.3], specular: 1, "
             "roughness: 0.1, f0: 0.04}\n"
             "illumination: {known: {sky: {sun_theta_degrees: 50, "
             "sun_phi_degrees: 35}}}\nquality: preview\nnoise: 0.02\n");
}

void WriteModels(const std::string& folder) {
  const TempDir dir;
  for (const int lobes : {0, 2}) {
    CHECK(WriteModel(TinyModel(lobes), dir.File("a.ibrdf")).ok());
    const std::string file = ReadBytes(dir.File("a.ibrdf"));
    const std::string name = folder + "/lobes" + std::to_string(lobes);
    WriteBytes(name, "\2" + file);
    WriteBytes(name + "_sum", "\1" + file.substr(0, file.size() - 8));
  }
}

void WriteOwnFiles(const std::string& checkpoint, const std::string& results,
                   const std::string& trace) {
  const TempDir dir;
  CHECK(SaveCheckpoint(dir.File("a"), kFuzzedTraining, FuzzedTrainingState())
            .ok());
  const std::string file = ReadBytes(dir.File("a"));
  WriteBytes(checkpoint + "/whole", "\2" + file);
  WriteBytes(checkpoint + "/sum", "\1" + file.substr(0, file.size() - 8));
  CHECK(AppendResult(results + "/one.csv", FuzzedColumns(), {"a", "1.5", ""})
            .ok());
  WriteBytes(
      trace + "/two.json",
      "{\"trace\": [{\"stage\": \"rank\", \"seconds\": 0.5, \"scale\": 0, "
      "\"misfit\": 1e-2}, {\"stage\": \"map iteration 1\", \"seconds\": 2, "
      "\"scale\": 0.1, \"misfit\": 0.02}]}");
}

// All kinds of pixels, flat and interlaced. Errors end libpng's process.
void WritePngs(const std::string& folder) {
  constexpr struct {
    int type, bits;
  } kKinds[] = {{PNG_COLOR_TYPE_GRAY, 1},      {PNG_COLOR_TYPE_GRAY, 16},
                {PNG_COLOR_TYPE_PALETTE, 4},   {PNG_COLOR_TYPE_RGB, 8},
                {PNG_COLOR_TYPE_RGB, 16},      {PNG_COLOR_TYPE_GRAY_ALPHA, 8},
                {PNG_COLOR_TYPE_RGB_ALPHA, 16}};
  for (const auto& [type, bits] : kKinds) {
    for (const int interlace : {PNG_INTERLACE_NONE, PNG_INTERLACE_ADAM7}) {
      std::string bytes("\1");  // with checksums that fit
      png_structp png = png_create_write_struct(PNG_LIBPNG_VER_STRING, nullptr,
                                                nullptr, nullptr);
      png_infop info = png_create_info_struct(png);
      png_set_write_fn(
          png, &bytes,
          [](png_structp p, png_bytep data, size_t size) {
            static_cast<std::string*>(png_get_io_ptr(p))
                ->append(reinterpret_cast<const char*>(data), size);
          },
          [](png_structp) {});
      png_set_IHDR(png, info, 9, 3, bits, type, interlace,
                   PNG_COMPRESSION_TYPE_DEFAULT, PNG_FILTER_TYPE_DEFAULT);
      const png_color palette[3] = {{0, 0, 0}, {9, 9, 9}, {255, 0, 1}};
      png_byte alpha[2] = {0, 255};
      png_color_16 clear = {};
      if (type == PNG_COLOR_TYPE_PALETTE) png_set_PLTE(png, info, palette, 3);
      if ((type & PNG_COLOR_MASK_ALPHA) == 0) {
        png_set_tRNS(png, info, alpha, 2, &clear);
      }
      png_write_info(png, info);
      const std::vector<png_byte> row(9 * 8, 0x21);
      for (int pass = png_set_interlace_handling(png); pass > 0; --pass) {
        for (int y = 0; y < 3; ++y) png_write_row(png, row.data());
      }
      png_write_end(png, info);
      png_destroy_write_struct(&png, &info);
      WriteBytes(folder + "/type" + std::to_string(type) + "_" +
                     std::to_string(bits) + "_" + std::to_string(interlace),
                 bytes);
    }
  }
}

// Sizes, curves, profiles, EXIF, alpha and palettes; of JPEG baseline,
// progressive and restarted; of TIFF strips, tiles, planes and compressions.
void WritePhotoPngs(const std::string& folder) {
  WritePngs(folder);
  PngSpec spec;
  spec.width = 3;
  spec.height = 2;
  spec.rows = std::string(18, '!');
  spec.before = {
      {"gAMA", BigEndianBytes(45455, 4)},
      {"cICP", std::string("\1\15\0\1", 4)},
      {"sBIT", "\5\6\7"},
      {"iCCP", std::string("p\0\0", 3) + ZlibBytes(RgbIcc("a", SrgbCurve()))},
      {"pHYs", BigEndianBytes(2, 4) + BigEndianBytes(1, 4) + '\0'},
      {"eXIf", ExifOfOrientation(6)}};
  WriteBytes(folder + "/tags", "\1" + PngBytes(spec));
  spec.before = {{"sRGB", std::string(1, '\0')},
                 {"tRNS", std::string("\0!\0!\0!", 6)}};
  spec.after = {{"eXIf", ExifOfOrientation(8)}};
  WriteBytes(folder + "/srgb", "\1" + PngBytes(spec));
}

void WriteJpegs(const std::string& folder) {
  for (const int channels : {1, 3, 4}) {
    for (const bool progressive : {false, true}) {
      JpegSpec spec;
      spec.width = 17;
      spec.height = 9;
      spec.channels = channels;
      spec.colours = channels == 1   ? JCS_GRAYSCALE
                     : channels == 3 ? JCS_RGB
                                     : JCS_CMYK;
      spec.quality = 50;
      spec.subsample = progressive;
      spec.progressive = progressive;
      spec.restart_interval = progressive ? 0 : 2;
      for (int i = 0; i < 17 * 9 * channels; ++i) {
        spec.values.push_back(static_cast<uint8_t>(3 * i));
      }
      if (progressive) {
        spec.markers = {ExifMarker(ExifOfOrientation(5))};
        spec.icc = RgbIcc("a", IccPower(2.2));
      }
      WriteBytes(folder + "/channels" + std::to_string(channels) +
                     (progressive ? "_progressive" : ""),
                 JpegBytes(spec));
    }
  }
}

void WriteTiffs(const std::string& folder) {
  TiffSpec spec;
  spec.width = 18;
  spec.height = 5;
  spec.values = std::string(18 * 5 * 3, '#');
  int number = 0;
  const auto write = [&](const TiffSpec& s) {
    WriteTiff(folder + "/" + std::to_string(number++), {s});
  };
  for (const uint16_t compression :
       {COMPRESSION_NONE, COMPRESSION_LZW, COMPRESSION_ADOBE_DEFLATE,
        COMPRESSION_PACKBITS, COMPRESSION_ZSTD}) {
    spec.compression = compression;
    for (const int tile : {0, 16}) {
      spec.tile = tile;
      spec.planes = tile == 0;
      spec.mode = tile == 0 ? "wl" : "wb";
      write(spec);
    }
  }
  spec.tile = 0;
  spec.planes = false;
  spec.compression = COMPRESSION_LZW;
  spec.predictor = PREDICTOR_HORIZONTAL;
  spec.orientation = 6;
  spec.icc = RgbIcc("a", IccPower(1.8));
  write(spec);
  TiffSpec floats = spec;
  floats.predictor = PREDICTOR_FLOATINGPOINT;
  floats.format = SAMPLEFORMAT_IEEEFP;
  floats.bits = 32;
  floats.values = std::string(4 * spec.values.size(), '?');
  floats.mode = "w8";
  write(floats);
  TiffSpec palette;
  palette.width = 4;
  palette.height = 2;
  palette.bits = 4;
  palette.samples = 1;
  palette.photometric = PHOTOMETRIC_PALETTE;
  palette.values = "\1\2\3\4";
  palette.palette.assign(48, 257);
  write(palette);
  TiffSpec jpeg = spec;
  jpeg.predictor = 0;
  jpeg.compression = COMPRESSION_JPEG;
  jpeg.photometric = PHOTOMETRIC_YCBCR;
  jpeg.rows_per_strip = 16;
  write(jpeg);
}

// Layers, parts, windows, chromaticities, luminance and chroma.
void WritePhotoExrs(const std::string& folder) {
  const TempDir dir;
  const Image image = Gradient(6, 4);
  const auto write = [&](const std::string& name, Imf::Header header,
                         const std::vector<std::string>& channels,
                         int sampling) {
    Imf::FrameBuffer frame;
    for (size_t k = 0; k < channels.size(); ++k) {
      const int s = k == 0 ? 1 : sampling;
      header.channels().insert(channels[k], Imf::Channel(Imf::HALF, s, s));
    }
    std::vector<std::vector<half>> planes(channels.size(),
                                          std::vector<half>(24, half(0.5f)));
    for (size_t k = 0; k < channels.size(); ++k) {
      const int s = k == 0 ? 1 : sampling;
      frame.insert(
          channels[k],
          Imf::Slice::Make(Imf::HALF, planes[k].data(), header.dataWindow(), 2,
                           static_cast<size_t>(12 / s), s, s));
    }
    for (const char flag : {'\0', '\1'}) {
      const std::string path = dir.File(name + (flag ? "_normals" : ""));
      Imf::OutputFile file(path.c_str(), header);
      file.setFrameBuffer(frame);
      file.writePixels(4);
    }
  };
  Imf::Header plain(6, 4);
  write("layers", plain, {"a.Combined.R", "a.Combined.G", "a.Combined.B"}, 1);
  write("xyz", plain, {"N.X", "N.Y", "N.Z", "R", "G", "B", "A"}, 1);
  write("chroma", plain, {"Y", "RY", "BY"}, 2);
  Imf::Header window({{-2, 0}, {9, 9}}, {{0, -2}, {5, 1}});
  Imf::addChromaticities(window,
                         Imf::Chromaticities({0.7f, 0.3f}, {0.2f, 0.7f}));
  write("window", window, {"R", "G", "B"}, 1);
  std::vector<Imf::Header> headers;
  for (const char* part : {"beauty", "albedo"}) {
    headers.push_back(plain);
    headers.back().setName(part);
    headers.back().setType(Imf::SCANLINEIMAGE);
    headers.back().channels().insert("Y", Imf::Channel(Imf::FLOAT));
  }
  {
    Imf::MultiPartOutputFile file(dir.File("parts").c_str(), headers.data(), 2);
    Imf::FrameBuffer frame;
    frame.insert("Y", Imf::Slice::Make(Imf::FLOAT, image.rgb.data(),
                                       plain.dataWindow(), 4, 24));
    for (int k = 0; k < 2; ++k) {
      Imf::OutputPart part(file, k);
      part.setFrameBuffer(frame);
      part.writePixels(4);
    }
  }
  for (const auto& entry : std::filesystem::directory_iterator(dir.path())) {
    const std::string name = entry.path().filename();
    const bool normals = name.find("_normals") != std::string::npos;
    WriteBytes(folder + "/" + name,
               (normals ? "\1" : "\2") + ReadBytes(entry.path()));
  }
}

void WriteArrays(const std::string& npy, const std::string& pfm,
                 const std::string& exif, const std::string& icc) {
  for (const char* type : {"|u1", "<u2", "<f4", "<f8"}) {
    const std::string header = std::string("{'descr': '") + type +
                               "', 'fortran_order': False, 'shape': (1, 2), }";
    const size_t bytes = static_cast<size_t>(type[2] - '0');
    WriteBytes(npy + "/" + type[1] + type[2],
               std::string("\x93NUMPY\1\0", 8) +
                   LittleEndianBytes(static_cast<uint32_t>(header.size()), 2) +
                   header + std::string(2 * bytes, '\1'));
  }
  WriteBytes(pfm + "/colour", "PF\n1 2\n-1.0\n" + std::string(24, '?'));
  WriteBytes(pfm + "/grey", "Pf\n1 2\n2.5\n" + std::string(8, '?'));
  WriteBytes(exif + "/little", ExifOfOrientation(6));
  WriteBytes(exif + "/big", ExifBlock({{0x0112, 3, 1, 8},
                                       {0xA001, 3, 1, 1},
                                       {0x8827, 3, 1, 400},
                                       {0x829A, 5, 1, 0},
                                       {0x8769, 4, 1, 8}},
                                      true));
  WriteBytes(icc + "/srgb", RgbIcc("sRGB", SrgbCurve()));
  WriteBytes(icc + "/power", RgbIcc("Adobe", IccPower(2.2)));
  WriteBytes(icc + "/grey", IccBytes("GRAY", {{"kTRC", IccPower(1.8)}}));
}

// A table of ones.
void WriteMerl(const std::string& folder) {
  std::string bytes(sizeof(kFuzzedMerlBins), '\0');
  std::memcpy(bytes.data(), kFuzzedMerlBins.data(), bytes.size());
  const double one = 1.0;
  const auto [a, b, c] = kFuzzedMerlBins;
  for (int i = 0; i < 3 * a * b * c; ++i) {
    bytes.append(reinterpret_cast<const char*>(&one), sizeof(one));
  }
  WriteBytes(folder + "/ones", bytes);
}

void WriteCameras(const std::string& transforms, const std::string& text,
                  const std::string& binary) {
  WriteBytes(transforms + "/angle", SmallTransforms());
  WriteBytes(transforms + "/pixels", PixelTransforms());
  WriteBytes(text + "/two",
             SmallColmapCameras() + "\xff" + SmallColmapImages());
  const std::string cameras = SmallColmapCamerasBinary();
  WriteBytes(binary + "/two",
             LittleEndianBytes(static_cast<uint32_t>(cameras.size()), 2) +
                 cameras + SmallColmapImagesBinary());
}

void WriteSeeds(const std::string& folder) {
  const auto in = [&](const std::string& parser) {
    return folder + "/" + parser;
  };
  for (const std::string& parser : FuzzedParsers()) {
    std::filesystem::create_directories(in(parser));
  }
  WriteExrs(in("exr"));
  WriteOwnFiles(in("checkpoint"), in("results"), in("trace"));
  CHECK(WriteRadianceHdr(Gradient(3, 2), in("hdr") + "/flat.hdr").ok());
  CHECK(WriteRadianceHdr(Gradient(9, 2), in("hdr") + "/runs.hdr").ok());
  WriteBytes(in("hdr") + "/old.hdr",
             std::string("#?RADIANCE\nEXPOSURE=2\nCOLORCORR=1 2 3\n"
                         "FORMAT=32-bit_rle_rgbe\n\n-Y 1 +X 9\n"
                         "\x10\x20\x30\x80\1\1\1\x8"));
  WritePngs(in("png"));
  WritePhotoPngs(in("photo_png"));
  WriteJpegs(in("photo_jpeg"));
  WriteTiffs(in("photo_tiff"));
  WritePhotoExrs(in("photo_exr"));
  WriteArrays(in("npy"), in("pfm"), in("exif"), in("icc"));
  WriteMerl(in("merl"));
  WriteMeshes(in("obj"), in("ply"));
  WriteOtherMeshes(in("ply"), in("stl"), in("glb"));
  WriteGeometryImages(in("map"), in("depth"), in("normals"));
  WriteCameras(in("transforms"), in("colmap_text"), in("colmap_binary"));
  WriteTexts(in("config"), in("flags"));
  WriteProblems(in("problem"));
  WriteModels(in("model"));
}

}  // namespace
}  // namespace ibrdf

int main(int argc, char** argv) {
  if (argc != 2) {
    std::fprintf(stderr, "usage: fuzz_seeds DIR\n");
    return 2;
  }
  ibrdf::WriteSeeds(argv[1]);
  return 0;
}
