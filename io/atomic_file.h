// Files that are whole or absent.
#pragma once
#include <functional>
#include <string>

#include "ibrdf/base/status.h"

namespace ibrdf {

// Calls write(temporary) with a name beside `path`, then flushes the file to
// disk and renames it to `path`. The temporary file is removed when write
// throws or fails, or the rename fails; what a writer of the same path left
// that was killed on this machine is removed too. The message names `path`.
Status WriteAtomically(const std::string& path,
                       const std::function<Status(const std::string&)>& write);

// The same for bytes in memory.
Status WriteFileAtomically(const std::string& path, const std::string& bytes);

// Whole file as bytes; refuses one longer than `max_bytes`.
StatusOr<std::string> ReadFile(const std::string& path, size_t max_bytes);

}  // namespace ibrdf
