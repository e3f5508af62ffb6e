// What tests ask of sentences and pages.
#pragma once
#include <string>

namespace ibrdf {

inline bool Contains(const std::string& text, const std::string& part) {
  return text.find(part) != std::string::npos;
}

}  // namespace ibrdf
