#include "ibrdf/io/problem_reader.h"

#include <glog/logging.h>

#include <limits>

namespace ibrdf {

ProblemReader::ProblemReader(const ProblemSchema* schema,
                             const std::string& map, const ConfigNode* node,
                             ConfigContext* context)
    : ProblemReader(schema, map, map, node, context) {}

ProblemReader::ProblemReader(const ProblemSchema* schema,
                             const std::string& map, const std::string& shown,
                             const ConfigNode* node, ConfigContext* context)
    : schema_(schema),
      map_(map),
      shown_(shown),
      context_(context),
      reader_(context, node, shown, schema->NamesBelow(map)) {}

ProblemReader ProblemReader::Below(const std::string& name) const {
  return {schema_, JoinPath(map_, name), JoinPath(shown_, name), Find(name),
          context_};
}

ProblemReader ProblemReader::Like(const std::string& map,
                                  const std::string& shown,
                                  const ConfigNode* node) const {
  return {schema_, map, shown, node, context_};
}

ConfigReader ProblemReader::Other(const std::string& shown,
                                  const ConfigNode& node,
                                  const std::vector<std::string>& known) const {
  return {context_, &node, shown, known};
}

const ConfigNode* ProblemReader::Find(const std::string& name) const {
  return reader_.Find(name);
}

const ProblemKey& ProblemReader::Key(const std::string& name) const {
  return schema_->Key(JoinPath(map_, name));
}

const ProblemKey& ProblemReader::Typed(const std::string& name,
                                       ValueType type) const {
  const ProblemKey& key = Key(name);
  CHECK(key.type == type) << key.path;
  return key;
}

void ProblemReader::Read(const std::string& name, double* out) {
  reader_.Number(name, Typed(name, ValueType::kNumber).range, out);
}

void ProblemReader::Read(const std::string& name, int* out) {
  const ProblemKey& key = Typed(name, ValueType::kInteger);
  reader_.Integer(name, static_cast<int>(key.least), static_cast<int>(key.most),
                  out);
}

void ProblemReader::Read(const std::string& name, std::optional<int64_t>* out) {
  const ProblemKey& key = Typed(name, ValueType::kInteger);
  if (!Has(name)) return;
  int64_t value = out->value_or(0);
  reader_.Integer(name, key.least, key.most, &value);
  *out = value;
}

void ProblemReader::Read(const std::string& name, std::string* path) {
  const ProblemKey& key = Key(name);
  if (key.type == ValueType::kText) {
    reader_.Text(name, path);
    return;
  }
  CHECK(key.type == ValueType::kPath || key.type == ValueType::kPathOrMap)
      << key.path;
  const bool by_default =
      !key.default_value.empty() && reader_.IsWord(name, key.default_value);
  if (by_default) return;
  for (const ProblemWord& w : key.words) {
    if (!reader_.IsWord(name, w.word)) continue;
    *path = w.word;
    return;
  }
  reader_.Path(name, path);
}

void ProblemReader::Read(const std::string& name,
                         std::vector<std::string>* paths) {
  Typed(name, ValueType::kPathList);
  reader_.PathList(name, paths);
}

void ProblemReader::Read(const std::string& name, std::vector<double>* out) {
  reader_.NumberList(name, Typed(name, ValueType::kNumberList).range, out);
}

void ProblemReader::Read(const std::string& name, Eigen::Vector2d* out) {
  reader_.Pair(name, Typed(name, ValueType::kPair).range,
               /*one_for_all=*/false, out);
}

void ProblemReader::Read(const std::string& name,
                         std::optional<Eigen::Vector2d>* out) {
  const ProblemKey& key = Key(name);
  const bool one_for_all = key.type == ValueType::kOneOrPair;
  CHECK(one_for_all || key.type == ValueType::kPair) << key.path;
  Eigen::Vector2d value;
  value.setConstant(std::numeric_limits<double>::quiet_NaN());
  reader_.Pair(name, key.range, one_for_all, &value);
  if (value.allFinite()) *out = value;
}

void ProblemReader::Read(const std::string& name,
                         std::optional<Eigen::Matrix4d>* out) {
  Typed(name, ValueType::kMatrix);
  Eigen::Matrix4d value;
  value.setConstant(std::numeric_limits<double>::quiet_NaN());
  reader_.Matrix(name, &value);
  if (value.allFinite()) *out = value;
}

void ProblemReader::Read(const std::string& name, Eigen::Vector3d* out) {
  reader_.Triple(name, Typed(name, ValueType::kTriple).range,
                 /*one_for_all=*/false, out);
}

void ProblemReader::Read(const std::string& name, Eigen::Array3d* out) {
  Eigen::Vector3d value = out->matrix();
  reader_.Triple(name, Typed(name, ValueType::kOneOrTriple).range,
                 /*one_for_all=*/true, &value);
  *out = value.array();
}

void ProblemReader::Read(const std::string& name, std::optional<double>* out) {
  const ProblemKey& key = Typed(name, ValueType::kAutoOrNumber);
  const ConfigNode* node = Find(name);
  if (node == nullptr || reader_.IsWord(name, "auto")) return;
  if (node->kind != ConfigNode::Kind::kScalar) {
    reader_.FailExpected(name, "auto or a number");
    return;
  }
  double value = 0.0;
  reader_.Number(name, key.range, &value);
  *out = value;
}

void ProblemReader::Read(const std::string& name,
                         std::optional<Eigen::Array3d>* out) {
  const ProblemKey& key = Typed(name, ValueType::kAutoOrTriple);
  const ConfigNode* node = Find(name);
  if (node == nullptr || reader_.IsWord(name, "auto")) return;
  Eigen::Vector3d value;
  value.setConstant(std::numeric_limits<double>::quiet_NaN());
  reader_.Triple(name, key.range, /*one_for_all=*/true, &value);
  if (value.allFinite()) *out = value.array();
}

void ProblemReader::Read(const std::string& name, SurfaceValue* out) {
  const ProblemKey& key = Key(name);
  const bool triple = key.type == ValueType::kTripleOrPath;
  CHECK(triple || key.type == ValueType::kNumberOrPath) << key.path;
  const ConfigNode* node = Find(name);
  if (node == nullptr) return;
  if (reader_.IsPath(name)) {
    reader_.Path(name, &out->texture);
  } else if (triple) {
    Eigen::Vector3d value = out->value.matrix();
    reader_.Triple(name, key.range, /*one_for_all=*/true, &value);
    out->value = value.array();
  } else {
    double value = out->value[0];
    reader_.Number(name, key.range, &value);
    out->value.setConstant(value);
  }
}

void ProblemReader::ReadChoice(const std::string& name, int* index) {
  const ProblemKey& key = Key(name);
  CHECK(key.type == ValueType::kChoice || key.type == ValueType::kChoiceOrMap)
      << key.path;
  reader_.Choice(name, key.Words(), index);
}

void ProblemReader::Fail(const std::string& name, const std::string& what) {
  reader_.Fail(name, what);
}

void ProblemReader::Fail(const std::string& what) {
  context_->Fail(shown_, what);
}

void ProblemReader::FailExpected(const std::string& name,
                                 const std::string& expected) {
  reader_.FailExpected(name, expected);
}

void ProblemReader::CheckNeeds(const std::string& name, bool met) {
  if (met || !Has(name)) return;
  Fail(name, "expected with " + Key(name).needs + " only");
}

}  // namespace ibrdf
