// Extension of a path, by which formats are chosen.
#pragma once
#include <string>

namespace ibrdf {

// What follows the last dot of the last component, in lower case, without the
// dot; empty where there is none.
inline std::string FileExtension(const std::string& path) {
  const size_t slash = path.find_last_of('/');
  const size_t dot = path.find_last_of('.');
  if (dot == std::string::npos || (slash != std::string::npos && dot < slash)) {
    return "";
  }
  std::string extension = path.substr(dot + 1);
  for (char& c : extension) {
    if (c >= 'A' && c <= 'Z') c = static_cast<char>(c - 'A' + 'a');
  }
  return extension;
}

}  // namespace ibrdf
