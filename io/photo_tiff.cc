#include "ibrdf/io/photo_tiff.h"

#include <half.h>
#include <tiffio.h>

#include <algorithm>
#include <cmath>
#include <cstdarg>
#include <cstdio>
#include <cstring>
#include <memory>
#include <vector>

#include "ibrdf/io/exif.h"
#include "ibrdf/io/icc_profile.h"

namespace ibrdf {
namespace {

constexpr int kMaxSamples = 8;    // channels, extra ones too
constexpr int kMaxPictures = 16;  // looked through for one that is no thumbnail

// A file in memory and what libtiff says of it.
struct MemoryFile {
  const std::string* bytes = nullptr;
  toff_t position = 0;
  bool strict = false;  // warnings are errors
  std::string message;  // the first error
};

MemoryFile* FileOf(thandle_t handle) {
  return static_cast<MemoryFile*>(handle);
}

tmsize_t ReadTiffBytes(thandle_t handle, void* out, tmsize_t count) {
  MemoryFile* file = FileOf(handle);
  const toff_t size = file->bytes->size();
  if (count <= 0 || file->position >= size) return 0;
  const tmsize_t given = static_cast<tmsize_t>(
      std::min<toff_t>(static_cast<toff_t>(count), size - file->position));
  std::memcpy(out, file->bytes->data() + file->position,
              static_cast<size_t>(given));
  file->position += static_cast<toff_t>(given);
  return given;
}

tmsize_t WriteNothing(thandle_t, void*, tmsize_t) { return 0; }

toff_t SeekTiff(thandle_t handle, toff_t offset, int whence) {
  MemoryFile* file = FileOf(handle);
  if (whence == SEEK_CUR) offset += file->position;
  if (whence == SEEK_END) offset += file->bytes->size();
  file->position = offset;
  return offset;
}

int KeepOpen(thandle_t) { return 0; }

toff_t TiffSize(thandle_t handle) { return FileOf(handle)->bytes->size(); }

void Keep(MemoryFile* file, const char* format, va_list arguments) {
  if (!file->message.empty()) return;
  char text[256];
  std::vsnprintf(text, sizeof(text), format, arguments);
  file->message = text[0] == '\0' ? "damaged" : text;
}

int OnTiffError(TIFF*, void* file, const char*, const char* format,
                va_list arguments) {
  Keep(static_cast<MemoryFile*>(file), format, arguments);
  return 1;
}

int OnTiffWarning(TIFF*, void* data, const char*, const char* format,
                  va_list arguments) {
  MemoryFile* file = static_cast<MemoryFile*>(data);
  if (file->strict) Keep(file, format, arguments);
  return 1;
}

struct Closer {
  void operator()(TIFF* tiff) const { TIFFClose(tiff); }
};
using TiffHandle = std::unique_ptr<TIFF, Closer>;

// A file's bytes that claim `largest` bytes at once are not read.
TiffHandle OpenTiff(MemoryFile* file, size_t largest) {
  TIFFOpenOptions* options = TIFFOpenOptionsAlloc();
  if (options == nullptr) return nullptr;
  TIFFOpenOptionsSetMaxSingleMemAlloc(options, static_cast<tmsize_t>(largest));
  TIFFOpenOptionsSetErrorHandlerExtR(options, OnTiffError, file);
  TIFFOpenOptionsSetWarningHandlerExtR(options, OnTiffWarning, file);
  // m: the file is not mapped; it is in memory.
  TIFF* tiff = TIFFClientOpenExt("file", "rm", file, ReadTiffBytes,
                                 WriteNothing, SeekTiff, KeepOpen, TiffSize,
                                 nullptr, nullptr, options);
  TIFFOpenOptionsFree(options);
  return TiffHandle(tiff);
}

template <typename T>
T Field(TIFF* tiff, uint32_t tag, T otherwise) {
  T value = otherwise;
  return TIFFGetFieldDefaulted(tiff, tag, &value) == 1 ? value : otherwise;
}

// What the tags say of the pixels.
struct Layout {
  uint32_t width = 0, height = 0;
  int bits = 0;
  int samples = 0;  // a pixel
  int colours = 0;  // of them: 1 or 3
  uint16_t format = SAMPLEFORMAT_UINT;
  uint16_t photometric = PHOTOMETRIC_MINISBLACK;
  bool planes = false;
  int alpha = -1;  // its sample; -1: none

  bool floats() const { return format == SAMPLEFORMAT_IEEEFP; }
};

Status CheckPhotometric(const std::string& path, TIFF* tiff, Layout* layout) {
  const std::string where = path + ": colours";
  const std::string expected = "expected grey, RGB or a palette, found ";
  const uint16_t compression =
      Field<uint16_t>(tiff, TIFFTAG_COMPRESSION, COMPRESSION_NONE);
  layout->colours = 1;
  switch (layout->photometric) {
    case PHOTOMETRIC_MINISBLACK:
    case PHOTOMETRIC_MINISWHITE:
    case PHOTOMETRIC_PALETTE:
      return OkStatus();
    case PHOTOMETRIC_RGB:
      layout->colours = 3;
      return OkStatus();
    case PHOTOMETRIC_YCBCR:
      if (compression == COMPRESSION_JPEG) {
        TIFFSetField(tiff, TIFFTAG_JPEGCOLORMODE, JPEGCOLORMODE_RGB);
        layout->colours = 3;
        return OkStatus();
      }
      return InvalidInput(where, expected + "YCbCr outside JPEG");
    case PHOTOMETRIC_SEPARATED:
      return InvalidInput(where, expected +
                                     "CMYK, the inks of a print; convert it to "
                                     "sRGB");
    case PHOTOMETRIC_CIELAB:
    case PHOTOMETRIC_ICCLAB:
    case PHOTOMETRIC_ITULAB:
      return InvalidInput(where, expected + "CIE Lab");
    case PHOTOMETRIC_CFA:
      return InvalidInput(where, expected +
                                     "raw sensor data; develop it to linear "
                                     "TIFF of 16 bits");
    default:
      return InvalidInput(
          where, expected + "kind " + std::to_string(layout->photometric));
  }
}

Status CheckCompression(const std::string& path, TIFF* tiff) {
  const uint16_t compression =
      Field<uint16_t>(tiff, TIFFTAG_COMPRESSION, COMPRESSION_NONE);
  switch (compression) {
    case COMPRESSION_NONE:
    case COMPRESSION_LZW:
    case COMPRESSION_PACKBITS:
    case COMPRESSION_DEFLATE:
    case COMPRESSION_ADOBE_DEFLATE:
    case COMPRESSION_ZSTD:
    case COMPRESSION_JPEG:
      return OkStatus();
    default:
      return InvalidInput(path + ": compression",
                          "expected none, LZW, Deflate, PackBits, Zstandard or "
                          "JPEG, found number " +
                              std::to_string(compression));
  }
}

Status CheckBits(const std::string& path, const Layout& layout) {
  const int bits = layout.bits;
  bool known = bits == 8 || bits == 16;
  if (layout.floats()) known = bits == 16 || bits == 32 || bits == 64;
  if (!layout.floats() && layout.samples == 1) {
    known = known || bits == 1 || bits == 2 || bits == 4;
  }
  if (layout.photometric == PHOTOMETRIC_PALETTE) {
    known = known && bits <= 8 && layout.samples == 1 && !layout.floats();
  }
  if (layout.format != SAMPLEFORMAT_UINT && !layout.floats()) {
    return InvalidInput(path + ": numbers",
                        "expected unsigned or floating-point ones, found "
                        "SampleFormat " +
                            std::to_string(layout.format));
  }
  if (known) return OkStatus();
  return InvalidInput(path + ": bits",
                      "expected 8 or 16, or floats of 16, 32 or 64, found " +
                          std::to_string(bits) +
                          (layout.floats() ? " of floats" : ""));
}

StatusOr<Layout> ReadLayout(const std::string& path, TIFF* tiff,
                            const ImageLimits& limits) {
  Layout layout;
  layout.width = Field<uint32_t>(tiff, TIFFTAG_IMAGEWIDTH, 0);
  layout.height = Field<uint32_t>(tiff, TIFFTAG_IMAGELENGTH, 0);
  IBRDF_RETURN_IF_ERROR(
      CheckImageSize(path, layout.width, layout.height, limits));
  layout.bits = Field<uint16_t>(tiff, TIFFTAG_BITSPERSAMPLE, 1);
  layout.samples = Field<uint16_t>(tiff, TIFFTAG_SAMPLESPERPIXEL, 1);
  layout.format =
      Field<uint16_t>(tiff, TIFFTAG_SAMPLEFORMAT, SAMPLEFORMAT_UINT);
  if (layout.format == SAMPLEFORMAT_VOID) layout.format = SAMPLEFORMAT_UINT;
  layout.photometric =
      Field<uint16_t>(tiff, TIFFTAG_PHOTOMETRIC, PHOTOMETRIC_MINISBLACK);
  layout.planes = layout.samples > 1 &&
                  Field<uint16_t>(tiff, TIFFTAG_PLANARCONFIG,
                                  PLANARCONFIG_CONTIG) == PLANARCONFIG_SEPARATE;
  IBRDF_RETURN_IF_ERROR(CheckCompression(path, tiff));
  IBRDF_RETURN_IF_ERROR(CheckPhotometric(path, tiff, &layout));
  IBRDF_RETURN_IF_ERROR(CheckBits(path, layout));
  if (layout.samples < layout.colours || layout.samples > kMaxSamples) {
    return InvalidInput(path + ": channels",
                        "expected " + std::to_string(layout.colours) + " to " +
                            std::to_string(kMaxSamples) + ", found " +
                            std::to_string(layout.samples));
  }
  uint16_t extra = 0;
  const uint16_t* kinds = nullptr;
  if (TIFFGetField(tiff, TIFFTAG_EXTRASAMPLES, &extra, &kinds) == 1) {
    for (int k = 0; k < extra && layout.colours + k < layout.samples; ++k) {
      if (kinds[k] != EXTRASAMPLE_UNSPECIFIED && layout.alpha < 0) {
        layout.alpha = layout.colours + k;
      }
    }
  }
  return layout;
}

// The value of a sample at `data`, which is that of `index` within a row.
float SampleValue(const Layout& layout, const uint8_t* row, size_t index) {
  switch (layout.bits) {
    case 8:
      return row[index];
    case 16: {
      uint16_t value = 0;
      std::memcpy(&value, row + 2 * index, sizeof(value));
      if (!layout.floats()) return value;
      half number;
      number.setBits(value);
      return number;
    }
    case 32: {
      float value = 0.0f;
      std::memcpy(&value, row + 4 * index, sizeof(value));
      return value;
    }
    case 64: {
      double value = 0.0;
      std::memcpy(&value, row + 8 * index, sizeof(value));
      return static_cast<float>(value);  // beyond floats: infinite
    }
    default: {  // 1, 2 or 4 bits, the first in the highest bits
      const size_t bit = index * static_cast<size_t>(layout.bits);
      const int shift = 8 - layout.bits - static_cast<int>(bit % 8);
      return static_cast<float>(row[bit / 8] >> shift &
                                ((1 << layout.bits) - 1));
    }
  }
}

// Samples of a picture: colours and alpha.
struct TiffPixels {
  Image image;
  std::vector<float> alpha;
};

// A block of pixels that libtiff gives at once: a strip or a tile.
struct Block {
  uint32_t x = 0, y = 0;
  uint32_t width = 0, height = 0;  // of its rows in memory
  int plane = 0;
};

void CopyBlock(const Layout& layout, const Block& block,
               const std::vector<uint8_t>& data, TiffPixels* pixels) {
  const size_t samples =
      static_cast<size_t>(layout.planes ? 1 : layout.samples);
  const size_t row_bytes =
      (block.width * samples * static_cast<size_t>(layout.bits) + 7) / 8;
  const uint32_t columns = std::min(block.width, layout.width - block.x);
  const uint32_t rows = std::min(block.height, layout.height - block.y);
  for (uint32_t y = 0; y < rows; ++y) {
    const uint8_t* row = data.data() + y * row_bytes;
    for (uint32_t x = 0; x < columns; ++x) {
      const size_t pixel =
          static_cast<size_t>(block.y + y) * layout.width + block.x + x;
      for (size_t s = 0; s < samples; ++s) {
        const int channel = layout.planes ? block.plane : static_cast<int>(s);
        const float value = SampleValue(layout, row, x * samples + s);
        if (channel < layout.colours) {
          pixels->image.rgb[3 * pixel + static_cast<size_t>(channel)] = value;
        } else if (channel == layout.alpha) {
          pixels->alpha[pixel] = value;
        }
      }
    }
  }
}

Status BlockError(const std::string& path, const MemoryFile& file) {
  return InvalidInput(path, "expected a whole TIFF image (" +
                                (file.message.empty() ? std::string("truncated")
                                                      : file.message) +
                                ")");
}

// The geometry of strips or tiles.
struct Blocks {
  bool tiled = false;
  uint32_t width = 0, height = 0;  // of each; of the last strip at most
  size_t bytes = 0;
};

// Before memory is taken for a strip or tile and for the picture.
Status CheckMemory(const std::string& path, TIFF* tiff, const Layout& layout,
                   size_t block_bytes, const MemoryFile& file) {
  constexpr size_t kMaxBlockBytes = size_t{1} << 30;
  if (block_bytes > kMaxBlockBytes) {
    return InvalidInput(path, "expected strips or tiles of at most 1 GiB");
  }
  const uint16_t compression =
      Field<uint16_t>(tiff, TIFFTAG_COMPRESSION, COMPRESSION_NONE);
  if (compression == COMPRESSION_ZSTD || compression == COMPRESSION_JPEG) {
    return OkStatus();  // a few bytes may be a large even area
  }
  // Deflate shrinks at most 1032-fold; LZW, a code of 12 bits for at most 4096
  // bytes, 2731-fold.
  constexpr size_t kMaxGrowth = 2731;
  const size_t total = static_cast<size_t>(layout.width) * layout.height *
                       static_cast<size_t>(layout.samples * layout.bits) / 8;
  if (total / (compression == COMPRESSION_NONE ? 1 : kMaxGrowth) >
      file.bytes->size()) {
    return InvalidInput(path, "truncated TIFF, too few bytes for its size");
  }
  return OkStatus();
}

StatusOr<Blocks> ReadBlocks(const std::string& path, TIFF* tiff,
                            const Layout& layout, const ImageLimits& limits,
                            const MemoryFile& file) {
  Blocks blocks;
  blocks.tiled = TIFFIsTiled(tiff) != 0;
  if (blocks.tiled) {
    blocks.width = Field<uint32_t>(tiff, TIFFTAG_TILEWIDTH, 0);
    blocks.height = Field<uint32_t>(tiff, TIFFTAG_TILELENGTH, 0);
    IBRDF_RETURN_IF_ERROR(
        CheckImageSize(path + ": tile", blocks.width, blocks.height, limits));
  } else {
    blocks.width = layout.width;
    blocks.height =
        std::min(layout.height, Field<uint32_t>(tiff, TIFFTAG_ROWSPERSTRIP, 0));
    if (blocks.height == 0) {
      return InvalidInput(path + ": RowsPerStrip", "expected 1 or more");
    }
  }
  const size_t samples =
      static_cast<size_t>(layout.planes ? 1 : layout.samples);
  const size_t row_bytes =
      (blocks.width * samples * static_cast<size_t>(layout.bits) + 7) / 8;
  blocks.bytes = row_bytes * blocks.height;
  IBRDF_RETURN_IF_ERROR(CheckMemory(path, tiff, layout, blocks.bytes, file));
  const uint64_t claimed =
      blocks.tiled ? TIFFTileSize64(tiff) : TIFFStripSize64(tiff);
  if (claimed != blocks.bytes) {
    return InvalidInput(path, "expected strips or tiles of " +
                                  std::to_string(blocks.bytes) +
                                  " bytes, found " + std::to_string(claimed));
  }
  return blocks;
}

Status ReadBlock(const std::string& path, TIFF* tiff, const Layout& layout,
                 const Blocks& blocks, const Block& block,
                 const MemoryFile& file, std::vector<uint8_t>* data) {
  const uint16_t plane = static_cast<uint16_t>(block.plane);
  const size_t row_bytes = blocks.bytes / blocks.height;
  const size_t expected =
      blocks.tiled
          ? blocks.bytes
          : row_bytes * std::min(blocks.height, layout.height - block.y);
  const uint32_t index = blocks.tiled
                             ? TIFFComputeTile(tiff, block.x, block.y, 0, plane)
                             : TIFFComputeStrip(tiff, block.y, plane);
  const tmsize_t size = static_cast<tmsize_t>(expected);
  const tmsize_t read =
      blocks.tiled ? TIFFReadEncodedTile(tiff, index, data->data(), size)
                   : TIFFReadEncodedStrip(tiff, index, data->data(), size);
  if (read != size || !file.message.empty()) return BlockError(path, file);
  return OkStatus();
}

StatusOr<TiffPixels> ReadTiffPixels(const std::string& path, TIFF* tiff,
                                    const Layout& layout,
                                    const ImageLimits& limits,
                                    MemoryFile* file) {
  const StatusOr<Blocks> blocks = ReadBlocks(path, tiff, layout, limits, *file);
  if (!blocks.ok()) return blocks.status();
  std::vector<uint8_t> data(blocks->bytes);
  TiffPixels pixels;
  file->message.clear();
  file->strict = true;
  for (int plane = 0; plane < (layout.planes ? layout.samples : 1); ++plane) {
    for (uint32_t y = 0; y < layout.height; y += blocks->height) {
      for (uint32_t x = 0; x < layout.width; x += blocks->width) {
        const Block block = {x, y, blocks->width, blocks->height, plane};
        IBRDF_RETURN_IF_ERROR(
            ReadBlock(path, tiff, layout, *blocks, block, *file, &data));
        if (pixels.image.empty()) {  // the first block is whole
          pixels.image = Image(static_cast<int>(layout.width),
                               static_cast<int>(layout.height));
          if (layout.alpha >= 0) pixels.alpha.resize(pixels.image.num_pixels());
        }
        CopyBlock(layout, block, data, &pixels);
      }
    }
  }
  return pixels;
}

// Indices -> colours. Entries have 16 bits; those of 8-bit writers are 257
// times a code, or, of old ones, below 256.
Status ApplyPalette(const std::string& path, TIFF* tiff, int index_bits,
                    Photo* photo) {
  uint16_t* maps[3] = {};
  if (TIFFGetField(tiff, TIFFTAG_COLORMAP, &maps[0], &maps[1], &maps[2]) != 1) {
    return InvalidInput(path + ": palette", "expected one, found none");
  }
  const size_t count = size_t{1} << index_bits;
  bool small = true, repeated = true;
  for (const uint16_t* map : maps) {
    for (size_t k = 0; k < count; ++k) {
      small = small && map[k] < 256;
      repeated = repeated && map[k] % 257 == 0;
    }
  }
  const float divisor = repeated && !small ? 257.0f : 1.0f;
  photo->bits = small || repeated ? 8 : 16;
  for (size_t i = 0; i < photo->image.rgb.size(); i += 3) {
    const size_t index = static_cast<size_t>(photo->image.rgb[i]);
    for (size_t c = 0; c < 3; ++c) {
      photo->image.rgb[i + c] = maps[c][index] / divisor;
    }
  }
  return OkStatus();
}

void ReadTiffTags(TIFF* tiff, const std::string& bytes, Photo* photo) {
  // BigTIFF's tables are of another kind.
  if (TIFFIsBigTIFF(tiff) == 0) AddExif(ParseExif(bytes), photo);
  const uint16_t orientation = Field<uint16_t>(tiff, TIFFTAG_ORIENTATION, 1);
  photo->orientation = orientation >= 1 && orientation <= 8 ? orientation : 1;
  float x = 0.0f, y = 0.0f;
  if (TIFFGetField(tiff, TIFFTAG_XRESOLUTION, &x) == 1 &&
      TIFFGetField(tiff, TIFFTAG_YRESOLUTION, &y) == 1 && x > 0.0f &&
      y > 0.0f && std::isfinite(x) && std::isfinite(y)) {
    photo->pixel_aspect = static_cast<double>(y) / x;
  }
  uint32_t size = 0;
  const void* profile = nullptr;
  if (TIFFGetField(tiff, TIFFTAG_ICCPROFILE, &size, &profile) == 1) {
    photo->tags.icc =
        ParseIccProfile({static_cast<const char*>(profile), size});
  }
}

// The first picture that is not a smaller version of another.
void SkipThumbnails(TIFF* tiff) {
  for (int k = 0; k < kMaxPictures; ++k) {
    const uint32_t kind = Field<uint32_t>(tiff, TIFFTAG_SUBFILETYPE, 0);
    if ((kind & FILETYPE_REDUCEDIMAGE) == 0) return;
    if (TIFFReadDirectory(tiff) != 1) break;
  }
  TIFFSetDirectory(tiff, 0);
}

}  // namespace

StatusOr<Photo> DecodeTiffPhoto(const std::string& path,
                                const std::string& bytes,
                                const PhotoOptions& options) {
  MemoryFile file;
  file.bytes = &bytes;
  // libtiff's own tables grow with the file, its buffers with a strip or tile.
  constexpr size_t kMaxPixelBytes = kMaxSamples * sizeof(double);
  constexpr size_t kOwnTables = size_t{1} << 20;
  const size_t largest =
      std::max({kOwnTables, 2 * bytes.size(),
                kMaxPixelBytes * static_cast<size_t>(options.limits.pixels)});
  const TiffHandle tiff = OpenTiff(&file, largest);
  if (tiff == nullptr) return BlockError(path, file);
  SkipThumbnails(tiff.get());
  const StatusOr<Layout> layout = ReadLayout(path, tiff.get(), options.limits);
  if (!layout.ok()) return layout.status();
  StatusOr<TiffPixels> pixels =
      ReadTiffPixels(path, tiff.get(), *layout, options.limits, &file);
  if (!pixels.ok()) return pixels.status();

  Photo photo;
  photo.format = PhotoFormat::kTiff;
  photo.image = std::move(pixels->image);
  photo.bits = layout->floats() ? 0 : layout->bits;
  const float largest_code =
      layout->floats() ? 1.0f : static_cast<float>((1 << layout->bits) - 1);
  if (layout->colours == 1) {
    const bool invert = layout->photometric == PHOTOMETRIC_MINISWHITE;
    for (size_t i = 0; i < photo.image.rgb.size(); i += 3) {
      float* rgb = &photo.image.rgb[i];
      if (invert) rgb[0] = largest_code - rgb[0];
      rgb[1] = rgb[2] = rgb[0];
    }
  }
  if (layout->photometric == PHOTOMETRIC_PALETTE) {
    IBRDF_RETURN_IF_ERROR(ApplyPalette(path, tiff.get(), layout->bits, &photo));
  } else {
    photo.grey = layout->colours == 1;
  }
  photo.significant_bits = photo.bits;
  for (float& alpha : pixels->alpha) alpha /= largest_code;
  if (!pixels->alpha.empty()) SetAlpha(pixels->alpha, &photo);
  ReadTiffTags(tiff.get(), bytes, &photo);
  return photo;
}

}  // namespace ibrdf
