#include "ibrdf/solvers/problem/load_depth.h"

#include <cmath>
#include <limits>
#include <string>
#include <utility>

#include "ibrdf/io/photo_file.h"
#include "ibrdf/solvers/problem/depth_normals.h"

namespace ibrdf {
namespace {

constexpr double kNothing = 1e8;
constexpr float kLargestHalf = 65504.0f;

bool IsHole(float value, bool codes) {
  return !std::isfinite(value) || value == 0.0f ||
         (!codes && (std::abs(value) > kNothing || value == kLargestHalf));
}

Status CheckFile(const GeometrySpec& geometry, const Photo& photo) {
  IBRDF_RETURN_IF_ERROR(CheckSquarePixels(geometry.file, photo));
  if (photo.format == PhotoFormat::kJpeg) {
    return InvalidInput(geometry.file,
                        "expected depth in OpenEXR, PFM, PNG, TIFF or .npy, "
                        "found JPEG, which loses what normals need");
  }
  if (photo.bits > 0 && !geometry.depth_scale.has_value()) {
    return InvalidInput(geometry.file,
                        "expected geometry.depth_scale for a file of whole "
                        "numbers: the depth of one step");
  }
  const std::vector<float>& v = photo.image.rgb;
  for (size_t k = 0; k < v.size(); k += 3) {
    const bool alike = (v[k] == v[k + 1] && v[k] == v[k + 2]) ||
                       (std::isnan(v[k]) && std::isnan(v[k + 1]));
    if (alike) continue;
    return InvalidInput(geometry.file + ": channels",
                        "expected one for depth, found several that differ");
  }
  return OkStatus();
}

StatusOr<DepthMap> ReadDepthMap(const GeometrySpec& geometry,
                                const Photo& photo, bool perspective) {
  const double scale = geometry.depth_scale.value_or(1.0);
  DepthMap map;
  map.width = photo.image.width;
  map.height = photo.image.height;
  map.depth.reserve(photo.image.num_pixels());
  for (size_t i = 0; i < photo.image.num_pixels(); ++i) {
    const float value = photo.image.rgb[3 * i];
    const bool hole = IsHole(value, photo.bits > 0) || !photo.has_data.Holds(i);
    map.depth.push_back(hole ? std::numeric_limits<double>::quiet_NaN()
                             : scale * static_cast<double>(value));
    if (!hole && perspective && map.depth.back() < 0.0) {
      return InvalidInput(geometry.file,
                          "expected depth > 0 before a perspective camera, "
                          "found " +
                              std::to_string(map.depth.back()));
    }
  }
  return map;
}

PhotoOptions DepthOptions(const ImageLimits& limits) {
  PhotoOptions options;
  options.content = PhotoContent::kDepth;
  options.limits = limits;
  return options;
}

StatusOr<NormalMap> NormalsOfPhoto(const GeometrySpec& geometry,
                                   const Camera& camera,
                                   const StatusOr<Photo>& photo) {
  if (!photo.ok()) return photo.status();
  IBRDF_RETURN_IF_ERROR(CheckFile(geometry, *photo));
  const StatusOr<DepthMap> map =
      ReadDepthMap(geometry, *photo, camera.type == CameraType::kPerspective);
  if (!map.ok()) return map.status();
  DepthNormals found = NormalsOfDepth(*map, camera);
  if (found.known == found.isolated) {
    return InvalidInput(geometry.file,
                        "expected depth in neighbouring pixels, found " +
                            std::to_string(found.known) +
                            " pixels of depth that have no neighbours");
  }
  NormalMap out;
  out.normals = std::move(found.normals);
  if (found.isolated > 0) {
    out.warnings.push_back(geometry.file + ": " +
                           std::to_string(found.isolated) + " of " +
                           std::to_string(found.known) +
                           " pixels of depth have no neighbours along x or y "
                           "and so no normal");
  }
  if (photo->bits == 8) {
    out.warnings.push_back(geometry.file +
                           ": depth in 256 steps gives rough normals; write "
                           "16 bits or floats");
  }
  return out;
}

}  // namespace

StatusOr<NormalMap> LoadDepth(const GeometrySpec& geometry,
                              const Camera& camera) {
  return NormalsOfPhoto(geometry, camera,
                        ReadPhoto(geometry.file, DepthOptions({})));
}

StatusOr<NormalMap> DecodeDepth(const GeometrySpec& geometry,
                                const Camera& camera, const std::string& bytes,
                                const ImageLimits& limits) {
  return NormalsOfPhoto(
      geometry, camera,
      DecodePhoto(geometry.file, bytes, DepthOptions(limits)));
}

}  // namespace ibrdf
