// Version of this release; CMakeLists.txt states the same, a test compares.
#pragma once

namespace ibrdf {

inline constexpr char kVersion[] = "0.2.0";

}  // namespace ibrdf
