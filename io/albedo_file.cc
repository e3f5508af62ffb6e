#include "ibrdf/io/albedo_file.h"

#include <utility>

#include "ibrdf/io/photo_file.h"

namespace ibrdf {

StatusOr<Image> ReadAlbedo(const std::string& path) {
  StatusOr<Photo> photo = ReadPhoto(path);
  if (!photo.ok()) return photo.status();
  if (photo->bits > 0) {
    const auto white = static_cast<float>((1u << photo->bits) - 1u);
    for (float& v : photo->image.rgb) v /= white;
  }
  return std::move(photo->image);
}

}  // namespace ibrdf
