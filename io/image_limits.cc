#include "io/image_limits.h"

namespace ibrdf {

Status CheckImageSize(const std::string& path, int64_t width, int64_t height) {
  const bool sides_ok = width >= 1 && height >= 1 && width <= kMaxImageSide &&
                        height <= kMaxImageSide;
  if (sides_ok && width * height <= kMaxImagePixels) return OkStatus();
  return InvalidInput(path + ": size",
                      "expected sides from 1 to " +
                          std::to_string(kMaxImageSide) + " and at most " +
                          std::to_string(kMaxImagePixels) + " pixels, found " +
                          std::to_string(width) + "x" + std::to_string(height));
}

Status CheckWritable(const std::string& path, int width, int height,
                     size_t values) {
  const Status size = CheckImageSize(path, width, height);
  if (!size.ok()) return Status(StatusCode::kInternal, size.message());
  if (values != size_t{3} * width * height) {
    return Status(StatusCode::kInternal,
                  path + ": image has " + std::to_string(values) +
                      " values, expected 3 x width x height");
  }
  return OkStatus();
}

}  // namespace ibrdf
