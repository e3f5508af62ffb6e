// The parsers of images: photographs, masks, maps, normals, depth, and the
// blocks inside of them.
#pragma once
#include <vector>

#include "tests/fuzz/parser_checks.h"

namespace ibrdf {

std::vector<FuzzedParser> ImageParsers();

}  // namespace ibrdf
