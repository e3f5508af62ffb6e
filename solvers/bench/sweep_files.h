// Names of materials and maps as files of a folder, for the sweeps.
#pragma once
#include <cstddef>
#include <string>
#include <vector>

#include "ibrdf/base/status.h"

namespace ibrdf {

// Extensions of the maps that a sweep takes.
std::vector<std::string> MapExtensions();

// Absolute path of the file in `folder` called `name` with one of the
// extensions (".binary"), the first that is there; empty: none.
std::string FindFile(const std::string& folder, const std::string& name,
                     const std::vector<std::string>& extensions);

// Names without extension of the files with one of the extensions, sorted,
// each once. Fails where the folder cannot be read; names it.
StatusOr<std::vector<std::string>> ListNames(
    const std::string& folder, const std::vector<std::string>& extensions);

// Files of more bytes are not read: settings that a sweep wrote, a result.json
// or log of a solver.
inline constexpr size_t kMaxSettingsBytes = size_t{1} << 20;
inline constexpr size_t kMaxResultBytes = size_t{1} << 28;

// Whether a name may stand in results.csv and as part of a file name.
Status CheckCaseName(const std::string& name);

}  // namespace ibrdf
