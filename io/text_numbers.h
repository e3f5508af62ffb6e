// Words and numbers of text files.
#pragma once
#include <charconv>
#include <string_view>
#include <system_error>
#include <vector>

namespace ibrdf {

// The text after UTF-8's byte order mark, where it begins with one.
inline std::string_view WithoutByteOrderMark(std::string_view text) {
  constexpr std::string_view kMark = "\xef\xbb\xbf";
  if (text.substr(0, kMark.size()) == kMark) text.remove_prefix(kMark.size());
  return text;
}

// Appends the words between blanks and tabs; they point into `line`.
inline void SplitWords(std::string_view line,
                       std::vector<std::string_view>* words) {
  for (size_t i = 0; i < line.size();) {
    const size_t start = line.find_first_not_of(" \t", i);
    if (start == std::string_view::npos) return;
    i = line.find_first_of(" \t", start);
    if (i == std::string_view::npos) i = line.size();
    words->push_back(line.substr(start, i - start));
  }
}

// Whether all of `text` is one number, of either sign.
template <typename Number>
bool ParseNumber(std::string_view text, Number* value) {
  if (!text.empty() && text.front() == '+') text.remove_prefix(1);
  const char* end = text.data() + text.size();
  const std::from_chars_result result =
      std::from_chars(text.data(), end, *value);
  return result.ec == std::errc() && result.ptr == end;
}

}  // namespace ibrdf
