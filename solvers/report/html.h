// Text and pictures inside an HTML page.
#pragma once
#include <string>
#include <string_view>
#include <vector>

namespace ibrdf {

// `text` as character data or as the value of a quoted attribute: &, <, > and
// both quotes are escaped; what is not UTF-8, and control characters other
// than tab and line feed, become U+FFFD.
std::string EscapeHtml(std::string_view text);

// <name attributes>escaped text</name>; attributes are given as markup.
std::string HtmlElement(const std::string& name, std::string_view text,
                        const std::string& attributes = "");

// Cells are text, to be escaped; those that start like a number have the class
// "number". No header: no <thead>.
std::string HtmlTable(const std::vector<std::string>& header,
                      const std::vector<std::vector<std::string>>& rows);

// RFC 4648, section 4: with padding, without line breaks.
std::string Base64(std::string_view bytes);

// A URI that holds a whole PNG file: "data:image/png;base64,...".
std::string PngDataUri(std::string_view png_file);

}  // namespace ibrdf
