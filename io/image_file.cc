#include "ibrdf/io/image_file.h"

#include "ibrdf/io/exr.h"
#include "ibrdf/io/file_extension.h"
#include "ibrdf/io/radiance_hdr.h"

namespace ibrdf {
namespace {

Status UnknownExtension(const std::string& path) {
  return InvalidInput(path + ": extension", "expected .exr or .hdr");
}

}  // namespace

StatusOr<Image> ReadImage(const std::string& path) {
  const std::string extension = FileExtension(path);
  if (extension == "exr") return ReadExr(path);
  if (extension == "hdr") return ReadRadianceHdr(path);
  return UnknownExtension(path);
}

Status WriteImage(const Image& image, const std::string& path) {
  const std::string extension = FileExtension(path);
  if (extension == "exr") return WriteExr(image, path);
  if (extension == "hdr") return WriteRadianceHdr(image, path);
  return UnknownExtension(path);
}

}  // namespace ibrdf
