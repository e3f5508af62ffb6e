// Every key of a problem file, once: the parser takes names, ranges and words
// from here, result.json its words, and docs/problem_file.md is rendered from
// here (io/problem_reference.h). The keys of a section are in a file of their
// own, problem_*_keys.cc.
#pragma once
#include <string>
#include <vector>

#include "ibrdf/io/problem_key.h"

namespace ibrdf {

struct ProblemSchema {
  // A map precedes the keys below it. Messages and the reference keep the
  // order.
  std::vector<ProblemKey> keys;

  // `path` is one of the keys.
  const ProblemKey& Key(const std::string& path) const;
  // Names of the keys right below a map; of the file itself where `map` is
  // empty.
  std::vector<std::string> NamesBelow(const std::string& map) const;
};

// The schema of this version's problem files.
const ProblemSchema& ProblemFileSchema();

// What problem files call a value of the choice `path`.
template <typename Enum>
const std::string& WordOf(const std::string& path, Enum value) {
  return ProblemFileSchema()
      .Key(path)
      .words.at(static_cast<size_t>(value))
      .word;
}

}  // namespace ibrdf
