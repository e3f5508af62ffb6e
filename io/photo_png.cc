#include "ibrdf/io/photo_png.h"

#include <png.h>

#include <algorithm>
#include <cmath>
#include <csetjmp>
#include <string_view>

#include "ibrdf/io/chromaticities.h"
#include "ibrdf/io/exif.h"
#include "ibrdf/io/icc_profile.h"
#include "ibrdf/io/png_memory.h"

namespace ibrdf {
namespace {

struct PhotoState : PngReadState {
  using PngReadState::PngReadState;

  png_uint_32 width = 0;
  png_uint_32 height = 0;
  int depth = 0;
  int type = 0;
  int channels = 0;
  size_t row_bytes = 0;
};

// Reads up to the pixels and asks for one or two bytes a sample.
bool ReadPhotoHeader(PhotoState* state) {
  if (!OpenPng(state)) return false;
  if (setjmp(png_jmpbuf(state->png)) != 0) return false;
  static const png_byte kCicp[] = "cICP";
  png_set_keep_unknown_chunks(state->png, PNG_HANDLE_CHUNK_ALWAYS, kCicp, 1);
  png_read_info(state->png, state->info);
  state->width = png_get_image_width(state->png, state->info);
  state->height = png_get_image_height(state->png, state->info);
  state->depth = png_get_bit_depth(state->png, state->info);
  state->type = png_get_color_type(state->png, state->info);
  state->channels = png_get_channels(state->png, state->info);
  png_set_packing(state->png);
  png_set_interlace_handling(state->png);
  png_read_update_info(state->png, state->info);
  state->row_bytes = png_get_rowbytes(state->png, state->info);
  return true;
}

// Ends of the alpha range and how samples become colours.
class Samples {
 public:
  explicit Samples(const PhotoState& state)
      : two_bytes_(state.depth == 16), channels_(state.channels) {}

  // Sample c of pixel i.
  uint32_t At(const uint8_t* pixels, size_t i, size_t c) const {
    const size_t k = i * static_cast<size_t>(channels_) + c;
    if (!two_bytes_) return pixels[k];
    return static_cast<uint32_t>(pixels[2 * k] << 8 | pixels[2 * k + 1]);
  }

 private:
  const bool two_bytes_;
  const int channels_;
};

// Colours and alpha by the palette.
Status FromPalette(const std::string& path, const PhotoState& state,
                   const std::vector<uint8_t>& pixels, Photo* photo,
                   std::vector<float>* alpha) {
  png_colorp palette = nullptr;
  int count = 0;
  png_get_PLTE(state.png, state.info, &palette, &count);
  png_bytep transparency = nullptr;
  int transparent = 0;
  png_get_tRNS(state.png, state.info, &transparency, &transparent, nullptr);
  if (transparency == nullptr) transparent = 0;
  if (transparent > 0) alpha->assign(pixels.size(), 1.0f);
  for (size_t i = 0; i < pixels.size(); ++i) {
    const int index = pixels[i];
    if (index >= count) {
      return InvalidInput(path + ": palette", "expected " +
                                                  std::to_string(index + 1) +
                                                  " colours or more, found " +
                                                  std::to_string(count));
    }
    const png_color& colour = palette[index];
    float* rgb = &photo->image.rgb[3 * i];
    rgb[0] = colour.red;
    rgb[1] = colour.green;
    rgb[2] = colour.blue;
    if (index < transparent) (*alpha)[i] = transparency[index] / 255.0f;
  }
  photo->bits = 8;
  return OkStatus();
}

void FromSamples(const PhotoState& state, const std::vector<uint8_t>& pixels,
                 Photo* photo, std::vector<float>* alpha) {
  const Samples samples(state);
  const bool colour = (state.type & PNG_COLOR_MASK_COLOR) != 0;
  const bool has_alpha = (state.type & PNG_COLOR_MASK_ALPHA) != 0;
  const size_t count = photo->image.num_pixels();
  png_color_16p clear = nullptr;
  if (!has_alpha &&
      png_get_tRNS(state.png, state.info, nullptr, nullptr, &clear) == 0) {
    clear = nullptr;
  }
  if (has_alpha || clear != nullptr) alpha->assign(count, 1.0f);
  const float largest = static_cast<float>((1 << state.depth) - 1);
  for (size_t i = 0; i < count; ++i) {
    float* rgb = &photo->image.rgb[3 * i];
    for (size_t c = 0; c < 3; ++c) {
      rgb[c] = static_cast<float>(
          samples.At(pixels.data(), i, colour ? c : size_t{0}));
    }
    if (has_alpha) {
      (*alpha)[i] =
          static_cast<float>(samples.At(pixels.data(), i, colour ? 3 : 1)) /
          largest;
    } else if (clear != nullptr) {
      const bool same = colour
                            ? rgb[0] == clear->red && rgb[1] == clear->green &&
                                  rgb[2] == clear->blue
                            : rgb[0] == clear->gray;
      if (same) (*alpha)[i] = 0.0f;
    }
  }
  photo->grey = !colour;
  photo->bits = state.depth;
}

// The chunk of unknown name that libpng was asked to keep.
void ReadCicp(const PhotoState& state, ColourTags* tags) {
  png_unknown_chunkp chunks = nullptr;
  const int count = png_get_unknown_chunks(state.png, state.info, &chunks);
  for (int k = 0; k < count; ++k) {
    const std::string_view name(reinterpret_cast<const char*>(chunks[k].name));
    if (name != "cICP" || chunks[k].size != 4) continue;
    const png_byte* data = chunks[k].data;
    tags->cicp = {data[0], data[1], data[2], data[3]};
  }
}

void ReadColourTags(const PhotoState& state, Photo* photo) {
  ColourTags* tags = &photo->tags;
  double gamma = 0.0;
  int intent = 0;
  tags->png_srgb = png_get_sRGB(state.png, state.info, &intent) != 0;
  if (!tags->png_srgb && png_get_gAMA(state.png, state.info, &gamma) != 0 &&
      gamma > 0.0) {
    tags->png_gamma = gamma;
  }
  ReadCicp(state, tags);
  png_charp name = nullptr;
  png_bytep profile = nullptr;
  png_uint_32 size = 0;
  int method = 0;
  if (png_get_iCCP(state.png, state.info, &name, &method, &profile, &size) !=
      0) {
    tags->icc =
        ParseIccProfile({reinterpret_cast<const char*>(profile), size_t{size}});
  }
  PrimaryColours file;
  if (png_get_cHRM(state.png, state.info, &file.white.x(), &file.white.y(),
                   &file.red.x(), &file.red.y(), &file.green.x(),
                   &file.green.y(), &file.blue.x(), &file.blue.y()) != 0) {
    tags->png_other_primaries = !AreSamePrimaries(file, PrimaryColours());
  }
}

void ReadOtherTags(const PhotoState& state, Photo* photo) {
  png_color_8p bits = nullptr;
  photo->significant_bits = photo->bits;
  if (png_get_sBIT(state.png, state.info, &bits) != 0) {
    const int most = photo->grey
                         ? bits->gray
                         : std::max({bits->red, bits->green, bits->blue});
    if (most >= 1) photo->significant_bits = std::min(most, photo->bits);
  }
  png_uint_32 x = 0, y = 0;
  int unit = 0;
  if (png_get_pHYs(state.png, state.info, &x, &y, &unit) != 0 && x > 0 &&
      y > 0) {
    photo->pixel_aspect = static_cast<double>(y) / x;
  }
  png_bytep exif = nullptr;
  png_uint_32 size = 0;
  if (png_get_eXIf_1(state.png, state.info, &size, &exif) != 0) {
    AddExif(ParseExif({reinterpret_cast<const char*>(exif), size_t{size}}),
            photo);
  }
}

}  // namespace

StatusOr<Photo> DecodePngPhoto(const std::string& path,
                               const std::string& bytes,
                               const PhotoOptions& options) {
  PhotoState state(bytes);
  if (!ReadPhotoHeader(&state)) return PngError(path, state);
  IBRDF_RETURN_IF_ERROR(
      CheckImageSize(path, state.width, state.height, options.limits));
  // Unpacking grows one-bit pixels 8-fold.
  const StatusOr<std::vector<uint8_t>> read =
      ReadPngPixels(path, state.height, state.row_bytes, 8, &state);
  if (!read.ok()) return read.status();
  const std::vector<uint8_t>& pixels = *read;

  Photo photo;
  photo.format = PhotoFormat::kPng;
  photo.image =
      Image(static_cast<int>(state.width), static_cast<int>(state.height));
  std::vector<float> alpha;
  if (state.type == PNG_COLOR_TYPE_PALETTE) {
    IBRDF_RETURN_IF_ERROR(FromPalette(path, state, pixels, &photo, &alpha));
  } else {
    FromSamples(state, pixels, &photo, &alpha);
  }
  if (!alpha.empty()) SetAlpha(alpha, &photo);
  ReadColourTags(state, &photo);
  ReadOtherTags(state, &photo);
  return photo;
}

}  // namespace ibrdf
