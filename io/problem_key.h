// What is known of one key of a problem file.
#pragma once
#include <cstdint>
#include <string>
#include <vector>

#include "ibrdf/io/config_reader.h"

namespace ibrdf {

enum class ValueType {
  kNumber,        // in `range`
  kAutoOrNumber,  // the word auto, or a number in `range`
  kInteger,       // in [least, most]
  kTriple,        // a list of three numbers, each in `range`
  kOneOrTriple,   // the same, or one number for all three
  kAutoOrTriple,  // the word auto, or as kOneOrTriple
  kNumberOrPath,  // a number in `range`, or the name of a file
  kTripleOrPath,  // as kOneOrTriple, or the name of a file
  kNumberList,    // a list of numbers, each in `range`
  kPathList,      // a list of names of files
  kPair,          // a list of two numbers, each in `range`
  kOneOrPair,     // the same, or one number for both
  kMatrix,        // four lists of four numbers
  kChoice,        // one of `words`
  kChoiceOrMap,   // the same, or a map of the keys below this one
  kWordOrList,    // one of `words`, or a list of some of `list_words`
  kPath,          // the name of a file, the default's word or one of `words`
  kText,          // any text that is not empty
  kMap,           // of the keys below this one
  kPathOrMap,     // the name of a file, or such a map
  kOptionalMap,   // {}, or a map of the keys below this one
  kListOrMap,     // a list of maps, or a map of the keys below this one
};

// Bits: who uses a key or a word. The first three are ibrdf_solve with that
// value of `problem`.
enum ProblemUse : unsigned {
  kUsedByJoint = 1,
  kUsedByReflectance = 2,
  kUsedByIllumination = 4,
  kUsedByRender = 8,
  kUsedByTextures = 16,  // ibrdf_uncertainty
  kUsedBySolve = 7,
  kUsedByAll = 31,
};

struct ProblemWord {
  std::string word;
  std::string meaning;
  unsigned used_by = kUsedByAll;
};

// Texts are Markdown without line breaks.
struct ProblemKey {
  std::string path;  // "camera.fov_degrees"
  ValueType type = ValueType::kMap;
  std::string meaning;  // one or two sentences
  std::string unit;
  Range range;
  int64_t least = 0, most = 0;
  // A word's place is its value in the enumeration that it stands for.
  std::vector<ProblemWord> words, list_words;
  std::string files;          // the extensions of a path
  std::string default_value;  // as a file has it; empty: none
  std::string without;        // what stands in its place: "needed"
  unsigned used_by = kUsedByAll;
  // The key is refused without this: "camera.type: perspective" or
  // "geometry.mesh". Empty: nothing.
  std::string needs;
  // The last word of the path before the key was renamed: still accepted, with
  // a warning. Empty: never renamed.
  std::string old_name;
  std::vector<std::string> notes;  // rules between several keys below this one
  std::string example;  // a value for the example file; empty: the default

  // Whether the text of a path is the default's word or one of `words`, and so
  // no file's name.
  bool IsNoFile(const std::string& text) const;
  // The path's last word, and what precedes it: "" at the top.
  std::string Name() const;
  std::string Parent() const;
  // "camera.fov", the path before the key was renamed.
  std::string OldPath() const;

  std::vector<std::string> Words() const;
  std::vector<std::string> ListWords() const;
};

// "a.b", and "b" where `map` is empty.
std::string JoinPath(const std::string& map, const std::string& name);

}  // namespace ibrdf
