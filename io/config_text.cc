#include "ibrdf/io/config_text.h"

#include <algorithm>
#include <cctype>
#include <cstdint>
#include <cstdio>

namespace ibrdf {
namespace {
using Kind = ConfigNode::Kind;

// Words and numbers that are the same with quotes and without.
bool IsPlain(const std::string& text) {
  const auto safe = [](unsigned char c) {
    return std::isalnum(c) != 0 || c == '_' || c == '.' || c == '/' ||
           c == '+' || c == '-';
  };
  return !text.empty() && std::isalnum(static_cast<unsigned char>(text[0])) &&
         std::all_of(text.begin(), text.end(), safe) && text != "null" &&
         text != "Null" && text != "NULL";
}

// On the line of its key.
std::string InLine(const ConfigNode& node) {
  std::string text;
  switch (node.kind) {
    case Kind::kNull:
      return "null";
    case Kind::kScalar: {
      // A number may begin with a sign or a point, which a word may not.
      const std::string& s = node.scalar;
      const bool sign = s.size() > 1 && (s[0] == '-' || s[0] == '.') &&
                        std::isdigit(static_cast<unsigned char>(s[1])) != 0;
      const bool plain = IsPlain(sign ? s.substr(1) : s);
      return plain && !node.quoted ? s : QuotedScalar(s);
    }
    case Kind::kList:
      for (const ConfigNode& item : node.items) {
        text += (text.empty() ? "" : ", ") + InLine(item);
      }
      return "[" + text + "]";
    case Kind::kMap:
      for (const auto& [key, value] : node.entries) {
        text += (text.empty() ? "" : ", ") +
                (IsPlain(key) ? key : QuotedScalar(key)) + ": " + InLine(value);
      }
      return "{" + text + "}";
  }
  return text;
}

void AppendMap(const ConfigNode& map, const std::string& indent,
               std::string* text) {
  for (const auto& [key, value] : map.entries) {
    *text += indent + (IsPlain(key) ? key : QuotedScalar(key)) + ":";
    if (value.kind == Kind::kMap && !value.entries.empty()) {
      *text += "\n";
      AppendMap(value, indent + "  ", text);
    } else {
      *text += " " + InLine(value) + "\n";
    }
  }
}

}  // namespace

std::string ConfigText(const ConfigNode& node) {
  if (node.entries.empty()) return "{}\n";
  std::string text;
  AppendMap(node, "", &text);
  return text;
}

std::string QuotedScalar(const std::string& text) {
  std::string quoted = "\"";
  for (const char c : text) {
    const auto byte = static_cast<unsigned char>(c);
    if (c == '"' || c == '\\') {
      quoted += '\\';
      quoted += c;
    } else if (byte < 0x20 || byte == 0x7f) {
      char escape[8];
      std::snprintf(escape, sizeof(escape), "\\x%02x", byte);
      quoted += escape;
    } else {
      quoted += c;
    }
  }
  return quoted + "\"";
}

bool IsUtf8(const std::string& text) {
  for (size_t i = 0; i < text.size();) {
    const auto first = static_cast<unsigned char>(text[i]);
    const int more = first < 0x80    ? 0
                     : first < 0xc2  ? -1
                     : first < 0xe0  ? 1
                     : first < 0xf0  ? 2
                     : first <= 0xf4 ? 3
                                     : -1;
    if (more < 0 || i + static_cast<size_t>(more) >= text.size()) return false;
    uint32_t code = more == 0 ? first : first & (0x3fu >> more);
    for (int k = 1; k <= more; ++k) {
      const auto next = static_cast<unsigned char>(text[i + k]);
      if ((next & 0xc0) != 0x80) return false;
      code = code << 6 | (next & 0x3f);
    }
    // Overlong forms, halves of surrogate pairs, beyond the last character.
    if ((more == 2 && code < 0x800) || (more == 3 && code < 0x10000) ||
        (code >= 0xd800 && code < 0xe000) || code > 0x10ffff) {
      return false;
    }
    i += static_cast<size_t>(more) + 1;
  }
  return true;
}

}  // namespace ibrdf
