#include "ibrdf/io/problem_key.h"

#include <algorithm>

namespace ibrdf {
namespace {

std::vector<std::string> Bare(const std::vector<ProblemWord>& words) {
  std::vector<std::string> out;
  for (const ProblemWord& w : words) out.push_back(w.word);
  return out;
}

}  // namespace

std::string JoinPath(const std::string& map, const std::string& name) {
  return map.empty() ? name : map + "." + name;
}

std::string ProblemKey::Name() const {
  return path.substr(path.rfind('.') + 1);  // npos + 1 is 0
}

std::string ProblemKey::Parent() const {
  const size_t dot = path.rfind('.');
  return dot == std::string::npos ? "" : path.substr(0, dot);
}

bool ProblemKey::IsNoFile(const std::string& text) const {
  if (text.empty()) return false;
  return text == default_value ||
         std::any_of(words.begin(), words.end(),
                     [&](const ProblemWord& w) { return w.word == text; });
}

std::string ProblemKey::OldPath() const { return JoinPath(Parent(), old_name); }

std::vector<std::string> ProblemKey::Words() const { return Bare(words); }

std::vector<std::string> ProblemKey::ListWords() const {
  return Bare(list_words);
}

}  // namespace ibrdf
