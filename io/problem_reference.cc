#include "ibrdf/io/problem_reference.h"

#include <algorithm>
#include <limits>
#include <sstream>

namespace ibrdf {
namespace {
using Strings = std::vector<std::string>;

constexpr size_t kLineWidth = 120;
// Where comments of the example begin.
constexpr size_t kCommentColumn = 30;

constexpr char kHead[] =
    "# Problem file\n"
    "\n"
    "<!-- `ibrdf_solve --keys` printed this page from "
    "io/problem_*_keys.cc. Change it there. -->\n";

constexpr char kIntroduction[] =
    "A problem file says what an image shows, what is known of it, and how to "
    "solve or render it. It is written in YAML. `ibrdf_solve --problem`, "
    "`ibrdf_render --scene` and `ibrdf_uncertainty --problem` read the same "
    "keys. `ibrdf_solve --keys` prints this page.";

const char* const kRules[] = {
    "Only `image` and `geometry` are needed, with `problem: textures` `views` "
    "in place of `image`. Every other key has a default.",
    "An unknown key is an error. The message names the nearest known key.",
    "Relative paths start at the folder of the file.",
    "`--set key.path=value` overrides one key of the file. `--set "
    "key.path=null` takes it out.",
    "A key that a program does not use is checked, and then ignored.",
    "A key that was renamed is accepted under its former name, with a warning.",
};

constexpr char kUses[] =
    "In the tables, *used by* says who uses a key. `joint`, `reflectance` and "
    "`illumination` are `ibrdf_solve` with that value of `problem`, and "
    "`solve` is all three. `render` is `ibrdf_render`, and `textures` is "
    "`ibrdf_uncertainty`.";

constexpr char kAboutExample[] =
    "A complete file for `ibrdf_solve`. Except for the names of files, all "
    "values are the defaults.";

constexpr char kAboutScene[] =
    "A complete file for `ibrdf_render`. It has a size in place of an image, "
    "and reflectance and illumination are known.";

// One paragraph in lines of at most kLineWidth; those after the first begin
// with `indent`.
std::string Wrapped(const std::string& text, const std::string& indent = "") {
  std::istringstream words(text);
  std::string out, line, word;
  while (words >> word) {
    if (line.size() + 1 + word.size() > kLineWidth) {
      out += line + "\n";
      line = indent + word;
    } else {
      line += (line.empty() ? "" : " ") + word;
    }
  }
  return out + line + "\n";
}

std::string Bullet(const std::string& text) {
  return Wrapped("- " + text, "  ");
}

std::string Code(const std::string& text) { return "`" + text + "`"; }

std::string TableRow(const Strings& cells) {
  std::string row = "|";
  for (const std::string& cell : cells) {
    row += cell.empty() ? " |" : " " + cell + " |";
  }
  return row + "\n";
}

std::string TableHead(const Strings& cells) {
  std::string rule = "|";
  for (size_t i = 0; i < cells.size(); ++i) rule += "---|";
  return TableRow(cells) + rule + "\n";
}

std::string Joined(const Strings& parts) {
  std::string text;
  for (const std::string& part : parts) {
    text += (text.empty() ? "" : ", ") + part;
  }
  return text;
}

std::string UsersText(unsigned uses) {
  Strings users;
  if ((uses & kUsedBySolve) == kUsedBySolve) {
    users.emplace_back("solve");
  } else {
    if (uses & kUsedByJoint) users.emplace_back("joint");
    if (uses & kUsedByReflectance) users.emplace_back("reflectance");
    if (uses & kUsedByIllumination) users.emplace_back("illumination");
  }
  if (uses & kUsedByRender) users.emplace_back("render");
  if (uses & kUsedByTextures) users.emplace_back("textures");
  return Joined(users);
}

std::string IntegersText(const ProblemKey& key) {
  if (key.most == std::numeric_limits<int64_t>::max()) {
    return ">= " + std::to_string(key.least);
  }
  return std::to_string(key.least) + " to " + std::to_string(key.most);
}

// What values a key takes.
std::string RangeText(const ProblemKey& key) {
  const std::string interval = IntervalText(key.range);
  switch (key.type) {
    case ValueType::kNumber:
      return interval;
    case ValueType::kAutoOrNumber:
      return "`auto` or " + interval;
    case ValueType::kInteger:
      return IntegersText(key);
    case ValueType::kTriple:
      return "three numbers" + (interval.empty() ? "" : " " + interval);
    case ValueType::kOneOrTriple:
      return interval + ", one number or three";
    case ValueType::kAutoOrTriple:
      return "`auto` or " + interval + ", one number or three";
    case ValueType::kNumberOrPath:
      return interval + ", or a texture: " + key.files;
    case ValueType::kTripleOrPath:
      return interval + ", one number or three, or a texture: " + key.files;
    case ValueType::kNumberList:
      return "a list of numbers" + (interval.empty() ? "" : " " + interval);
    case ValueType::kPathList:
      return "a list of " + key.files;
    case ValueType::kPair:
      return "two numbers" + (interval.empty() ? "" : " " + interval);
    case ValueType::kOneOrPair:
      return interval + ", one number or two";
    case ValueType::kMatrix:
      return "four rows of four numbers";
    case ValueType::kChoice:
      return "a word, below";
    case ValueType::kChoiceOrMap:
      return "a word, below, or a map";
    case ValueType::kWordOrList:
      return "a word or a list, below";
    case ValueType::kPath:
      return key.files + (key.words.empty() ? "" : ", or a word, below");
    case ValueType::kText:
      return "text";
    case ValueType::kMap:
      return "a map";
    case ValueType::kPathOrMap:
      return key.files + " or a map";
    case ValueType::kOptionalMap:
      return "`{}` or a map";
    case ValueType::kListOrMap:
      return "a list of maps, or a map";
  }
  return "";
}

std::string DefaultText(const ProblemKey& key) {
  return key.default_value.empty() ? key.without : Code(key.default_value);
}

std::string KeyRow(const ProblemKey& key) {
  const std::string needs =
      key.needs.empty() ? "" : " Needs " + Code(key.needs) + ".";
  return TableRow({Code(key.path), DefaultText(key), key.unit, RangeText(key),
                   UsersText(key.used_by), key.meaning + needs});
}

std::string WordTable(const std::string& title,
                      const std::vector<ProblemWord>& words) {
  if (words.empty()) return "";
  std::string text = "\n" + TableHead({title, "meaning"});
  for (const ProblemWord& w : words) {
    const std::string users = w.used_by == kUsedByAll
                                  ? ""
                                  : " For " + UsersText(w.used_by) + " alone.";
    text += TableRow({Code(w.word), w.meaning + users});
  }
  return text;
}

bool IsBelow(const ProblemKey& key, const std::string& map) {
  return key.path.compare(0, map.size() + 1, map + ".") == 0;
}

// The section of a key at the top and of all keys below it.
std::string Section(const ProblemSchema& schema, const ProblemKey& top) {
  std::vector<const ProblemKey*> rows;
  for (const ProblemKey& key : schema.keys) {
    if (IsBelow(key, top.path)) rows.push_back(&key);
  }
  const bool map = !rows.empty();
  std::string text = "\n## " + top.path + "\n\n";
  if (map) {
    text += Wrapped(top.meaning) + "\n";
  } else {
    rows.push_back(&top);
  }
  text += TableHead({"key", "default", "unit", "range", "used by", "meaning"});
  for (const ProblemKey* key : rows) text += KeyRow(*key);
  if (!top.notes.empty()) text += "\n";
  for (const std::string& note : top.notes) text += Bullet(note);
  for (const ProblemKey* key : rows) {
    text += WordTable(Code(key->path), key->words);
    text += WordTable("in a list of " + Code(key->path), key->list_words);
  }
  return text;
}

std::string FormerNames(const ProblemSchema& schema) {
  std::string rows;
  for (const ProblemKey& key : schema.keys) {
    if (key.old_name.empty()) continue;
    rows += TableRow({Code(key.OldPath()), Code(key.path)});
  }
  if (rows.empty()) return "";
  return "\n## Former names\n\n" + TableHead({"former name", "key"}) + rows;
}

// Whether a file whose other keys are at their defaults can have the key:
// "camera.type: perspective" is not the default, "geometry.mesh" has none.
bool GoesWithDefaults(const ProblemSchema& schema, const ProblemKey& key) {
  if (key.needs.empty()) return true;
  const size_t colon = key.needs.find(": ");
  return colon != std::string::npos &&
         schema.Key(key.needs.substr(0, colon)).default_value ==
             key.needs.substr(colon + 2);
}

std::string ExampleComment(const ProblemKey& key) {
  if (key.type != ValueType::kChoice) return key.unit;
  std::string text;
  for (const std::string& word : key.Words()) {
    text += (text.empty() ? "" : " | ") + word;
  }
  return text;
}

std::string ExampleLine(const ProblemKey& key, const std::string& value) {
  const auto depth = std::count(key.path.begin(), key.path.end(), '.');
  std::string line(2 * static_cast<size_t>(depth), ' ');
  line += key.Name() + ":" + (value.empty() ? "" : " " + value);
  const std::string comment = value.empty() ? "" : ExampleComment(key);
  if (!comment.empty()) {
    line.resize(std::max(line.size() + 1, kCommentColumn), ' ');
    line += "# " + comment;
  }
  return line + "\n";
}

}  // namespace

std::string ExampleProblem(const ProblemSchema& schema) {
  std::string text, maps;
  for (const ProblemKey& key : schema.keys) {
    if (key.type == ValueType::kMap) {
      maps = ExampleLine(key, "");
      continue;
    }
    const std::string& value =
        key.example.empty() ? key.default_value : key.example;
    if (value.empty() || !(key.used_by & kUsedByJoint) ||
        !GoesWithDefaults(schema, key)) {
      continue;
    }
    text += maps + ExampleLine(key, value);
    maps.clear();
  }
  return text;
}

std::string ExampleScene() {
  return R"(image: {width: 128, height: 128}
geometry: {mesh: vase.obj}
reflectance:
  known:
    cook_torrance: {diffuse: [0.25, 0.08, 0.05], roughness: 0.1}
illumination:
  width: 256
  known:
    sky: {sun_theta_degrees: 50, sun_phi_degrees: 35}
quality: preview
noise: 0.02
)";
}

std::string ProblemReference(const ProblemSchema& schema) {
  std::string text = std::string(kHead) + "\n" + Wrapped(kIntroduction) + "\n";
  for (const char* rule : kRules) text += Bullet(rule);
  text += "\n" + Wrapped(kUses);
  text += "\n## Example\n\n" + Wrapped(kAboutExample) + "\n```yaml\n" +
          ExampleProblem(schema) + "```\n";
  text +=
      "\n" + Wrapped(kAboutScene) + "\n```yaml\n" + ExampleScene() + "```\n";
  for (const ProblemKey& key : schema.keys) {
    if (key.Parent().empty()) text += Section(schema, key);
  }
  return text + FormerNames(schema);
}

}  // namespace ibrdf
