// A strict reader of the markup that reports are written in.
#pragma once
#include <cctype>
#include <set>
#include <string>
#include <vector>

namespace ibrdf {

// Empty if `page` is well-formed: every element is closed in order (void ones
// as "<br />"), attributes are quoted and unique, entities are known, text
// holds no bare < or &. Otherwise what is wrong, and where.
inline std::string MarkupError(const std::string& page) {
  std::vector<std::string> open;
  size_t i = 0;
  const auto error = [&](const std::string& what) {
    return what + " at byte " + std::to_string(i) + ": " + page.substr(i, 40);
  };
  const auto entity_ends = [&]() -> size_t {
    for (const char* known : {"&amp;", "&lt;", "&gt;", "&quot;", "&#39;"}) {
      const std::string entity = known;
      if (page.compare(i, entity.size(), entity) == 0) return entity.size();
    }
    return 0;
  };
  const auto name = [&] {
    std::string out;
    while (i < page.size() &&
           (std::isalnum(static_cast<unsigned char>(page[i])) ||
            page[i] == '-' || page[i] == ':')) {
      out += page[i++];
    }
    return out;
  };
  const auto skip_space = [&] {
    while (i < page.size() &&
           std::isspace(static_cast<unsigned char>(page[i]))) {
      ++i;
    }
  };
  const std::string doctype = "<!DOCTYPE html>";
  if (page.compare(0, doctype.size(), doctype) == 0) i = doctype.size();
  while (i < page.size()) {
    if (page[i] == '&') {
      if (entity_ends() == 0) return error("unknown entity");
      i += entity_ends();
      continue;
    }
    if (page[i] == '>') return error("bare >");
    if (page[i] != '<') {
      ++i;
      continue;
    }
    ++i;
    if (i < page.size() && page[i] == '/') {
      ++i;
      const std::string closed = name();
      if (open.empty() || open.back() != closed) {
        return error("</" + closed + "> closes " +
                     (open.empty() ? "nothing" : "<" + open.back() + ">"));
      }
      open.pop_back();
      if (i >= page.size() || page[i] != '>') return error("expected >");
      ++i;
      continue;
    }
    const std::string element = name();
    if (element.empty()) return error("expected an element");
    std::set<std::string> attributes;
    while (true) {
      skip_space();
      if (i >= page.size()) return error("unclosed tag");
      if (page[i] == '>') {
        open.push_back(element);
        ++i;
        break;
      }
      if (page.compare(i, 2, "/>") == 0) {
        i += 2;
        break;
      }
      const std::string attribute = name();
      if (attribute.empty() || page.compare(i, 2, "=\"") != 0) {
        return error("expected an attribute");
      }
      if (!attributes.insert(attribute).second) return error("twice");
      i += 2;
      while (i < page.size() && page[i] != '"') {
        if (page[i] == '<') return error("bare < in an attribute");
        if (page[i] == '&' && entity_ends() == 0) return error("bare &");
        ++i;
      }
      if (i >= page.size()) return error("unclosed attribute");
      ++i;
    }
  }
  return open.empty() ? "" : "<" + open.back() + "> is not closed";
}

}  // namespace ibrdf
