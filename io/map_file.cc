#include "ibrdf/io/map_file.h"

#include "ibrdf/io/exr.h"
#include "ibrdf/io/photo_file.h"
#include "ibrdf/light/convert_map.h"
#include "ibrdf/light/negative_radiance.h"

namespace ibrdf {
namespace {

// The frame that a file states.
struct FileFrame {
  std::optional<MapFrame> frame;
  std::string attribute;  // the one that states it
};

StatusOr<FileFrame> FrameOfFile(const std::string& path, const Photo& photo) {
  if (!photo.map_frame.empty()) {
    const StatusOr<MapFrame> frame = ParseMapFrame(
        path + ": attribute " + kMapFrameAttribute, photo.map_frame);
    if (!frame.ok()) return frame.status();
    return FileFrame{*frame, kMapFrameAttribute};
  }
  if (!photo.envmap.has_value()) return FileFrame{};
  return FileFrame{*photo.envmap == ExrEnvmap::kCube ? MapFrame::kCubeCross
                                                     : MapFrame::kOpenExr,
                   "envmap"};
}

// Whether both words are the same of a map of this size.
bool AgreeAbout(MapFrame a, MapFrame b, MapSize size) {
  const auto column = [&](MapFrame frame) {
    return (frame == MapFrame::kOpenExr || frame == MapFrame::kCubeCross) &&
           size.height == 6 * size.width;
  };
  const auto blender = [](MapFrame frame) {
    return frame == MapFrame::kBlender || frame == MapFrame::kPolyHavenYUp;
  };
  return a == b || (column(a) && column(b)) || (blender(a) && blender(b));
}

// Sets the frame of `map`, whose image is there.
Status ChooseFrame(const std::string& path, const Photo& photo,
                   std::optional<MapFrame> stated, StoredMap* map) {
  const MapSize size = {map->image.width, map->image.height};
  const StatusOr<FileFrame> file = FrameOfFile(path, photo);
  if (stated.has_value()) {
    map->frame = *stated;
    if (file.ok() && file->frame.has_value() &&
        !AgreeAbout(*stated, *file->frame, size)) {
      map->warnings.push_back(path + ": the frame " + MapFrameName(*stated) +
                              " is taken as asked for; the file's attribute " +
                              file->attribute + " says " +
                              MapFrameName(*file->frame));
    }
    return CheckMapSize(path, map->frame, size);
  }
  if (!file.ok()) return file.status();
  map->frame = file->frame.value_or(MapFrame::kCamera);
  const Status fits = CheckMapSize(path, map->frame, size);
  if (fits.ok()) return fits;
  return Status(fits.code(),
                fits.message() +
                    (file->frame.has_value()
                         ? "; the frame is that of the file's attribute " +
                               file->attribute
                         : std::string("; the file says no frame: state it")));
}

Status CheckFloats(const std::string& path, const Photo& photo) {
  if (photo.bits == 0) return OkStatus();
  return InvalidInput(
      path, std::string("expected radiance in floats (OpenEXR, Radiance HDR, "
                        "PFM, TIFF, .npy), found a ") +
                NameOf(photo.format) + " file of " +
                std::to_string(photo.bits) +
                " bits, which cuts off lamps and the sun");
}

// The map of a picture, whose floats are its radiance.
StatusOr<StoredMap> MapOfPhoto(const std::string& path,
                               std::optional<MapFrame> frame,
                               StatusOr<Photo> photo) {
  if (!photo.ok()) return photo.status();
  IBRDF_RETURN_IF_ERROR(CheckFloats(path, *photo));
  StoredMap map;
  map.image = std::move(photo->image);
  for (const std::string& note : photo->notes) {
    map.warnings.push_back(path + ": " + note);
  }
  IBRDF_RETURN_IF_ERROR(ChooseFrame(path, *photo, frame, &map));
  const StatusOr<NegativeRadiance> below =
      ClampNegativeRadiance(path, map.frame, &map.image);
  if (!below.ok()) return below.status();
  if (below->values > 0) {
    map.warnings.push_back(path + ": " + std::to_string(below->values) +
                           " values below 0, down to " +
                           std::to_string(below->lowest) + ", were set to 0");
  }
  return map;
}

}  // namespace

StatusOr<StoredMap> ReadStoredMap(const std::string& path,
                                  std::optional<MapFrame> frame) {
  return MapOfPhoto(path, frame, ReadPhoto(path));
}

StatusOr<StoredMap> DecodeStoredMap(const std::string& path,
                                    const std::string& bytes,
                                    std::optional<MapFrame> frame,
                                    const ImageLimits& limits) {
  PhotoOptions options;
  options.limits = limits;
  return MapOfPhoto(path, frame, DecodePhoto(path, bytes, options));
}

StatusOr<Image> ReadMap(const std::string& path, std::optional<MapFrame> frame,
                        std::vector<std::string>* warnings, MapFrame* taken) {
  const StatusOr<StoredMap> stored = ReadStoredMap(path, frame);
  if (!stored.ok()) return stored.status();
  if (warnings != nullptr) {
    warnings->insert(warnings->end(), stored->warnings.begin(),
                     stored->warnings.end());
  }
  if (taken != nullptr) *taken = stored->frame;
  return ToLibraryFrame(path, stored->image, stored->frame);
}

Status WriteMap(const Image& map, MapFrame frame, const std::string& path) {
  const StatusOr<Image> stored = FromLibraryFrame(path, map, frame);
  if (!stored.ok()) return stored.status();
  ExrMapAttributes attributes;
  attributes.map_frame = MapFrameName(frame);
  if (frame == MapFrame::kOpenExr) attributes.envmap = ExrEnvmap::kLatLong;
  return WriteExr(*stored, path, ExrPixelType::kFloat, attributes);
}

}  // namespace ibrdf
