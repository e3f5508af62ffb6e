#include "ibrdf/io/image_limits.h"

namespace ibrdf {

Status CheckImageSize(const std::string& path, int64_t width, int64_t height,
                      const ImageLimits& limits) {
  const bool sides_ok = width >= 1 && height >= 1 && width <= limits.side &&
                        height <= limits.side;
  if (sides_ok && width * height <= limits.pixels) return OkStatus();
  return InvalidInput(path + ": size",
                      "expected sides from 1 to " +
                          std::to_string(limits.side) + " and at most " +
                          std::to_string(limits.pixels) + " pixels, found " +
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
