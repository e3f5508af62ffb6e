#include "ibrdf/base/format.h"

#include <cstdarg>
#include <cstdio>

namespace ibrdf {

std::string Format(const char* format, ...) {
  va_list arguments, again;
  va_start(arguments, format);
  va_copy(again, arguments);
  const int length = std::vsnprintf(nullptr, 0, format, arguments);
  va_end(arguments);
  std::string text;
  if (length > 0) {
    // One more for the terminator, which is not part of a string.
    text.resize(length + 1);
    std::vsnprintf(text.data(), text.size(), format, again);
    text.resize(length);
  }
  va_end(again);
  return text;
}

}  // namespace ibrdf
