// Typed values from one map of a problem file, as its schema has them.
#pragma once
#include <Eigen/Core>
#include <cstdint>
#include <optional>
#include <string>
#include <type_traits>

#include "ibrdf/io/config_reader.h"
#include "ibrdf/io/problem.h"
#include "ibrdf/io/problem_schema.h"

namespace ibrdf {

// Reports to the context what the schema does not allow, as ConfigReader does.
class ProblemReader {
 public:
  // `map`: path of the map, "" for the file. `node` null or absent: an empty
  // map. The three pointers are kept.
  ProblemReader(const ProblemSchema* schema, const std::string& map,
                const ConfigNode* node, ConfigContext* context);
  // The map that a key holds.
  ProblemReader Below(const std::string& name) const;
  // A map with the keys of the schema's `map` that stands elsewhere: messages
  // call it `shown`.
  ProblemReader Like(const std::string& map, const std::string& shown,
                     const ConfigNode* node) const;
  // A map of other keys than the schema's.
  ConfigReader Other(const std::string& shown, const ConfigNode& node,
                     const std::vector<std::string>& known) const;

  bool Has(const std::string& name) const { return reader_.Has(name); }
  // Null when absent.
  const ConfigNode* Find(const std::string& name) const;
  const ProblemKey& Key(const std::string& name) const;

  // Each leaves its output as it is when the key is absent or wrong.
  void Read(const std::string& name, double* out);
  void Read(const std::string& name, int* out);
  void Read(const std::string& name, std::string* path);
  void Read(const std::string& name, std::vector<std::string>* paths);
  void Read(const std::string& name, std::vector<double>* out);
  void Read(const std::string& name, Eigen::Vector2d* out);
  void Read(const std::string& name, std::optional<Eigen::Vector2d>* out);
  void Read(const std::string& name, std::optional<Eigen::Matrix4d>* out);
  void Read(const std::string& name, Eigen::Vector3d* out);
  void Read(const std::string& name, Eigen::Array3d* out);
  // The word auto leaves it unset.
  void Read(const std::string& name, std::optional<double>* out);
  void Read(const std::string& name, std::optional<Eigen::Array3d>* out);
  void Read(const std::string& name, std::optional<int64_t>* out);
  // One number for all channels or, where the key takes three, a triple.
  void Read(const std::string& name, SurfaceValue* out);
  template <typename Enum,
            typename = std::enable_if_t<std::is_enum<Enum>::value>>
  void Read(const std::string& name, Enum* out) {
    int index = static_cast<int>(*out);
    ReadChoice(name, &index);
    *out = static_cast<Enum>(index);
  }

  // The first word, auto, leaves it unset; the next one is value 0.
  template <typename Enum,
            typename = std::enable_if_t<std::is_enum<Enum>::value>>
  void Read(const std::string& name, std::optional<Enum>* out) {
    int index = out->has_value() ? static_cast<int>(**out) + 1 : 0;
    ReadChoice(name, &index);
    *out = index > 0 ? std::optional<Enum>(static_cast<Enum>(index - 1))
                     : std::nullopt;
  }

  // The word's place among the key's.
  void ReadChoice(const std::string& name, int* index);

  // What is wrong with a key, or with the map itself.
  void Fail(const std::string& name, const std::string& what);
  void Fail(const std::string& what);
  // "expected <expected>, found <the value>".
  void FailExpected(const std::string& name, const std::string& expected);
  // Fails where the key is there but not what it needs (ProblemKey::needs).
  void CheckNeeds(const std::string& name, bool met);

 private:
  const ProblemKey& Typed(const std::string& name, ValueType type) const;

  ProblemReader(const ProblemSchema* schema, const std::string& map,
                const std::string& shown, const ConfigNode* node,
                ConfigContext* context);

  const ProblemSchema* schema_;
  std::string map_;
  std::string shown_;  // in messages
  ConfigContext* context_;
  ConfigReader reader_;
};

}  // namespace ibrdf
