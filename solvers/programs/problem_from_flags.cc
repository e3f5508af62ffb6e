#include "ibrdf/solvers/programs/problem_from_flags.h"

#include <algorithm>
#include <cctype>
#include <filesystem>
#include <utility>

#include "ibrdf/io/atomic_file.h"
#include "ibrdf/io/config_text.h"
#include "ibrdf/io/config_tree.h"
#include "ibrdf/io/problem_file.h"
#include "ibrdf/io/renamed_keys.h"

namespace ibrdf {
namespace {
namespace fs = std::filesystem;

constexpr char kCommandLine[] = "command line";
// The first line of a file that flags made begins so.
constexpr char kMadeBy[] = "# Made by: ";
constexpr size_t kMaxFileBytes = size_t{1} << 20;

ConfigNode* Child(ConfigNode* map, const std::string& key) {
  map->kind = ConfigNode::Kind::kMap;
  for (auto& [name, node] : map->entries) {
    if (name == key) return &node;
  }
  map->entries.emplace_back(key, ConfigNode());
  return &map->entries.back().second;
}

// The key "map.name", made where need be; null unless `make`.
ConfigNode* At(ConfigNode* root, const std::string& path, bool make) {
  ConfigNode* node = root;
  for (size_t begin = 0; begin <= path.size();) {
    const size_t end = std::min(path.find('.', begin), path.size());
    const std::string name = path.substr(begin, end - begin);
    if (!make && node->Find(name) == nullptr) return nullptr;
    node = Child(node, name);
    begin = end + 1;
  }
  return node;
}

// Text, whatever it looks like in YAML.
ConfigNode TextNode(const std::string& value) {
  ConfigNode node;
  node.kind = ConfigNode::Kind::kScalar;
  node.scalar = value;
  node.quoted = true;
  return node;
}

void SetText(ConfigNode* root, const std::string& path,
             const std::string& value) {
  if (!value.empty()) *At(root, path, true) = TextNode(value);
}

// One photograph, or several under lights of their own.
void SetPhotos(const std::vector<std::string>& photos, ConfigNode* root) {
  if (photos.size() == 1) return SetText(root, "image.file", photos[0]);
  ConfigNode* const images = At(root, "images", true);
  images->kind = ConfigNode::Kind::kList;
  for (const std::string& photo : photos) {
    images->items.push_back(TextNode(photo));
  }
}

// The tree that the flags but --set stand for.
ConfigNode TreeOf(const ProblemFlags& flags) {
  ConfigNode root;
  if (!flags.known_light.empty()) SetText(&root, "problem", "reflectance");
  SetPhotos(flags.photos, &root);
  SetText(&root, "image.mask", flags.mask);
  SetText(&root, "image.response", flags.response);
  SetText(&root, "geometry.normals", flags.normals);
  SetText(&root, "geometry.mesh", flags.mesh);
  SetText(&root, "illumination.known", flags.known_light);
  return root;
}

Status CheckText(const ProblemFlags& flags) {
  std::vector<std::pair<std::string, std::string>> texts;
  for (const std::string& photo : flags.photos) {
    texts.emplace_back("the photograph", photo);
  }
  texts.insert(texts.end(), {{"--mask", flags.mask},
                             {"--response", flags.response},
                             {"--normals", flags.normals},
                             {"--mesh", flags.mesh},
                             {"--known-light", flags.known_light},
                             {"--out", flags.out}});
  for (const auto& [option, text] : texts) {
    if (!IsUtf8(text)) {
      return InvalidInput(std::string(kCommandLine) + ": " + option,
                          "expected a name in UTF-8");
    }
  }
  return OkStatus();
}

// Nobody said what the shape is.
void AssumeSphere(ConfigNode* root, std::vector<std::string>* notes) {
  const ConfigNode* const geometry = root->Find("geometry");
  for (const char* shape : {"sphere", "mesh", "normals", "depth"}) {
    if (geometry != nullptr && geometry->Find(shape) != nullptr) return;
  }
  At(root, "geometry.sphere", true)->kind = ConfigNode::Kind::kMap;
  notes->push_back(
      At(root, "image.mask", false) != nullptr
          ? "no --normals and no --mesh: the object is taken for a sphere "
            "whose outline is the mask's"
          : "no --normals and no --mesh: the object is taken for a sphere "
            "whose outline touches the image's shorter sides");
}

std::string MovedPath(const std::string& path, const std::string& out) {
  if (fs::path(path).is_absolute()) return path;
  const fs::path here = fs::absolute(path).lexically_normal();
  if (fs::path(out).is_absolute()) return here.string();
  // A link on the way to the folder leads back to another place.
  const fs::path folder = fs::absolute(out).lexically_normal();
  std::error_code ignored;
  if (fs::weakly_canonical(folder, ignored) !=
      fs::weakly_canonical(fs::current_path(), ignored) /
          fs::path(out).lexically_normal()) {
    return here.string();
  }
  return here.lexically_relative(folder).string();
}

// Moves the path in a node that holds the name of a file.
void MovePath(const std::string& out, ConfigNode* node) {
  if (node->kind != ConfigNode::Kind::kScalar || node->scalar.empty()) return;
  node->scalar = MovedPath(node->scalar, out);
  node->quoted = true;
}

// Paths of the tree, relative to the current folder, as seen from `out`.
void MovePaths(const std::string& out, ConfigNode* root) {
  for (const ProblemKey& key : ProblemFileSchema().keys) {
    if (key.type != ValueType::kPath && key.type != ValueType::kPathOrMap &&
        key.type != ValueType::kPathList) {
      continue;
    }
    ConfigNode* const node = At(root, key.path, false);
    if (node == nullptr || key.IsNoFile(node->scalar)) continue;
    MovePath(out, node);
    for (ConfigNode& item : node->items) MovePath(out, &item);
  }
}

bool IsShellSafe(const std::string& text) {
  return !text.empty() &&
         std::all_of(text.begin(), text.end(), [](unsigned char c) {
           return std::isalnum(c) != 0 ||
                  std::string("_-./=,:+%@").find(static_cast<char>(c)) !=
                      std::string::npos ||
                  c >= 0x80;
         });
}

}  // namespace

bool ProblemFlags::Any() const {
  return !photos.empty() ||
         !(mask + response + normals + mesh + known_light).empty();
}

StatusOr<FlagProblem> ProblemFromFlags(const ProblemFlags& flags) {
  if (flags.photos.empty() || flags.photos.front().empty()) {
    return InvalidInput(kCommandLine,
                        "expected a photograph, as in: ibrdf_solve photo.exr "
                        "--normals normals.npy --mask mask.png");
  }
  IBRDF_RETURN_IF_ERROR(CheckText(flags));
  const ProblemSchema& schema = ProblemFileSchema();
  FlagProblem made;
  ConfigNode root = TreeOf(flags);
  for (const std::string& text : flags.overrides) {
    IBRDF_RETURN_IF_ERROR(
        ApplyOverride(WithNewName(schema, kCommandLine, text), &root));
  }
  IBRDF_RETURN_IF_ERROR(RenameOldKeys(schema, kCommandLine, &root));
  AssumeSphere(&root, &made.notes);
  // Errors are of the command line; the file does not exist yet.
  const StatusOr<Problem> here =
      ParseProblem(kCommandLine, ConfigText(root), {});
  if (!here.ok()) return here.status();
  MovePaths(flags.out, &root);
  made.text = kMadeBy + flags.command + "\n" + ConfigText(root);
  StatusOr<Problem> there =
      ParseProblem(flags.out + "/problem.yaml", made.text, {});
  if (!there.ok()) return there.status();
  made.problem = *std::move(there);
  return made;
}

Status WriteFlagProblem(const FlagProblem& made, const std::string& out) {
  const std::string path = out + "/problem.yaml";
  std::error_code ignored;
  if (fs::exists(path, ignored)) {
    const StatusOr<std::string> earlier = ReadFile(path, kMaxFileBytes);
    if (!earlier.ok()) return earlier.status();
    if (earlier->rfind(kMadeBy, 0) != 0) {
      return InvalidInput(path,
                          "is a problem file that no command line made; choose "
                          "another folder (--out) or name it (--problem)");
    }
  }
  return WriteFileAtomically(path, made.text);
}

std::string ShellCommand(const std::vector<std::string>& arguments) {
  std::string line;
  for (const std::string& argument : arguments) {
    if (!line.empty()) line += ' ';
    if (IsShellSafe(argument)) {
      line += argument;
      continue;
    }
    line += '\'';
    for (const char c : argument) {
      const auto byte = static_cast<unsigned char>(c);
      line += c == '\'' ? std::string("'\\''")
                        : std::string(1, byte < 0x20 || byte == 0x7f ? '?' : c);
    }
    line += '\'';
  }
  return line;
}

}  // namespace ibrdf
