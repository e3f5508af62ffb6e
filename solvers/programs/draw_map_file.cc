#include "ibrdf/solvers/programs/draw_map_file.h"

#include "ibrdf/io/file_extension.h"
#include "ibrdf/io/map_file.h"
#include "ibrdf/io/png.h"
#include "ibrdf/solvers/drawing/map_picture.h"

namespace ibrdf {

Status DrawMapFile(const std::string& path, std::optional<MapFrame> frame,
                   const std::string& picture,
                   std::vector<std::string>* warnings) {
  if (FileExtension(picture) != "png") {
    return InvalidInput("command line: PICTURE",
                        "expected a .png file, found '" + picture + "'");
  }
  const StatusOr<StoredMap> map = ReadStoredMap(path, frame);
  if (!map.ok()) return map.status();
  *warnings = map->warnings;
  return WritePng(DrawMapFrame(map->image, map->frame), picture);
}

}  // namespace ibrdf
