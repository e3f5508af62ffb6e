// MERL `.binary` BRDF tables.
#pragma once
#include <array>
#include <cstdint>
#include <string>
#include <vector>

#include "ibrdf/base/status.h"
#include "ibrdf/brdf/merl_table.h"

namespace ibrdf {

// Layout: int32 90, 90, 180, then float64 planes red, green, blue, little
// endian. Refuses other dimensions, a file of another length, NaN or infinite
// entries, and a table without a valid bin; the message names the file.
StatusOr<MerlTable> ReadMerl(const std::string& path);

// The entries of a file's bytes, with `bins` in place of 90, 90, 180; messages
// call it `path`.
StatusOr<std::vector<double>> DecodeMerl(
    const std::string& path, const std::string& bytes,
    const std::array<int32_t, 3>& bins = {kMerlThetaH, kMerlThetaD, kMerlPhiD});

// Writes to a temporary name beside `path` and renames.
Status WriteMerl(const MerlTable& table, const std::string& path);

}  // namespace ibrdf
