#include "ibrdf/io/problem_schema_rows.h"

#include <utility>

namespace ibrdf {
namespace problem_keys {
namespace {

constexpr char kTextureFiles[] = ".exr, .png";

}  // namespace

Row::Row(const std::string& path, const std::string& meaning) {
  key_.path = path;
  key_.meaning = meaning;
}

Row& Row::Number(const Range& range, const std::string& default_value) {
  key_.range = range;
  return Type(ValueType::kNumber, default_value);
}

Row& Row::AutoOrNumber(const Range& range) {
  key_.range = range;
  return Type(ValueType::kAutoOrNumber, "auto");
}

Row& Row::Integer(int64_t least, int64_t most,
                  const std::string& default_value) {
  key_.least = least;
  key_.most = most;
  return Type(ValueType::kInteger, default_value);
}

Row& Row::Triple(const Range& range, const std::string& default_value) {
  key_.range = range;
  return Type(ValueType::kTriple, default_value);
}

Row& Row::OneOrTriple(const Range& range, const std::string& default_value) {
  key_.range = range;
  return Type(ValueType::kOneOrTriple, default_value);
}

Row& Row::AutoOrTriple(const Range& range, const std::string& default_value) {
  key_.range = range;
  return Type(ValueType::kAutoOrTriple, default_value);
}

Row& Row::NumberList(const Range& range) {
  key_.range = range;
  return Type(ValueType::kNumberList, "");
}

Row& Row::PathList(const std::string& files) {
  key_.files = files;
  return Type(ValueType::kPathList, "");
}

Row& Row::Choice(const std::string& default_value, Words words) {
  key_.words = std::move(words);
  return Type(ValueType::kChoice, default_value);
}

Row& Row::ChoiceOrMap(const std::string& default_value, Words words) {
  key_.words = std::move(words);
  return Type(ValueType::kChoiceOrMap, default_value);
}

Row& Row::Pair(const Range& range) {
  key_.range = range;
  return Type(ValueType::kPair, "");
}

Row& Row::NumberOrPath(const Range& range, const std::string& default_value) {
  key_.range = range;
  key_.files = kTextureFiles;
  return Type(ValueType::kNumberOrPath, default_value);
}

Row& Row::TripleOrPath(const Range& range, const std::string& default_value) {
  key_.range = range;
  key_.files = kTextureFiles;
  return Type(ValueType::kTripleOrPath, default_value);
}

Row& Row::OneOrPair(const Range& range) {
  key_.range = range;
  return Type(ValueType::kOneOrPair, "");
}

Row& Row::Matrix() { return Type(ValueType::kMatrix, ""); }

Row& Row::WordOrList(const std::string& default_value, Words words,
                     Words listed) {
  key_.words = std::move(words);
  key_.list_words = std::move(listed);
  return Type(ValueType::kWordOrList, default_value);
}

Row& Row::Path(const std::string& files, const std::string& default_value,
               Words words) {
  key_.words = std::move(words);
  key_.files = files;
  return Type(ValueType::kPath, default_value);
}

Row& Row::Text() { return Type(ValueType::kText, ""); }

Row& Row::PathOrMap(const std::string& files) {
  key_.files = files;
  return Type(ValueType::kPathOrMap, "");
}

Row& Row::OptionalMap() { return Type(ValueType::kOptionalMap, ""); }

Row& Row::ListOrMap() { return Type(ValueType::kListOrMap, ""); }

Row& Row::Unit(const std::string& unit) {
  key_.unit = unit;
  return *this;
}

Row& Row::Without(const std::string& text) {
  key_.without = text;
  return *this;
}

Row& Row::UsedBy(unsigned uses) {
  key_.used_by = uses;
  return *this;
}

Row& Row::Needs(const std::string& what) {
  key_.needs = what;
  return *this;
}

Row& Row::Formerly(const std::string& name) {
  key_.old_name = name;
  return *this;
}

Row& Row::Notes(std::vector<std::string> notes) {
  key_.notes = std::move(notes);
  return *this;
}

Row& Row::Example(const std::string& value) {
  key_.example = value;
  return *this;
}

Row& Row::Type(ValueType type, const std::string& default_value) {
  key_.type = type;
  key_.default_value = default_value;
  return *this;
}

Keys Join(const std::vector<Keys>& parts) {
  Keys all;
  for (const Keys& part : parts)
    all.insert(all.end(), part.begin(), part.end());
  return all;
}

}  // namespace problem_keys
}  // namespace ibrdf
