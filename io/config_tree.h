// The part of YAML that problem files use, as a tree with line numbers.
#pragma once
#include <string>
#include <utility>
#include <vector>

#include "ibrdf/base/status.h"

namespace ibrdf {

struct ConfigNode {
  enum class Kind { kNull, kScalar, kList, kMap };
  Kind kind = Kind::kNull;
  std::string scalar;
  bool quoted = false;            // a string even if it reads as a number
  std::vector<ConfigNode> items;  // kList
  std::vector<std::pair<std::string, ConfigNode>> entries;  // kMap, in order
  int line = 0;  // from 1; 0 for overrides

  const ConfigNode* Find(const std::string& key) const;
};

// `where` (the file) begins every message, followed by the line. Refuses text
// over 1 MiB, nesting over 32 levels, duplicate keys, keys that are not plain
// words or longer than 200 bytes, anchors, aliases, tags, and more than one
// document.
StatusOr<ConfigNode> ParseConfig(const std::string& where,
                                 const std::string& text);

// "key.path=value": sets that key of the map `root`, making maps on the way;
// `value` is YAML. An empty or null value removes the key.
Status ApplyOverride(const std::string& override_text, ConfigNode* root);

}  // namespace ibrdf
