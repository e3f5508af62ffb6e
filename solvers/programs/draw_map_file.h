// A picture of how a map in a file is understood.
#pragma once
#include <optional>
#include <string>
#include <vector>

#include "ibrdf/base/status.h"
#include "ibrdf/light/map_frame.h"

namespace ibrdf {

// Writes DrawMapFrame of the map in `path` to the .png file `picture`. The
// frame is found as by ReadStoredMap. `warnings` receives those of the map.
Status DrawMapFile(const std::string& path, std::optional<MapFrame> frame,
                   const std::string& picture,
                   std::vector<std::string>* warnings);

}  // namespace ibrdf
