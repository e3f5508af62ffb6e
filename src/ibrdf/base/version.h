// Version of this release; CMakeLists.txt states the same, a test compares.
#pragma once

namespace ibrdf {

inline constexpr char kVersion[] = "0.1.0";

}  // namespace ibrdf
