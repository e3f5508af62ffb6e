// A ConfigNode as YAML.
#pragma once
#include <string>

#include "ibrdf/io/config_tree.h"

namespace ibrdf {

// A key per line, which ParseConfig reads back as the same tree but for its
// lines. Text that YAML could take for something else is quoted. `node`: a map,
// at the top of a file.
std::string ConfigText(const ConfigNode& node);

// The text as a scalar in double quotes; control characters are escaped.
std::string QuotedScalar(const std::string& text);

// Whether bytes are UTF-8, as YAML must be: anything else does not come back.
bool IsUtf8(const std::string& text);

}  // namespace ibrdf
