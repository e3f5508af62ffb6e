// Checks of mesh files that come before the importer, which trusts its input.
#pragma once
#include <string>

#include "ibrdf/base/status.h"

namespace ibrdf {

// Text without NUL bytes, with at least one face line.
Status PrecheckObj(const std::string& path, const std::string& bytes);

// Magic number, a complete header, and element counts that fit into the bytes
// that follow it.
Status PrecheckPly(const std::string& path, const std::string& bytes);

}  // namespace ibrdf
