// The photographs of several views on one sheet.
#pragma once
#include <string>

#include "ibrdf/base/status.h"
#include "ibrdf/io/problem.h"
#include "ibrdf/solvers/problem/load_photograph.h"
#include "ibrdf/solvers/problem/view_sheet.h"

namespace ibrdf {

struct PhotographSheet {
  ViewSheet sheet;
  // All views, in their places. A mask is always there: nothing between the
  // views is of the object. Of views of which one is of codes, all have bounds.
  Photograph photograph;
};

// Reads the views of a problem that has several. Fails where they take more
// pixels together than one image may have, or where their codes, of a curve
// that is to be found, are of different depths.
StatusOr<PhotographSheet> LoadPhotographSheet(const Problem& problem);

// The labels of a problem whose list of views has them, in their places.
StatusOr<Image> LoadLabelSheet(const Problem& problem, const ViewSheet& sheet);

// Where the photographs come from, for messages: the file of one, or who lists
// several.
std::string PhotographsName(const Problem& problem);

}  // namespace ibrdf
