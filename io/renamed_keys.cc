#include "ibrdf/io/renamed_keys.h"

#include <glog/logging.h>

#include <algorithm>

namespace ibrdf {
namespace {

void Warn(const std::string& where, const ProblemKey& key) {
  LOG(WARNING) << where << ": " << key.OldPath()
               << " has been renamed, please write " << key.path;
}

// The map at `path`; null where there is none.
ConfigNode* FindMap(const std::string& path, ConfigNode* root) {
  ConfigNode* node = root;
  for (size_t begin = 0; node != nullptr && begin < path.size();) {
    const size_t end = std::min(path.find('.', begin), path.size());
    const std::string name = path.substr(begin, end - begin);
    const auto entry =
        std::find_if(node->entries.begin(), node->entries.end(),
                     [&](const auto& e) { return e.first == name; });
    node = entry == node->entries.end() ? nullptr : &entry->second;
    begin = end + 1;
  }
  return node;
}

bool BeginsWith(const std::string& text, const std::string& path) {
  return text.compare(0, path.size(), path) == 0 && text.size() > path.size() &&
         (text[path.size()] == '.' || text[path.size()] == '=');
}

}  // namespace

Status RenameOldKeys(const ProblemSchema& schema, const std::string& file,
                     ConfigNode* root) {
  // A map precedes its keys: theirs are found below its new name.
  for (const ProblemKey& key : schema.keys) {
    if (key.old_name.empty()) continue;
    ConfigNode* const map = FindMap(key.Parent(), root);
    if (map == nullptr) continue;
    for (auto& [name, value] : map->entries) {
      if (name != key.old_name) continue;
      if (map->Find(key.Name()) != nullptr) {
        return InvalidInput(
            file + ": " + key.path,
            "expected once, found also under its former name " + key.OldPath());
      }
      Warn(file, key);
      name = key.Name();
    }
  }
  return OkStatus();
}

std::string WithNewName(const ProblemSchema& schema, const std::string& file,
                        const std::string& override_text) {
  std::string text = override_text;
  for (const ProblemKey& key : schema.keys) {
    if (key.old_name.empty() || !BeginsWith(text, key.OldPath())) continue;
    Warn(file + ": --set", key);
    text.replace(0, key.OldPath().size(), key.path);
  }
  return text;
}

}  // namespace ibrdf
