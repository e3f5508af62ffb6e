// printf to a string.
#pragma once
#include <string>

namespace ibrdf {

// A text of any length; "" where the format is not one.
[[gnu::format(printf, 1, 2)]] std::string Format(const char* format, ...);

}  // namespace ibrdf
