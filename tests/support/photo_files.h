// Photographs made by the libraries themselves or byte by byte.
#pragma once
#include <cstdio>
// jpeglib.h needs FILE.
#include <glog/logging.h>
#include <jpeglib.h>
#include <png.h>
#include <tiffio.h>
#include <zlib.h>

#include <algorithm>
#include <cmath>
#include <cstdint>
#include <cstdlib>
#include <string>
#include <utility>
#include <vector>

#include "tests/support/png_crc.h"

namespace ibrdf {

inline std::string BigEndianBytes(uint32_t value, size_t count) {
  std::string bytes;
  for (size_t i = count; i-- > 0;) {
    bytes += static_cast<char>(value >> (8 * i));
  }
  return bytes;
}

inline std::string LittleEndianBytes(uint32_t value, size_t count) {
  std::string bytes = BigEndianBytes(value, count);
  std::reverse(bytes.begin(), bytes.end());
  return bytes;
}

// A tag of EXIF whose value fits into four bytes, or an offset.
struct ExifEntry {
  uint32_t tag, type, count, value;
};

// A TIFF header and one table; `after` follows it at byte 14 + 12 * entries.
inline std::string ExifBlock(const std::vector<ExifEntry>& entries,
                             bool big_endian = false,
                             const std::string& after = "") {
  const auto number = [&](uint32_t value, size_t count) {
    return big_endian ? BigEndianBytes(value, count)
                      : LittleEndianBytes(value, count);
  };
  std::string block =
      big_endian ? std::string("MM\0*", 4) : std::string("II*\0", 4);
  block += number(8, 4) + number(static_cast<uint32_t>(entries.size()), 2);
  for (const ExifEntry& e : entries) {
    block += number(e.tag, 2) + number(e.type, 2) + number(e.count, 4);
    block +=
        e.type == 3 ? number(e.value, 2) + number(0, 2) : number(e.value, 4);
  }
  return block + number(0, 4) + after;
}

inline std::string ExifOfOrientation(int orientation) {
  return ExifBlock({{0x0112, 3, 1, static_cast<uint32_t>(orientation)}});
}

// An ICC profile of these tags (signature, data).
inline std::string IccBytes(
    const std::string& colour_space,
    const std::vector<std::pair<std::string, std::string>>& tags) {
  std::string table = BigEndianBytes(static_cast<uint32_t>(tags.size()), 4);
  std::string data;
  const size_t start = 128 + 4 + 12 * tags.size();
  for (const auto& [signature, bytes] : tags) {
    table += signature +
             BigEndianBytes(static_cast<uint32_t>(start + data.size()), 4) +
             BigEndianBytes(static_cast<uint32_t>(bytes.size()), 4);
    data += bytes;
    data.resize((data.size() + 3) / 4 * 4, '\0');
  }
  std::string header =
      BigEndianBytes(static_cast<uint32_t>(start + data.size()), 4);
  header += std::string(4, '\0') + BigEndianBytes(0x02400000, 4) + "mntr" +
            colour_space + "XYZ " + std::string(12, '\0') + "acsp";
  header.resize(68, '\0');
  // The illuminant must be D50.
  header += BigEndianBytes(0x0000F6D6, 4) + BigEndianBytes(0x00010000, 4) +
            BigEndianBytes(0x0000D32D, 4);
  header.resize(128, '\0');
  return header + table + data;
}

inline std::string IccText(const std::string& text) {
  return "desc" + std::string(4, '\0') +
         BigEndianBytes(static_cast<uint32_t>(text.size() + 1), 4) + text +
         std::string(79, '\0');
}

// curveType of a power, in 1/256.
inline std::string IccPower(double exponent) {
  return "curv" + std::string(4, '\0') + BigEndianBytes(1, 4) +
         BigEndianBytes(static_cast<uint32_t>(std::lround(256 * exponent)), 2);
}

// parametricCurveType.
inline std::string IccParametric(int type, const std::vector<double>& numbers) {
  std::string bytes = "para" + std::string(4, '\0') +
                      BigEndianBytes(static_cast<uint32_t>(type), 2) +
                      std::string(2, '\0');
  for (const double x : numbers) {
    bytes += BigEndianBytes(
        static_cast<uint32_t>(static_cast<int32_t>(std::lround(65536 * x))), 4);
  }
  return bytes;
}

inline std::string IccXyz(double x, double y, double z) {
  std::string bytes = "XYZ " + std::string(4, '\0');
  for (const double v : {x, y, z}) {
    bytes += BigEndianBytes(
        static_cast<uint32_t>(static_cast<int32_t>(std::lround(65536 * v))), 4);
  }
  return bytes;
}

// An RGB profile with one curve for all channels.
inline std::string RgbIcc(const std::string& description,
                          const std::string& curve, bool display_p3 = false) {
  return IccBytes("RGB ",
                  {{"desc", IccText(description)},
                   {"wtpt", IccXyz(0.9642, 1.0, 0.8249)},
                   {"rXYZ", display_p3 ? IccXyz(0.5151, 0.2412, -0.0011)
                                       : IccXyz(0.4361, 0.2225, 0.0139)},
                   {"gXYZ", display_p3 ? IccXyz(0.2919, 0.6922, 0.0419)
                                       : IccXyz(0.3851, 0.7169, 0.0971)},
                   {"bXYZ", display_p3 ? IccXyz(0.1572, 0.0666, 0.7841)
                                       : IccXyz(0.1431, 0.0606, 0.7141)},
                   {"rTRC", curve},
                   {"gTRC", curve},
                   {"bTRC", curve}});
}

inline std::string SrgbCurve() {
  return IccParametric(3, {2.4, 1 / 1.055, 0.055 / 1.055, 1 / 12.92, 0.04045});
}

using PngChunk = std::pair<std::string, std::string>;  // type, data

struct PngSpec {
  int width = 0, height = 0;
  int bits = 8;
  int type = PNG_COLOR_TYPE_RGB;
  std::string rows;              // packed as in the file, no filter bytes
  std::vector<PngChunk> before;  // of IDAT
  std::vector<PngChunk> after;
};

inline std::string PngChunkBytes(const std::string& type,
                                 const std::string& data) {
  const std::string body = type + data;
  return BigEndianBytes(static_cast<uint32_t>(data.size()), 4) + body +
         BigEndianBytes(PngCrc(body.data(), body.size()), 4);
}

inline std::string ZlibBytes(const std::string& data) {
  uLongf size = compressBound(static_cast<uLong>(data.size()));
  std::string packed(size, '\0');
  CHECK_EQ(Z_OK, compress(reinterpret_cast<Bytef*>(packed.data()), &size,
                          reinterpret_cast<const Bytef*>(data.data()),
                          static_cast<uLong>(data.size())));
  packed.resize(size);
  return packed;
}

inline std::string PngBytes(const PngSpec& spec) {
  std::string bytes = "\x89PNG\r\n\x1a\n";
  std::string header = BigEndianBytes(static_cast<uint32_t>(spec.width), 4) +
                       BigEndianBytes(static_cast<uint32_t>(spec.height), 4);
  header += static_cast<char>(spec.bits);
  header += static_cast<char>(spec.type);
  header += std::string(3, '\0');
  bytes += PngChunkBytes("IHDR", header);
  for (const auto& [type, data] : spec.before) {
    bytes += PngChunkBytes(type, data);
  }
  std::string raw;
  const size_t row = spec.rows.size() / static_cast<size_t>(spec.height);
  for (int y = 0; y < spec.height; ++y) {
    raw += '\0' + spec.rows.substr(row * static_cast<size_t>(y), row);
  }
  bytes += PngChunkBytes("IDAT", ZlibBytes(raw));
  for (const auto& [type, data] : spec.after) {
    bytes += PngChunkBytes(type, data);
  }
  return bytes + PngChunkBytes("IEND", "");
}

struct JpegSpec {
  int width = 0, height = 0;
  int channels = 3;
  J_COLOR_SPACE colours = JCS_RGB;
  int quality = 100;
  bool subsample = false;
  bool progressive = false;
  int restart_interval = 0;
  std::vector<uint8_t> values;  // [height, width, channels]
  std::vector<std::pair<int, std::string>> markers;
  std::string icc;
};

inline std::string JpegBytes(const JpegSpec& spec) {
  jpeg_compress_struct jpeg;
  jpeg_error_mgr errors;
  jpeg.err = jpeg_std_error(&errors);
  jpeg_create_compress(&jpeg);
  unsigned char* memory = nullptr;
  unsigned long size = 0;
  jpeg_mem_dest(&jpeg, &memory, &size);
  jpeg.image_width = static_cast<JDIMENSION>(spec.width);
  jpeg.image_height = static_cast<JDIMENSION>(spec.height);
  jpeg.input_components = spec.channels;
  jpeg.in_color_space = spec.colours;
  jpeg_set_defaults(&jpeg);
  jpeg_set_quality(&jpeg, spec.quality, TRUE);
  if (!spec.subsample) {
    jpeg.comp_info[0].h_samp_factor = jpeg.comp_info[0].v_samp_factor = 1;
  }
  jpeg.restart_interval = static_cast<unsigned int>(spec.restart_interval);
  if (spec.progressive) jpeg_simple_progression(&jpeg);
  jpeg_start_compress(&jpeg, TRUE);
  for (const auto& [marker, data] : spec.markers) {
    jpeg_write_marker(&jpeg, marker,
                      reinterpret_cast<const JOCTET*>(data.data()),
                      static_cast<unsigned int>(data.size()));
  }
  if (!spec.icc.empty()) {
    jpeg_write_icc_profile(&jpeg,
                           reinterpret_cast<const JOCTET*>(spec.icc.data()),
                           static_cast<unsigned int>(spec.icc.size()));
  }
  std::vector<uint8_t> row(static_cast<size_t>(spec.width) *
                           static_cast<size_t>(spec.channels));
  for (int y = 0; y < spec.height; ++y) {
    std::copy_n(spec.values.begin() + static_cast<int64_t>(row.size()) * y,
                row.size(), row.begin());
    JSAMPROW pointer = row.data();
    jpeg_write_scanlines(&jpeg, &pointer, 1);
  }
  jpeg_finish_compress(&jpeg);
  const std::string bytes(reinterpret_cast<char*>(memory), size);
  jpeg_destroy_compress(&jpeg);
  std::free(memory);
  return bytes;
}

inline std::pair<int, std::string> ExifMarker(const std::string& block) {
  return {JPEG_APP0 + 1, std::string("Exif\0\0", 6) + block};
}

struct TiffSpec {
  int width = 0, height = 0;
  int bits = 8, samples = 3;
  uint16_t format = SAMPLEFORMAT_UINT;
  uint16_t photometric = PHOTOMETRIC_RGB;
  uint16_t compression = COMPRESSION_NONE;
  int predictor = 0;
  bool planes = false;
  int tile = 0;  // side; 0: strips
  int rows_per_strip = 2;
  int orientation = 0;  // 0: no tag
  uint32_t kind = 0;    // SubfileType
  std::vector<uint16_t> extra;
  std::vector<uint16_t> palette;  // red, green, blue
  std::string icc;
  std::string values;  // [height, width, samples] packed by rows
  const char* mode = "w";
};

inline void WriteTiffTags(const TiffSpec& spec, TIFF* tiff) {
  TIFFSetField(tiff, TIFFTAG_IMAGEWIDTH, spec.width);
  TIFFSetField(tiff, TIFFTAG_IMAGELENGTH, spec.height);
  TIFFSetField(tiff, TIFFTAG_BITSPERSAMPLE, spec.bits);
  TIFFSetField(tiff, TIFFTAG_SAMPLESPERPIXEL, spec.samples);
  TIFFSetField(tiff, TIFFTAG_SAMPLEFORMAT, spec.format);
  TIFFSetField(tiff, TIFFTAG_PHOTOMETRIC, spec.photometric);
  TIFFSetField(tiff, TIFFTAG_COMPRESSION, spec.compression);
  TIFFSetField(tiff, TIFFTAG_PLANARCONFIG,
               spec.planes ? PLANARCONFIG_SEPARATE : PLANARCONFIG_CONTIG);
  if (spec.kind != 0) TIFFSetField(tiff, TIFFTAG_SUBFILETYPE, spec.kind);
  if (spec.predictor != 0) {
    TIFFSetField(tiff, TIFFTAG_PREDICTOR, spec.predictor);
  }
  if (spec.orientation != 0) {
    TIFFSetField(tiff, TIFFTAG_ORIENTATION, spec.orientation);
  }
  if (!spec.extra.empty()) {
    TIFFSetField(tiff, TIFFTAG_EXTRASAMPLES,
                 static_cast<int>(spec.extra.size()), spec.extra.data());
  }
  if (!spec.palette.empty()) {
    const size_t n = spec.palette.size() / 3;
    TIFFSetField(tiff, TIFFTAG_COLORMAP, spec.palette.data(),
                 spec.palette.data() + n, spec.palette.data() + 2 * n);
  }
  if (!spec.icc.empty()) {
    TIFFSetField(tiff, TIFFTAG_ICCPROFILE,
                 static_cast<uint32_t>(spec.icc.size()), spec.icc.data());
  }
  if (spec.tile != 0) {
    TIFFSetField(tiff, TIFFTAG_TILEWIDTH, spec.tile);
    TIFFSetField(tiff, TIFFTAG_TILELENGTH, spec.tile);
  } else {
    TIFFSetField(tiff, TIFFTAG_ROWSPERSTRIP, spec.rows_per_strip);
  }
  if (spec.compression == COMPRESSION_JPEG &&
      spec.photometric == PHOTOMETRIC_YCBCR) {
    TIFFSetField(tiff, TIFFTAG_JPEGCOLORMODE, JPEGCOLORMODE_RGB);
  }
}

// Tiles need whole bytes a sample.
inline void WriteTiffTiles(const TiffSpec& spec, TIFF* tiff) {
  const int sample = spec.bits / 8;
  const int inside = spec.planes ? 1 : spec.samples;
  for (int plane = 0; plane < (spec.planes ? spec.samples : 1); ++plane) {
    for (int y = 0; y < spec.height; y += spec.tile) {
      for (int x = 0; x < spec.width; x += spec.tile) {
        std::string data;
        for (int j = y; j < y + spec.tile; ++j) {
          for (int i = x; i < x + spec.tile; ++i) {
            for (int s = 0; s < inside; ++s) {
              const bool in = j < spec.height && i < spec.width;
              const int at =
                  ((j * spec.width + i) * spec.samples + plane + s) * sample;
              data += in ? spec.values.substr(static_cast<size_t>(at),
                                              static_cast<size_t>(sample))
                         : std::string(static_cast<size_t>(sample), '\0');
            }
          }
        }
        CHECK_NE(-1, TIFFWriteTile(tiff, data.data(), static_cast<uint32_t>(x),
                                   static_cast<uint32_t>(y), 0,
                                   static_cast<uint16_t>(plane)));
      }
    }
  }
}

inline void WriteTiffRows(const TiffSpec& spec, TIFF* tiff) {
  const size_t row = spec.values.size() / static_cast<size_t>(spec.height);
  const size_t sample = static_cast<size_t>(std::max(spec.bits / 8, 1));
  for (int plane = 0; plane < (spec.planes ? spec.samples : 1); ++plane) {
    for (int y = 0; y < spec.height; ++y) {
      std::string line = spec.values.substr(row * static_cast<size_t>(y), row);
      if (spec.planes) {
        std::string one;
        for (int x = 0; x < spec.width; ++x) {
          one += line.substr(
              static_cast<size_t>(x * spec.samples + plane) * sample, sample);
        }
        line = one;
      }
      CHECK_EQ(1, TIFFWriteScanline(tiff, line.data(), static_cast<uint32_t>(y),
                                    static_cast<uint16_t>(plane)));
    }
  }
}

// One directory for each.
inline void WriteTiff(const std::string& path,
                      const std::vector<TiffSpec>& specs) {
  TIFF* tiff = TIFFOpen(path.c_str(), specs[0].mode);
  CHECK(tiff != nullptr) << path;
  for (const TiffSpec& spec : specs) {
    WriteTiffTags(spec, tiff);
    if (spec.tile != 0) {
      WriteTiffTiles(spec, tiff);
    } else {
      WriteTiffRows(spec, tiff);
    }
    CHECK_EQ(1, TIFFWriteDirectory(tiff));
  }
  TIFFClose(tiff);
}

}  // namespace ibrdf
