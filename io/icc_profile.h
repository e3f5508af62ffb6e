// What an ICC profile says of a file's curve.
#pragma once
#include <optional>
#include <string_view>

#include "ibrdf/io/photo.h"

namespace ibrdf {

// Reads description, colour space, tone curves (curv and para) and colorants of
// a profile of version 2 or 4 (ICC.1:2010). Curves within 1e-3 of sRGB's, in
// linear light, are sRGB's. Absent where the bytes are no profile. A profile
// without curves, as one of lookup tables, has kOther.
std::optional<IccProfile> ParseIccProfile(std::string_view bytes);

}  // namespace ibrdf
