#include "ibrdf/solvers/report/html.h"

#include <cstdint>

namespace ibrdf {
namespace {

constexpr char kReplacement[] = "\xEF\xBF\xBD";  // U+FFFD

uint8_t ByteAt(std::string_view text, size_t i) {
  return static_cast<uint8_t>(text[i]);
}

// Length of the UTF-8 sequence (RFC 3629) at `i`, 0 where there is none.
size_t SequenceLength(std::string_view text, size_t i) {
  const uint8_t first = ByteAt(text, i);
  if (first < 0x80) return 1;
  const size_t length = first >= 0xC2 && first <= 0xDF   ? 2
                        : first >= 0xE0 && first <= 0xEF ? 3
                        : first >= 0xF0 && first <= 0xF4 ? 4
                                                         : 0;
  if (length == 0 || length > text.size() - i) return 0;
  for (size_t k = 1; k < length; ++k) {
    if ((ByteAt(text, i + k) & 0xC0) != 0x80) return 0;
  }
  // Overlong forms, surrogates and what lies beyond U+10FFFF.
  const uint8_t second = ByteAt(text, i + 1);
  const bool refused =
      (first == 0xE0 && second < 0xA0) || (first == 0xED && second > 0x9F) ||
      (first == 0xF0 && second < 0x90) || (first == 0xF4 && second > 0x8F);
  return refused ? 0 : length;
}

bool IsNumber(const std::string& cell) {
  const std::string_view kSigns = "+-";
  const size_t digit =
      !cell.empty() && kSigns.find(cell[0]) != std::string_view::npos ? 1 : 0;
  return digit < cell.size() && cell[digit] >= '0' && cell[digit] <= '9';
}

std::string TableRow(const std::vector<std::string>& cells, const char* name) {
  std::string out = "<tr>";
  for (const std::string& cell : cells) {
    out += HtmlElement(name, cell, IsNumber(cell) ? "class=\"number\"" : "");
  }
  return out + "</tr>\n";
}

}  // namespace

std::string HtmlElement(const std::string& name, std::string_view text,
                        const std::string& attributes) {
  return "<" + name + (attributes.empty() ? "" : " " + attributes) + ">" +
         EscapeHtml(text) + "</" + name + ">";
}

std::string HtmlTable(const std::vector<std::string>& header,
                      const std::vector<std::vector<std::string>>& rows) {
  std::string out = "<table>\n";
  if (!header.empty()) {
    out += "<thead>" + TableRow(header, "th") + "</thead>\n";
  }
  out += "<tbody>\n";
  for (const std::vector<std::string>& row : rows) out += TableRow(row, "td");
  return out + "</tbody>\n</table>\n";
}

std::string EscapeHtml(std::string_view text) {
  std::string out;
  for (size_t i = 0; i < text.size();) {
    const size_t length = SequenceLength(text, i);
    const char c = text[i];
    if (length == 0) {
      out += kReplacement;
    } else if (length > 1) {
      out += text.substr(i, length);
    } else if (c == '&') {
      out += "&amp;";
    } else if (c == '<') {
      out += "&lt;";
    } else if (c == '>') {
      out += "&gt;";
    } else if (c == '"') {
      out += "&quot;";
    } else if (c == '\'') {
      out += "&#39;";
    } else if ((ByteAt(text, i) < 0x20 && c != '\t' && c != '\n') ||
               c == 0x7F) {
      out += kReplacement;
    } else {
      out += c;
    }
    i += length == 0 ? 1 : length;
  }
  return out;
}

std::string Base64(std::string_view bytes) {
  constexpr char kDigits[] =
      "ABCDEFGHIJKLMNOPQRSTUVWXYZabcdefghijklmnopqrstuvwxyz0123456789+/";
  std::string out;
  out.reserve((bytes.size() + 2) / 3 * 4);
  for (size_t i = 0; i < bytes.size(); i += 3) {
    const size_t count = bytes.size() - i < 3 ? bytes.size() - i : 3;
    uint32_t group = 0;
    for (size_t k = 0; k < 3; ++k) {
      group = group << 8 | (k < count ? ByteAt(bytes, i + k) : 0u);
    }
    for (size_t k = 0; k < 4; ++k) {
      out += k <= count ? kDigits[group >> (18 - 6 * k) & 63] : '=';
    }
  }
  return out;
}

std::string PngDataUri(std::string_view png_file) {
  return "data:image/png;base64," + Base64(png_file);
}

}  // namespace ibrdf
