#include "ibrdf/solvers/bench/merl_fit_summary.h"

#include <glog/logging.h>

#include <algorithm>
#include <cstdlib>
#include <map>
#include <set>
#include <utility>

#include "ibrdf/base/format.h"
#include "ibrdf/solvers/bench/merl_fit_sweep.h"

namespace ibrdf {
namespace {

const std::set<std::string>& HardMaterials() {
  static const std::set<std::string> names = {"black-obsidian", "chrome-steel",
                                              "red-metallic-paint", "ss440"};
  return names;
}

std::string Cell(const ResultsRow& row, const std::string& column) {
  const std::vector<std::string>& columns = MerlFitColumns();
  const auto at = std::find(columns.begin(), columns.end(), column);
  CHECK(at != columns.end()) << column;
  return row[at - columns.begin()];
}

// The rows of one method, in the order of the file.
struct Group {
  std::string label;
  std::vector<const ResultsRow*> rows;
};

std::vector<Group> GroupRows(const std::vector<ResultsRow>& rows) {
  std::set<std::string> seeds;
  for (const ResultsRow& row : rows) seeds.insert(Cell(row, "seed"));
  std::vector<Group> groups;
  for (const ResultsRow& row : rows) {
    if (Cell(row, "status") != "ok") continue;
    std::string label = Cell(row, "method");
    const std::string lobes = Cell(row, "lobes"), model = Cell(row, "model");
    if (!lobes.empty()) label += ", lobes " + lobes;
    if (!model.empty()) label += ", " + model;
    if (seeds.size() > 1) label += ", seed " + Cell(row, "seed");
    auto at = std::find_if(groups.begin(), groups.end(),
                           [&](const Group& g) { return g.label == label; });
    if (at == groups.end()) at = groups.insert(at, {label, {}});
    at->rows.push_back(&row);
  }
  return groups;
}

// Values of a column in the rows that have a `score`.
std::vector<double> Values(const Group& group, const std::string& column,
                           const std::string& score, bool with_hard) {
  std::vector<double> values;
  for (const ResultsRow* row : group.rows) {
    if (!with_hard && HardMaterials().count(Cell(*row, "material")) > 0) {
      continue;
    }
    const std::string cell = Cell(*row, column);
    if (!cell.empty() && !Cell(*row, score).empty())
      values.push_back(std::strtod(cell.c_str(), nullptr));
  }
  return values;
}

double Mean(const std::vector<double>& values) {
  double sum = 0.0;
  for (const double v : values) sum += v;
  return sum / static_cast<double>(values.size());
}

// One table of scores: of `prefix`, over all or all but the hard materials.
std::string ScoreTable(const std::vector<Group>& groups,
                       const std::string& prefix, bool with_hard) {
  std::vector<ResultsRow> lines;
  for (const Group& group : groups) {
    ResultsRow line = {group.label};
    for (const char* suffix : {"_rmse", "_rmse_aligned", "_rmse_below80"}) {
      const std::vector<double> values =
          Values(group, prefix + suffix, prefix + "_rmse", with_hard);
      if (line.size() == 1) line.push_back(std::to_string(values.size()));
      if (values.empty()) {
        line.insert(line.end(), 3, "");
        continue;
      }
      line.push_back(Format("%.4g", Mean(values)));
      line.push_back(Format("%.4g", Median(values)));
      line.push_back(
          NumberCell(*std::max_element(values.begin(), values.end())));
    }
    const std::vector<double> seconds =
        Values(group, "seconds", prefix + "_rmse", with_hard);
    line.push_back(seconds.empty() ? "" : Format("%.4g", Mean(seconds)));
    if (line[1] != "0") lines.push_back(line);
  }
  if (lines.empty()) return "";
  const std::string heading =
      "## `" + prefix + "_rmse`, " +
      (with_hard ? "all materials" : "without the four on a floor") + "\n";
  return ResultsMarkdown(
             heading,
             {"method", "materials", "mean", "median", "max", "aligned mean",
              "aligned median", "aligned max", "below80 mean", "below80 median",
              "below80 max", "mean seconds"},
             lines) +
         "\n";
}

// Line a, column b: on how many materials a is below b.
std::string WinTable(const std::vector<Group>& groups) {
  std::vector<std::map<std::string, double>> scores(groups.size());
  for (size_t g = 0; g < groups.size(); ++g) {
    for (const ResultsRow* row : groups[g].rows) {
      const std::string cell = Cell(*row, "brdf_log_rmse");
      if (cell.empty()) continue;
      scores[g][Cell(*row, "material")] = std::strtod(cell.c_str(), nullptr);
    }
  }
  std::vector<std::string> columns = {"below"};
  std::vector<ResultsRow> lines;
  for (size_t a = 0; a < groups.size(); ++a) {
    columns.push_back(groups[a].label);
    ResultsRow line = {groups[a].label};
    for (size_t b = 0; b < groups.size(); ++b) {
      int wins = 0, both = 0;
      for (const auto& [material, score] : scores[a]) {
        const auto other = scores[b].find(material);
        if (other == scores[b].end()) continue;
        ++both;
        wins += score < other->second ? 1 : 0;
      }
      line.push_back(
          a == b ? "" : std::to_string(wins) + " of " + std::to_string(both));
    }
    lines.push_back(line);
  }
  return ResultsMarkdown(
      "## On how many materials the line's `brdf_log_rmse` is below the "
      "column's\n",
      columns, lines);
}

}  // namespace

std::string SummarizeMerlFits(const std::vector<ResultsRow>& rows) {
  const std::vector<Group> groups = GroupRows(rows);
  std::string text;
  for (const char* prefix : {"brdf_log", "score_data_log"}) {
    text += ScoreTable(groups, prefix, /*with_hard=*/true);
    text += ScoreTable(groups, prefix, /*with_hard=*/false);
  }
  return text + WinTable(groups);
}

}  // namespace ibrdf
