// report.html: a result to look at, on one page without other files.
#pragma once
#include <nlohmann/json.hpp>
#include <string>
#include <vector>

#include "ibrdf/base/status.h"
#include "ibrdf/solvers/report/report_figures.h"

namespace ibrdf {

struct ReportInput {
  std::string name;               // of the problem, in any characters
  nlohmann::ordered_json result;  // as result.json
  nlohmann::ordered_json brdf;    // as brdf.json; null: none
  std::vector<ReportGroup> groups;
};

// A whole HTML page, well-formed XML too, without scripts or links to load.
// What the documents lack is left out, numbers that are null are shown as "-".
// Fails on a picture that no PNG can hold.
StatusOr<std::string> ReportPage(const ReportInput& input);

}  // namespace ibrdf
