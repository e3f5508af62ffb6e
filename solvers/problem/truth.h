// What an estimate is compared with, where a problem gives it.
#pragma once
#include <string>
#include <vector>

#include "ibrdf/base/status.h"
#include "ibrdf/brdf/merl_table.h"
#include "ibrdf/image/image.h"
#include "ibrdf/io/problem.h"

namespace ibrdf {

// Empty: not given. The solver never sees it.
struct Truth {
  MerlTable brdf;
  Image illumination;  // in the library's frame, at the size of the estimate
  std::vector<std::string> warnings;  // of the files: sentences for the user
};

// Reads the files and refuses what no metric can be taken against (a table
// without a positive value, a map without a range): call it before a solve, so
// that hours of work do not end in such an error.
StatusOr<Truth> LoadTruth(const TruthSpec& truth, int map_width,
                          int map_height);

}  // namespace ibrdf
