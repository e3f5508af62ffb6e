// results.csv: one row a case, appended as it finishes.
#pragma once
#include <string>
#include <vector>

#include "ibrdf/base/status.h"

namespace ibrdf {

using ResultsRow = std::vector<std::string>;  // a cell per column

// Columns of the joint sweep, in order; the first five name the case.
const std::vector<std::string>& JointColumns();
inline constexpr int kJointKeyColumns = 5;

// Rows of a table; none where the file does not exist. A last line without its
// end, cut by a kill, does not count. Fails on other columns; names the file.
StatusOr<std::vector<ResultsRow>> ReadResults(
    const std::string& path, const std::vector<std::string>& columns);

// Appends under a lock, in one write, and flushes to disk; makes the file with
// its header first, and takes off a line that a kill cut. Cells hold no comma,
// quote or line end.
Status AppendResult(const std::string& path,
                    const std::vector<std::string>& columns,
                    const ResultsRow& row);

// As a Markdown table below `heading` lines.
std::string ResultsMarkdown(const std::string& heading,
                            const std::vector<std::string>& columns,
                            const std::vector<ResultsRow>& rows);

}  // namespace ibrdf
