// MERL `.binary` BRDF tables.
#pragma once
#include <string>

#include "ibrdf/base/status.h"
#include "ibrdf/brdf/merl_table.h"

namespace ibrdf {

// Layout: int32 90, 90, 180, then float64 planes red, green, blue, little
// endian. Refuses other dimensions, a file of another length, and NaN or
// infinite entries; the message names the file.
StatusOr<MerlTable> ReadMerl(const std::string& path);

// Writes to a temporary name beside `path` and renames.
Status WriteMerl(const MerlTable& table, const std::string& path);

}  // namespace ibrdf
