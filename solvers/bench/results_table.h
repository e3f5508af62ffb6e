// results.csv: one row a case, appended as it finishes.
#pragma once
#include <string>
#include <vector>

#include "ibrdf/base/status.h"

namespace ibrdf {

using ResultsRow = std::vector<std::string>;  // a cell per column

// Six digits; empty where the value is not finite.
std::string NumberCell(double value);

// The median of at least one value.
double Median(std::vector<double> values);

// A row that is filled by column name; empty cells at first.
class NamedRow {
 public:
  // columns: not copied, must outlive *this.
  explicit NamedRow(const std::vector<std::string>& columns);

  // `column` is one of the columns.
  void Set(const std::string& column, const std::string& value);
  const ResultsRow& cells() const { return cells_; }

 private:
  const std::vector<std::string>* columns_;
  ResultsRow cells_;
};

// Whether a row starts with the first num_key_columns cells of `key`: the
// columns that name a case come first.
bool HoldsCase(const std::vector<ResultsRow>& rows, const ResultsRow& key,
               int num_key_columns);

// Rows of a table, the text of the file `path`. A last line without its end,
// cut by a kill, does not count. Fails on other columns; names the file.
StatusOr<std::vector<ResultsRow>> DecodeResults(
    const std::string& path, const std::string& text,
    const std::vector<std::string>& columns);

// None where the file does not exist.
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
