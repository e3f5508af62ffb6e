// Typed values from a ConfigNode, with messages that name file and key.
#pragma once
#include <Eigen/Core>
#include <cstdint>
#include <limits>
#include <string>
#include <vector>

#include "ibrdf/io/config_tree.h"

namespace ibrdf {

// What all readers of one file share: the first error wins.
struct ConfigContext {
  std::string file;
  std::string folder;  // of the file; relative paths start there
  Status error;

  void Fail(const std::string& key, const std::string& what);
};

// Ends of an interval of numbers, infinite where there is none.
struct Range {
  double low = -std::numeric_limits<double>::infinity();
  double high = std::numeric_limits<double>::infinity();
  bool low_included = true;
  bool high_included = true;
};

// "(0, 180]", ">= 0"; empty where any number will do.
std::string IntervalText(const Range& range);

// Reads one map. Each function leaves its output as it is when the key is
// absent or wrong; the latter is reported to the context.
class ConfigReader {
 public:
  // `node` null or absent: an empty map. Keys beside `known` are errors that
  // name the nearest known one.
  ConfigReader(ConfigContext* context, const ConfigNode* node,
               const std::string& path, const std::vector<std::string>& known);

  bool Has(const std::string& key) const { return Find(key) != nullptr; }
  // Null when absent.
  const ConfigNode* Find(const std::string& key) const;
  std::string PathOf(const std::string& key) const;
  bool IsWord(const std::string& key, const std::string& word) const;
  // Whether the value is text that is no number.
  bool IsPath(const std::string& key) const;

  void Number(const std::string& key, const Range& range, double* out);
  void Integer(const std::string& key, int64_t low, int64_t high, int64_t* out);
  void Integer(const std::string& key, int low, int high, int* out);
  // Index in `words` of the value.
  void Choice(const std::string& key, const std::vector<std::string>& words,
              int* out);
  void Text(const std::string& key, std::string* out);
  // A file's name, resolved against the folder.
  void Path(const std::string& key, std::string* out);
  // A list of files' names, each as Path; of numbers.
  void PathList(const std::string& key, std::vector<std::string>* out);
  void NumberList(const std::string& key, const Range& range,
                  std::vector<double>* out);
  // A list of two numbers; with `one_for_all` one number stands for both.
  void Pair(const std::string& key, const Range& range, bool one_for_all,
            Eigen::Vector2d* out);
  // A list of four lists of four numbers, the rows.
  void Matrix(const std::string& key, Eigen::Matrix4d* out);
  // Three numbers; with `one_for_all` one number stands for three.
  void Triple(const std::string& key, const Range& range, bool one_for_all,
              Eigen::Vector3d* out);

  void Fail(const std::string& key, const std::string& what);
  // "expected <expected>, found <the value>".
  void FailExpected(const std::string& key, const std::string& expected);

 private:
  // A file's name against the folder.
  std::string Resolved(const std::string& name) const;
  // Null when absent, and, reported as not what is expected, when it is no
  // text or empty.
  const std::string* FindText(const std::string& key,
                              const std::string& expected);

  ConfigContext* context_;
  const ConfigNode* node_;
  std::string path_;
};

// The nearest of `known` by edit distance (insert, delete, replace, swap of
// neighbours); `known` is not empty.
std::string NearestWord(const std::string& word,
                        const std::vector<std::string>& known);

// How a message shows a value.
std::string Describe(const ConfigNode& node);

// "a, b or c".
std::string JoinWords(const std::vector<std::string>& words);

}  // namespace ibrdf
