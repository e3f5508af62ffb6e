#include "ibrdf/io/config_tree.h"

#include <yaml-cpp/eventhandler.h>
#include <yaml-cpp/yaml.h>

#include <algorithm>
#include <exception>
#include <sstream>

namespace ibrdf {
namespace {
constexpr size_t kMaxConfigBytes = size_t{1} << 20;
constexpr size_t kMaxDepth = 32;
// YAML's keys have 1024 characters on their line, where one may take four.
constexpr size_t kMaxKeyBytes = 200;

// Thrown from the handler, caught in ParseConfig.
struct Refusal {
  int line;
  std::string what;
};

// Builds the tree from the parser's events. Aliases arrive as events of their
// own and are refused, so nothing is expanded.
class TreeBuilder final : public YAML::EventHandler {
 public:
  ConfigNode root;

  void OnDocumentStart(const YAML::Mark&) override {}
  void OnDocumentEnd() override {}
  void OnNull(const YAML::Mark& mark, YAML::anchor_t anchor) override {
    Refuse(mark, "", anchor);
    ConfigNode node;
    node.line = mark.line + 1;
    Add(mark, std::move(node));
  }
  void OnAlias(const YAML::Mark& mark, YAML::anchor_t) override {
    throw Refusal{mark.line + 1, "aliases (*name) are not accepted"};
  }
  void OnScalar(const YAML::Mark& mark, const std::string& tag,
                YAML::anchor_t anchor, const std::string& value) override {
    // The parser marks plain scalars with "?", quoted ones with "!".
    Refuse(mark, tag == "?" || tag == "!" ? "" : tag, anchor);
    ConfigNode node;
    node.line = mark.line + 1;
    node.quoted = tag == "!";
    const bool null =
        !node.quoted && (value.empty() || value == "~" || value == "null" ||
                         value == "Null" || value == "NULL");
    if (!null) {
      node.kind = ConfigNode::Kind::kScalar;
      node.scalar = value;
    }
    Add(mark, std::move(node));
  }
  void OnSequenceStart(const YAML::Mark& mark, const std::string& tag,
                       YAML::anchor_t anchor,
                       YAML::EmitterStyle::value) override {
    Open(mark, tag, anchor, ConfigNode::Kind::kList);
  }
  void OnSequenceEnd() override { Close(); }
  void OnMapStart(const YAML::Mark& mark, const std::string& tag,
                  YAML::anchor_t anchor, YAML::EmitterStyle::value) override {
    Open(mark, tag, anchor, ConfigNode::Kind::kMap);
  }
  void OnMapEnd() override { Close(); }

 private:
  struct Frame {
    ConfigNode node;
    std::string key;
    bool has_key = false;
  };

  static void Refuse(const YAML::Mark& mark, const std::string& tag,
                     YAML::anchor_t anchor) {
    if (anchor != YAML::NullAnchor) {
      throw Refusal{mark.line + 1, "anchors (&name) are not accepted"};
    }
    if (!tag.empty() && tag != "?" && tag != "!") {
      throw Refusal{mark.line + 1, "tags (" + tag + ") are not accepted"};
    }
  }

  void Open(const YAML::Mark& mark, const std::string& tag,
            YAML::anchor_t anchor, ConfigNode::Kind kind) {
    Refuse(mark, tag, anchor);
    if (stack_.size() >= kMaxDepth) {
      throw Refusal{mark.line + 1, "nested over " + std::to_string(kMaxDepth) +
                                       " levels deep"};
    }
    if (!stack_.empty() && stack_.back().node.kind == ConfigNode::Kind::kMap &&
        !stack_.back().has_key) {
      throw Refusal{mark.line + 1, "expected a word as key"};
    }
    Frame frame;
    frame.node.kind = kind;
    frame.node.line = mark.line + 1;
    stack_.push_back(std::move(frame));
  }

  void Close() {
    ConfigNode node = std::move(stack_.back().node);
    stack_.pop_back();
    YAML::Mark mark;
    mark.line = node.line - 1;
    Add(mark, std::move(node));
  }

  void Add(const YAML::Mark& mark, ConfigNode node) {
    if (stack_.empty()) {
      root = std::move(node);
      return;
    }
    Frame& top = stack_.back();
    if (top.node.kind == ConfigNode::Kind::kList) {
      top.node.items.push_back(std::move(node));
    } else if (!top.has_key) {
      if (node.kind != ConfigNode::Kind::kScalar || node.scalar.empty()) {
        throw Refusal{mark.line + 1, "expected a word as key"};
      }
      if (node.scalar.size() > kMaxKeyBytes) {
        throw Refusal{mark.line + 1, "expected a key of at most " +
                                         std::to_string(kMaxKeyBytes) +
                                         " bytes"};
      }
      if (top.node.Find(node.scalar) != nullptr) {
        throw Refusal{mark.line + 1, "duplicate key '" + node.scalar + "'"};
      }
      top.key = node.scalar;
      top.has_key = true;
    } else {
      top.node.entries.emplace_back(std::move(top.key), std::move(node));
      top.has_key = false;
    }
  }

  std::vector<Frame> stack_;
};

Status AtLine(const std::string& where, int line, const std::string& what) {
  return InvalidInput(where, "line " + std::to_string(line) + ": " + what);
}

// Whether the line, from 0, or the one before it begins with white space that
// holds a tab.
bool LineHasTab(const std::string& text, int line) {
  std::istringstream lines(text);
  std::string one;
  for (int i = 0; i <= line && std::getline(lines, one); ++i) {
    const size_t indent = one.find_first_not_of(" \t");
    if (i + 1 >= line && one.substr(0, indent).find('\t') != one.npos) {
      return true;
    }
  }
  return false;
}

}  // namespace

const ConfigNode* ConfigNode::Find(const std::string& key) const {
  for (const auto& [name, node] : entries) {
    if (name == key) return &node;
  }
  return nullptr;
}

StatusOr<ConfigNode> ParseConfig(const std::string& where,
                                 const std::string& text) {
  if (text.size() > kMaxConfigBytes) {
    return InvalidInput(where, "expected at most 1 MiB, found " +
                                   std::to_string(text.size()) + " bytes");
  }
  if (text.find('\0') != std::string::npos) {
    return InvalidInput(where, "expected YAML text, found a zero byte");
  }
  try {
    std::istringstream stream(text);
    YAML::Parser parser(stream);
    TreeBuilder first, second;
    parser.HandleNextDocument(first);
    if (parser.HandleNextDocument(second)) {
      return InvalidInput(where, "expected one YAML document, found more");
    }
    return std::move(first.root);
  } catch (const Refusal& refusal) {
    return AtLine(where, refusal.line, refusal.what);
  } catch (const YAML::Exception& e) {
    return AtLine(where, e.mark.line + 1,
                  LineHasTab(text, e.mark.line)
                      ? e.msg + "; tabs cannot indent, use spaces"
                      : e.msg);
  } catch (const std::exception& e) {
    return InvalidInput(where,
                        std::string("cannot be read as YAML: ") + e.what());
  }
}

Status ApplyOverride(const std::string& override_text, ConfigNode* root) {
  const std::string where = "--set " + override_text;
  const size_t equals = override_text.find('=');
  if (equals == std::string::npos || equals == 0) {
    return InvalidInput(where, "expected key.path=value");
  }
  StatusOr<ConfigNode> value =
      ParseConfig(where, override_text.substr(equals + 1));
  if (!value.ok()) return value.status();

  std::vector<std::string> keys(1);
  for (const char c : override_text.substr(0, equals)) {
    if (c == '.') {
      keys.emplace_back();
    } else {
      keys.back() += c;
    }
  }
  ConfigNode* node = root;
  for (size_t k = 0; k < keys.size(); ++k) {
    if (keys[k].empty()) {
      return InvalidInput(where, "expected key.path=value, found an empty key");
    }
    if (k >= kMaxDepth || keys[k].size() > kMaxKeyBytes) {
      return InvalidInput(where, "nested too deep, or a key too long");
    }
    // A scalar or list on the way gives place to the map that was asked for.
    if (node->kind != ConfigNode::Kind::kMap) {
      *node = ConfigNode();
      node->kind = ConfigNode::Kind::kMap;
    }
    auto entry =
        std::find_if(node->entries.begin(), node->entries.end(),
                     [&](const auto& e) { return e.first == keys[k]; });
    const bool last = k + 1 == keys.size();
    if (last && value->kind == ConfigNode::Kind::kNull) {
      if (entry != node->entries.end()) node->entries.erase(entry);
      return OkStatus();
    }
    if (entry == node->entries.end()) {
      entry = node->entries.emplace(node->entries.end(), keys[k], ConfigNode());
    }
    node = &entry->second;
  }
  *node = *std::move(value);
  return OkStatus();
}

}  // namespace ibrdf
