// OpenEXR images.
#pragma once
#include <optional>
#include <string>

#include "ibrdf/base/status.h"
#include "ibrdf/image/image.h"
#include "ibrdf/io/image_limits.h"
#include "ibrdf/io/photo.h"

namespace ibrdf {

// Reads radiance or a normal map (three floats a pixel). Half, float and uint
// channels, scanline or tiled (level 0), any compression; the first part of a
// multi-part file. Channels by name: R, G, B; else Y as grey; else the R, G, B
// or the Y of the only layer that has them ("diffuse.R"). The image is the
// file's data window; the display window is ignored. Values are kept as they
// are, NaN, infinite and negative ones too.
// Refuses other channels (the message lists those found), subsampled channels,
// deep data, incomplete files, and sizes over those of io/image_limits.h.
StatusOr<Image> ReadExr(const std::string& path);

// The same of a file's bytes; messages call it `path`.
StatusOr<Image> DecodeExr(const std::string& path, const std::string& bytes,
                          const ImageLimits& limits = {});

enum class ExrPixelType {
  kFloat,  // exact
  kHalf,   // 11 bits of precision; finite values are clamped to +-65504
};

// Attributes of an environment map; empty: not written.
struct ExrMapAttributes {
  std::optional<ExrEnvmap> envmap;
  std::string map_frame;  // ibrdf:frame
};

// Scanlines, channels R, G, B, ZIP compression. Whole or absent.
Status WriteExr(const Image& image, const std::string& path,
                ExrPixelType type = ExrPixelType::kFloat,
                const ExrMapAttributes& attributes = {});

}  // namespace ibrdf
