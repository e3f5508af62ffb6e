// Environment maps in files, where their frames meet the library's.
#pragma once
#include <optional>
#include <string>
#include <vector>

#include "ibrdf/base/status.h"
#include "ibrdf/image/image.h"
#include "ibrdf/io/image_limits.h"
#include "ibrdf/light/map_frame.h"

namespace ibrdf {

// A map as its file has it.
struct StoredMap {
  Image image;  // in `frame`; finite, >= 0
  MapFrame frame = MapFrame::kCamera;
  // Sentences for the user, that begin with the path: values below 0 that were
  // set to 0, layers, a frame that the file states otherwise.
  std::vector<std::string> warnings;
};

// Any format of photo_file.h that holds floats. Those of codes (PNG, JPEG, TIFF
// of whole numbers) are refused: what is brighter than their white, such as
// lamps and the sun, is most of the light.
//
// The frame is `frame`, where the user states it, with a warning where the file
// says another. Else it is what the file says: the attribute ibrdf:frame of
// our OpenEXR files, else OpenEXR's envmap (latlong: openexr; cube: cube_cross,
// whose column layout is OpenEXR's). A file that says nothing is camera.
//
// Refuses sizes that the frame does not take, values that are not finite and
// those that ClampNegativeRadiance refuses.
StatusOr<StoredMap> ReadStoredMap(const std::string& path,
                                  std::optional<MapFrame> frame);

// The same of a file's bytes; messages call it `path`.
StatusOr<StoredMap> DecodeStoredMap(const std::string& path,
                                    const std::string& bytes,
                                    std::optional<MapFrame> frame,
                                    const ImageLimits& limits = {});

// A stored map in the library's frame, as fine as the file. `warnings` receives
// those of the stored map, `taken` its frame; both may be null.
StatusOr<Image> ReadMap(const std::string& path, std::optional<MapFrame> frame,
                        std::vector<std::string>* warnings = nullptr,
                        MapFrame* taken = nullptr);

// Writes a map of the library to an .exr file in `frame` (FromLibraryFrame),
// with the attribute ibrdf:frame, and envmap where the frame is openexr. Whole
// or absent.
Status WriteMap(const Image& map, MapFrame frame, const std::string& path);

}  // namespace ibrdf
