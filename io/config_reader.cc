#include "ibrdf/io/config_reader.h"

#include <algorithm>
#include <cmath>
#include <cstdlib>
#include <filesystem>
#include <locale>
#include <sstream>

namespace ibrdf {
namespace {
using Kind = ConfigNode::Kind;

// Longest value that a message repeats.
constexpr size_t kMaxShown = 60;

bool ParseNumber(const ConfigNode& node, double* out) {
  if (node.kind != Kind::kScalar || node.quoted) return false;
  std::istringstream stream(node.scalar);
  stream.imbue(std::locale::classic());
  double value = 0.0;
  stream >> value;
  if (stream.fail() ||
      stream.peek() != std::istringstream::traits_type::eof()) {
    return false;
  }
  *out = value;
  return std::isfinite(value);
}

std::string Text(double value) {
  std::ostringstream stream;
  stream.imbue(std::locale::classic());
  stream << value;
  return stream.str();
}

bool IsBounded(const Range& r) {
  return std::isfinite(r.low) && std::isfinite(r.high);
}

std::string RangeText(const Range& r) {
  const std::string interval = IntervalText(r);
  if (interval.empty()) return "a number";
  return std::string("a number ") + (IsBounded(r) ? "in " : "") + interval;
}

bool Inside(double v, const Range& r) {
  return (r.low_included ? v >= r.low : v > r.low) &&
         (r.high_included ? v <= r.high : v < r.high);
}

int EditDistance(const std::string& a, const std::string& b) {
  const size_t n = b.size() + 1;
  std::vector<int> cost((a.size() + 1) * n);
  for (size_t i = 0; i <= a.size(); ++i) {
    for (size_t j = 0; j <= b.size(); ++j) {
      int best =
          i == 0 ? static_cast<int>(j)
          : j == 0
              ? static_cast<int>(i)
              : std::min({cost[(i - 1) * n + j] + 1, cost[i * n + j - 1] + 1,
                          cost[(i - 1) * n + j - 1] + (a[i - 1] != b[j - 1])});
      if (i > 1 && j > 1 && a[i - 1] == b[j - 2] && a[i - 2] == b[j - 1]) {
        best = std::min(best, cost[(i - 2) * n + j - 2] + 1);
      }
      cost[i * n + j] = best;
    }
  }
  return cost.back();
}

}  // namespace

void ConfigContext::Fail(const std::string& key, const std::string& what) {
  if (error.ok()) {
    error = InvalidInput(key.empty() ? file : file + ": " + key, what);
  }
}

std::string NearestWord(const std::string& word,
                        const std::vector<std::string>& known) {
  const std::string head = word.substr(0, kMaxShown);
  std::vector<int> distances;
  for (const std::string& other : known) {
    distances.push_back(EditDistance(head, other));
  }
  return known[std::min_element(distances.begin(), distances.end()) -
               distances.begin()];
}

std::string Describe(const ConfigNode& node) {
  switch (node.kind) {
    case Kind::kNull:
      return "nothing";
    case Kind::kList:
      return "a list of " + std::to_string(node.items.size());
    case Kind::kMap:
      return "a map";
    case Kind::kScalar:
      break;
  }
  const bool cut = node.scalar.size() > kMaxShown;
  return "'" + node.scalar.substr(0, kMaxShown) + (cut ? "...'" : "'") +
         (node.quoted ? " in quotes, which is text" : "");
}

std::string JoinWords(const std::vector<std::string>& words) {
  std::string text;
  for (size_t i = 0; i < words.size(); ++i) {
    if (i > 0) text += i + 1 == words.size() ? " or " : ", ";
    text += words[i];
  }
  return text;
}

std::string IntervalText(const Range& r) {
  if (IsBounded(r)) {
    return (r.low_included ? "[" : "(") + Text(r.low) + ", " + Text(r.high) +
           (r.high_included ? "]" : ")");
  }
  if (std::isfinite(r.low)) {
    return (r.low_included ? ">= " : "> ") + Text(r.low);
  }
  if (std::isfinite(r.high)) {
    return (r.high_included ? "<= " : "< ") + Text(r.high);
  }
  return "";
}

ConfigReader::ConfigReader(ConfigContext* context, const ConfigNode* node,
                           const std::string& path,
                           const std::vector<std::string>& known)
    : context_(context), node_(nullptr), path_(path) {
  if (node == nullptr || node->kind == Kind::kNull) return;
  if (node->kind != Kind::kMap) {
    context_->Fail(path, "expected a map of " + JoinWords(known) + ", found " +
                             Describe(*node));
    return;
  }
  node_ = node;
  for (const auto& [key, value] : node->entries) {
    if (std::find(known.begin(), known.end(), key) != known.end()) continue;
    if (!context_->error.ok()) return;  // the first one is told
    context_->Fail(PathOf(key.substr(0, kMaxShown)),
                   "unknown key; the nearest known one is " +
                       PathOf(NearestWord(key, known)));
  }
}

const ConfigNode* ConfigReader::Find(const std::string& key) const {
  return node_ == nullptr ? nullptr : node_->Find(key);
}

std::string ConfigReader::PathOf(const std::string& key) const {
  return path_.empty() ? key : path_ + "." + key;
}

bool ConfigReader::IsWord(const std::string& key,
                          const std::string& word) const {
  const ConfigNode* node = Find(key);
  return node != nullptr && node->kind == Kind::kScalar && node->scalar == word;
}

bool ConfigReader::IsPath(const std::string& key) const {
  const ConfigNode* node = Find(key);
  double number = 0.0;
  return node != nullptr && node->kind == Kind::kScalar &&
         !node->scalar.empty() && !ParseNumber(*node, &number);
}

void ConfigReader::Fail(const std::string& key, const std::string& what) {
  context_->Fail(PathOf(key), what);
}

void ConfigReader::FailExpected(const std::string& key,
                                const std::string& expected) {
  const ConfigNode* node = Find(key);
  Fail(key, "expected " + expected + ", found " +
                (node == nullptr ? "nothing" : Describe(*node)));
}

void ConfigReader::Number(const std::string& key, const Range& range,
                          double* out) {
  const ConfigNode* node = Find(key);
  if (node == nullptr) return;
  double value = 0.0;
  if (!ParseNumber(*node, &value) || !Inside(value, range)) {
    FailExpected(key, RangeText(range));
    return;
  }
  *out = value;
}

void ConfigReader::Integer(const std::string& key, int64_t low, int64_t high,
                           int64_t* out) {
  const ConfigNode* node = Find(key);
  if (node == nullptr) return;
  int64_t value = 0;
  bool ok = node->kind == Kind::kScalar && !node->quoted;
  if (ok) {
    std::istringstream stream(node->scalar);
    stream.imbue(std::locale::classic());
    stream >> value;
    ok = !stream.fail() &&
         stream.peek() == std::istringstream::traits_type::eof() &&
         value >= low && value <= high;
  }
  if (!ok) {
    FailExpected(key, "a whole number in [" + std::to_string(low) + ", " +
                          std::to_string(high) + "]");
    return;
  }
  *out = value;
}

void ConfigReader::Integer(const std::string& key, int low, int high,
                           int* out) {
  int64_t value = *out;
  Integer(key, int64_t{low}, int64_t{high}, &value);
  *out = static_cast<int>(value);
}

void ConfigReader::Choice(const std::string& key,
                          const std::vector<std::string>& words, int* out) {
  const ConfigNode* node = Find(key);
  if (node == nullptr) return;
  if (node->kind == Kind::kScalar) {
    const auto word = std::find(words.begin(), words.end(), node->scalar);
    if (word != words.end()) {
      *out = static_cast<int>(word - words.begin());
      return;
    }
  }
  FailExpected(key, JoinWords(words));
}

const std::string* ConfigReader::FindText(const std::string& key,
                                          const std::string& expected) {
  const ConfigNode* node = Find(key);
  if (node == nullptr) return nullptr;
  if (node->kind == Kind::kScalar && !node->scalar.empty()) {
    return &node->scalar;
  }
  FailExpected(key, expected);
  return nullptr;
}

void ConfigReader::Text(const std::string& key, std::string* out) {
  const std::string* text = FindText(key, "text");
  if (text != nullptr) *out = *text;
}

std::string ConfigReader::Resolved(const std::string& name) const {
  const std::filesystem::path path(name);
  if (path.is_absolute() || context_->folder.empty()) return path.string();
  return (std::filesystem::path(context_->folder) / path)
      .lexically_normal()
      .string();
}

void ConfigReader::Path(const std::string& key, std::string* out) {
  const std::string* name = FindText(key, "the name of a file");
  if (name != nullptr) *out = Resolved(*name);
}

void ConfigReader::PathList(const std::string& key,
                            std::vector<std::string>* out) {
  const ConfigNode* node = Find(key);
  if (node == nullptr) return;
  std::vector<std::string> paths;
  bool ok = node->kind == Kind::kList && !node->items.empty();
  for (size_t i = 0; ok && i < node->items.size(); ++i) {
    ok = node->items[i].kind == Kind::kScalar && !node->items[i].scalar.empty();
    if (ok) paths.push_back(Resolved(node->items[i].scalar));
  }
  if (!ok) {
    FailExpected(key, "a list of files' names");
    return;
  }
  *out = std::move(paths);
}

void ConfigReader::NumberList(const std::string& key, const Range& range,
                              std::vector<double>* out) {
  const ConfigNode* node = Find(key);
  if (node == nullptr) return;
  std::vector<double> values;
  bool ok = node->kind == Kind::kList && !node->items.empty();
  for (size_t i = 0; ok && i < node->items.size(); ++i) {
    values.push_back(0.0);
    ok = ParseNumber(node->items[i], &values.back()) &&
         Inside(values.back(), range);
  }
  if (!ok) {
    FailExpected(key, "a list, each " + RangeText(range));
    return;
  }
  *out = std::move(values);
}

void ConfigReader::Pair(const std::string& key, const Range& range,
                        bool one_for_all, Eigen::Vector2d* out) {
  const ConfigNode* node = Find(key);
  if (node == nullptr) return;
  double value = 0.0;
  if (one_for_all && ParseNumber(*node, &value) && Inside(value, range)) {
    out->setConstant(value);
    return;
  }
  Eigen::Vector2d values;
  bool ok = node->kind == Kind::kList && node->items.size() == 2;
  for (int c = 0; ok && c < 2; ++c) {
    ok = ParseNumber(node->items[c], &values[c]) && Inside(values[c], range);
  }
  if (!ok) {
    const std::string number = RangeText(range);
    FailExpected(key, one_for_all ? number + " or a list of two"
                                  : "a list of two, each " + number);
    return;
  }
  *out = values;
}

void ConfigReader::Matrix(const std::string& key, Eigen::Matrix4d* out) {
  const ConfigNode* node = Find(key);
  if (node == nullptr) return;
  Eigen::Matrix4d values;
  bool ok = node->kind == Kind::kList && node->items.size() == 4;
  for (int i = 0; ok && i < 4; ++i) {
    const ConfigNode& row = node->items[i];
    ok = row.kind == Kind::kList && row.items.size() == 4;
    for (int j = 0; ok && j < 4; ++j) {
      ok = ParseNumber(row.items[j], &values(i, j));
    }
  }
  if (!ok) {
    FailExpected(key, "four lists of four numbers, the rows of a matrix");
    return;
  }
  *out = values;
}

void ConfigReader::Triple(const std::string& key, const Range& range,
                          bool one_for_all, Eigen::Vector3d* out) {
  const ConfigNode* node = Find(key);
  if (node == nullptr) return;
  double value = 0.0;
  if (one_for_all && ParseNumber(*node, &value) && Inside(value, range)) {
    out->setConstant(value);
    return;
  }
  Eigen::Vector3d values;
  bool ok = node->kind == Kind::kList && node->items.size() == 3;
  for (int c = 0; ok && c < 3; ++c) {
    ok = ParseNumber(node->items[c], &values[c]) && Inside(values[c], range);
  }
  if (!ok) {
    const std::string number = RangeText(range);
    FailExpected(key, (one_for_all ? number + " or a list of three"
                                   : "a list of three, each " + number));
    return;
  }
  *out = values;
}

}  // namespace ibrdf
