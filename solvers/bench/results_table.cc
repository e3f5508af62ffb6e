#include "ibrdf/solvers/bench/results_table.h"

#include <fcntl.h>
#include <glog/logging.h>
#include <sys/file.h>
#include <unistd.h>

#include <algorithm>
#include <cerrno>
#include <cmath>
#include <cstring>
#include <filesystem>

#include "ibrdf/base/format.h"
#include "ibrdf/io/atomic_file.h"

namespace ibrdf {
namespace {

constexpr size_t kMaxBytes = size_t{1} << 28;

std::string Joined(const ResultsRow& cells) {
  std::string line;
  for (size_t i = 0; i < cells.size(); ++i) {
    CHECK_EQ(cells[i].find_first_of(",\"\r\n"), std::string::npos) << cells[i];
    line += (i == 0 ? "" : ",") + cells[i];
  }
  return line;
}
std::string Line(const ResultsRow& cells) { return Joined(cells) + "\n"; }

ResultsRow Cells(const std::string& line) {
  ResultsRow cells(1);
  for (const char c : line) {
    if (c == ',') {
      cells.emplace_back();
    } else {
      cells.back() += c;
    }
  }
  return cells;
}

Status WriteAll(int file, const std::string& path, const std::string& text) {
  size_t done = 0;
  while (done < text.size()) {
    const ssize_t n = ::write(file, text.data() + done, text.size() - done);
    if (n < 0 && errno == EINTR) continue;
    if (n <= 0) return InvalidInput(path, std::strerror(errno));
    done += static_cast<size_t>(n);
  }
  if (::fsync(file) != 0) return InvalidInput(path, std::strerror(errno));
  return OkStatus();
}

}  // namespace

std::string NumberCell(double value) {
  if (!std::isfinite(value)) return "";
  return Format("%.6g", value);
}

double Median(std::vector<double> values) {
  CHECK(!values.empty());
  std::sort(values.begin(), values.end());
  const size_t n = values.size();
  return 0.5 * (values[(n - 1) / 2] + values[n / 2]);
}

NamedRow::NamedRow(const std::vector<std::string>& columns)
    : columns_(&columns), cells_(columns.size()) {}

void NamedRow::Set(const std::string& column, const std::string& value) {
  const auto at = std::find(columns_->begin(), columns_->end(), column);
  CHECK(at != columns_->end()) << column;
  cells_[at - columns_->begin()] = value;
}

bool HoldsCase(const std::vector<ResultsRow>& rows, const ResultsRow& key,
               int num_key_columns) {
  return std::any_of(rows.begin(), rows.end(), [&](const ResultsRow& row) {
    return std::equal(key.begin(), key.begin() + num_key_columns, row.begin());
  });
}

StatusOr<std::vector<ResultsRow>> DecodeResults(
    const std::string& path, const std::string& text,
    const std::vector<std::string>& columns) {
  std::vector<ResultsRow> rows;
  size_t begin = 0;
  for (size_t end; (end = text.find('\n', begin)) != std::string::npos;
       begin = end + 1) {
    rows.push_back(Cells(text.substr(begin, end - begin)));
    if (rows.size() == 1 && rows[0] != columns) {
      return InvalidInput(path + ": line 1",
                          "expected the columns " + Joined(columns));
    }
    if (rows.back().size() != columns.size()) {
      return InvalidInput(path + ": line " + std::to_string(rows.size()),
                          "expected " + std::to_string(columns.size()) +
                              " cells, found " +
                              std::to_string(rows.back().size()));
    }
  }
  if (!rows.empty()) rows.erase(rows.begin());
  return rows;
}

StatusOr<std::vector<ResultsRow>> ReadResults(
    const std::string& path, const std::vector<std::string>& columns) {
  if (!std::filesystem::exists(path)) return std::vector<ResultsRow>();
  const StatusOr<std::string> text = ReadFile(path, kMaxBytes);
  if (!text.ok()) return text.status();
  return DecodeResults(path, *text, columns);
}

Status AppendResult(const std::string& path,
                    const std::vector<std::string>& columns,
                    const ResultsRow& row) {
  CHECK_EQ(row.size(), columns.size());
  const int file = ::open(path.c_str(), O_RDWR | O_CREAT | O_CLOEXEC, 0666);
  if (file < 0) return InvalidInput(path, std::strerror(errno));
  ::flock(file, LOCK_EX);
  off_t size = ::lseek(file, 0, SEEK_END);
  char last = '\n';
  while (size > 0 && ::pread(file, &last, 1, size - 1) == 1 && last != '\n') {
    --size;
  }
  Status status;
  if (::ftruncate(file, size) != 0) {
    status = InvalidInput(path, std::strerror(errno));
  } else {
    ::lseek(file, size, SEEK_SET);
    status = WriteAll(file, path, (size == 0 ? Line(columns) : "") + Line(row));
  }
  ::close(file);
  return status;
}

std::string ResultsMarkdown(const std::string& heading,
                            const std::vector<std::string>& columns,
                            const std::vector<ResultsRow>& rows) {
  const auto line = [](const ResultsRow& cells) {
    std::string text = "|";
    for (const std::string& cell : cells) text += " " + cell + " |";
    return text + "\n";
  };
  std::string text = heading + "\n" + line(columns) + "|";
  for (size_t i = 0; i < columns.size(); ++i) text += " --- |";
  text += "\n";
  for (const ResultsRow& row : rows) text += line(row);
  return text;
}

}  // namespace ibrdf
