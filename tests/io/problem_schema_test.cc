#include "ibrdf/io/problem_schema.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <nlohmann/json.hpp>
#include <sstream>
#include <string>
#include <vector>

#include "ibrdf/base/format.h"
#include "ibrdf/io/problem_file.h"
#include "ibrdf/io/problem_json.h"

namespace ibrdf {
namespace {
using Strings = std::vector<std::string>;

constexpr char kSolve[] = "image: {file: a.exr}\ngeometry: {sphere: {}}\n";
constexpr char kRender[] =
    "image: {width: 8, height: 8}\ngeometry: {sphere: {}}\n";
constexpr char kTextures[] =
    "problem: textures\nviews: {transforms: t.json}\ngeometry: {sphere: "
    "{}}\n";

// A problem in which the key may stand: a text, and overrides of it.
struct Setting {
  std::string text;
  Strings overrides;

  StatusOr<Problem> Parse() const {
    return ParseProblem("p.yaml", text, overrides);
  }
  Setting With(const std::string& key, const std::string& value) const {
    Setting out = *this;
    out.overrides.push_back(key + "=" + value);
    return out;
  }
  // What result.json says of it; null where it is refused.
  nlohmann::json Json() const {
    const StatusOr<Problem> problem = Parse();
    return problem.ok() ? ProblemToJson(*problem) : nlohmann::json();
  }
  std::string Error() const {
    const StatusOr<Problem> problem = Parse();
    return problem.ok() ? "" : problem.status().message();
  }
};

Setting SettingOf(const ProblemKey& key) {
  Setting setting = {key.used_by & kUsedBySolve    ? kSolve
                     : key.used_by & kUsedByRender ? kRender
                                                   : kTextures,
                     {}};
  // Without another shape, light or material.
  const std::string map = key.Parent();
  if (map == "geometry" || map.find('.') != std::string::npos) {
    setting = setting.With(map, "{}");
  }
  if (map == "geometry.sphere") {  // neither goes without the other
    return setting.With("geometry.sphere", "{centre: [1, 2], radius: 3}");
  }
  if (key.path == "geometry.up") {  // of any shape with a place
    return setting.With("geometry", "{sphere: {}}");
  }
  if (map == "geometry.frame") {
    return setting.With("geometry", "{normals: n.exr}");
  }
  if (key.path == "images") {  // in place of the image's file
    return {"images: [a.exr]\ngeometry: {sphere: {}}\n", {}};
  }
  // They are of what such a file names.
  if (key.path == "views.images" || key.path == "views.masks") {
    return {"geometry: {mesh: m.obj}\nviews: {transforms: t.json}\n", {}};
  }
  // Paint lies over a material.
  if (map == "reflectance.known" && key.used_by == kUsedByRender) {
    setting = setting.With(map, "{lambertian: 0.5}");
  }
  const size_t colon = key.needs.find(": ");
  if (colon != std::string::npos) {
    return setting.With(key.needs.substr(0, colon),
                        key.needs.substr(colon + 2));
  }
  return key.needs.empty() ? setting : setting.With(key.needs, "m.obj");
}

double InsideOf(const Range& range) {
  if (std::isfinite(range.high)) {
    return range.low + 0.37 * (range.high - range.low);
  }
  return std::isfinite(range.low) ? range.low + 0.7 : 0.3;
}

// A value that the key may have and that is not its default.
std::string OtherValue(const ProblemKey& key) {
  switch (key.type) {
    case ValueType::kNumber:
    case ValueType::kAutoOrNumber:
    case ValueType::kOneOrTriple:
    case ValueType::kAutoOrTriple:
    case ValueType::kNumberOrPath:
    case ValueType::kTripleOrPath:
      return std::to_string(InsideOf(key.range));
    case ValueType::kInteger:
      return std::to_string(key.most);
    case ValueType::kTriple:
    case ValueType::kNumberList:
      return "[0.25, 0.5, 1]";
    case ValueType::kPathList:
      return "[one.file, other.file]";
    case ValueType::kPair:
    case ValueType::kOneOrPair:
      return "[0.25, 0.5]";
    case ValueType::kMatrix:
      return "[[0, 1, 0, 4], [0, 0, 1, 5], [1, 0, 0, 6], [0, 0, 0, 1]]";
    case ValueType::kListOrMap:
      return "[{name: left}]";
    case ValueType::kChoice:
    case ValueType::kChoiceOrMap:
      // The opposite, which leaves the other axes what they are.
      if (key.Parent() == "geometry.frame") {
        return key.Name() == "x" ? "left" : key.Name() == "y" ? "down" : "away";
      }
      return key.words.front().word == key.default_value
                 ? key.words.back().word
                 : key.words.front().word;
    case ValueType::kWordOrList:
      return "[" + key.list_words.front().word + "]";
    case ValueType::kPath:
    case ValueType::kText:
    case ValueType::kPathOrMap:
      return "other.file";
    case ValueType::kMap:
    case ValueType::kOptionalMap:
      break;
  }
  return "{}";
}

const std::vector<ProblemKey>& AllKeys() { return ProblemFileSchema().keys; }

TEST(ProblemSchema, ResponsesAreTheCurvesNamesInTheirOrder) {
  const ProblemKey& key = ProblemFileSchema().Key("image.response");
  int known = 0;
  for (size_t i = 0; i < key.words.size(); ++i) {
    const auto kind = KnownResponse(static_cast<ResponseChoice>(i));
    if (!kind.has_value()) continue;
    EXPECT_EQ(NameOf(*kind), key.words[i].word);
    ++known;
  }
  EXPECT_EQ(static_cast<int>(ResponseKind::kTable), known);
}

TEST(ProblemSchema, DefaultsAreWhatAnEmptyProblemYields) {
  for (const ProblemKey& key : AllKeys()) {
    if (key.default_value.empty()) continue;
    SCOPED_TRACE(key.path);
    const Setting setting = SettingOf(key);
    ASSERT_EQ("", setting.Error());
    EXPECT_EQ(setting.Json(), setting.With(key.path, key.default_value).Json());
  }
}

TEST(ProblemSchema, EveryKeyIsReadAndToldInTheResult) {
  for (const ProblemKey& key : AllKeys()) {
    // Maps at the top are read by their keys.
    if (key.type == ValueType::kMap && key.Parent().empty()) continue;
    SCOPED_TRACE(key.path + "=" + OtherValue(key));
    const Setting without = SettingOf(key);
    const Setting with = without.With(key.path, OtherValue(key));
    EXPECT_EQ("", with.Error());
    EXPECT_NE(without.Json(), with.Json());
  }
}

TEST(ProblemSchema, NoOtherKeyIsAccepted) {
  Strings maps = {""};
  for (const ProblemKey& key : AllKeys()) {
    if (key.type == ValueType::kMap || key.type == ValueType::kPathOrMap ||
        key.type == ValueType::kOptionalMap ||
        key.type == ValueType::kListOrMap) {
      maps.push_back(key.path);
    }
  }
  ASSERT_LT(10u, maps.size());
  for (const std::string& map : maps) {
    const std::string other = JoinPath(map, "zz");
    const Setting setting = {kSolve, {other + "=1"}};
    EXPECT_EQ(0u, setting.Error().find("p.yaml: " + other + ": unknown key"))
        << other;
  }
}

TEST(ProblemSchema, KeysAreRefusedWithoutWhatTheyNeed) {
  int count = 0;
  for (const ProblemKey& key : AllKeys()) {
    if (key.needs.empty()) continue;
    SCOPED_TRACE(key.path);
    Setting setting = {kSolve, {}};
    if (key.needs == "problem: joint")
      setting = {kSolve, {"problem=reflectance"}};
    if (key.needs == "illumination.prior: unet") {
      setting = {kSolve, {"illumination.prior=none"}};
    }
    EXPECT_EQ("p.yaml: " + key.path + ": expected with " + key.needs + " only",
              setting.With(key.path, OtherValue(key)).Error());
    ++count;
  }
  EXPECT_LT(5, count);
}

TEST(ProblemSchema, IntegersEndWhereItSays) {
  for (const ProblemKey& key : AllKeys()) {
    if (key.type != ValueType::kInteger) continue;
    SCOPED_TRACE(key.path);
    const auto error = [&](const std::string& value) {
      return SettingOf(key).With(key.path, value).Error();
    };
    const std::string beyond =
        std::to_string(static_cast<uint64_t>(key.most) + 1);
    EXPECT_EQ("", error(std::to_string(key.least)));
    EXPECT_EQ("", error(std::to_string(key.most)));
    EXPECT_NE("", error(std::to_string(key.least - 1)));
    EXPECT_NE("", error(beyond));
  }
}

TEST(ProblemSchema, NumbersEndWhereItSays) {
  for (const ProblemKey& key : AllKeys()) {
    if (key.type != ValueType::kNumber &&
        key.type != ValueType::kAutoOrNumber &&
        key.type != ValueType::kOneOrTriple &&
        key.type != ValueType::kAutoOrTriple &&
        key.type != ValueType::kNumberOrPath &&
        key.type != ValueType::kTripleOrPath) {
      continue;
    }
    const auto accepted = [&](double value) {
      const std::string text = Format("%.17g", value);
      return SettingOf(key).With(key.path, text).Error().empty();
    };
    SCOPED_TRACE(key.path);
    const Range& r = key.range;
    ASSERT_TRUE(std::isfinite(r.low));
    EXPECT_EQ(r.low_included, accepted(r.low));
    EXPECT_FALSE(accepted(r.low - 1e-9));
    EXPECT_TRUE(accepted(r.low + 1e-9));
    if (!std::isfinite(r.high)) continue;
    EXPECT_EQ(r.high_included, accepted(r.high));
    EXPECT_FALSE(accepted(r.high * (1.0 + 1e-9)));
    EXPECT_TRUE(accepted(r.high * (1.0 - 1e-9)));
  }
}

TEST(ProblemSchema, ChoicesTakeItsWords) {
  for (const ProblemKey& key : AllKeys()) {
    SCOPED_TRACE(key.path);
    // Words of one axis of the picture exclude each other.
    if (key.Parent() == "geometry.frame") continue;
    const Setting setting = SettingOf(key);
    for (const std::string& word : key.Words()) {
      const Setting with = setting.With(key.path, word);
      EXPECT_EQ("", with.Error());
      std::string pointer = "/" + key.path;
      std::replace(pointer.begin(), pointer.end(), '.', '/');
      // What `auto` stands for is told in its place.
      if (key.path == "illumination.prior" && word == "auto") continue;
      EXPECT_EQ(word, with.Json()[nlohmann::json::json_pointer(pointer)]);
    }
    for (const std::string& word : key.ListWords()) {
      EXPECT_EQ("", setting.With(key.path, "[" + word + "]").Error());
    }
    // Any other text of a path is a file's name.
    if (!key.words.empty() && key.type != ValueType::kPath) {
      EXPECT_NE("", setting.With(key.path, "zz").Error());
    }
  }
}

// What the parser takes is not written down a second time.
TEST(ProblemSchema, AnotherSchemaMakesAnotherParser) {
  ProblemSchema schema = ProblemFileSchema();
  for (ProblemKey& key : schema.keys) {
    if (key.path == "reflectance.lobes") key.most = 3;
    if (key.path == "noise") key.range.high = 0.5;
    if (key.path == "quality") key.words[0].word = "draft";
  }
  const auto error = [&](const std::string& override_text) {
    const StatusOr<Problem> problem =
        ParseProblem("p.yaml", kSolve, {override_text}, schema);
    return problem.ok() ? "" : problem.status().message();
  };
  EXPECT_EQ(
      "p.yaml: reflectance.lobes: expected a whole number in [1, 3], found '4'",
      error("reflectance.lobes=4"));
  EXPECT_EQ("p.yaml: noise: expected a number in [0, 0.5], found '0.6'",
            error("noise=0.6"));
  EXPECT_EQ("", error("quality=draft"));
  EXPECT_EQ("p.yaml: quality: expected draft or reference, found 'preview'",
            error("quality=preview"));
}

TEST(ProblemSchema, MeaningsAreShortCellsOfTables) {
  constexpr int kMaxWords = 30;
  const auto check = [&](const std::string& text) {
    std::istringstream stream(text);
    int words = 0;
    for (std::string word; stream >> word;) ++words;
    EXPECT_LE(words, kMaxWords) << text;
    EXPECT_LT(0, words);
    EXPECT_EQ(std::string::npos, text.find_first_of("|\n")) << text;
  };
  for (const ProblemKey& key : AllKeys()) {
    SCOPED_TRACE(key.path);
    check(key.meaning);
    for (const ProblemWord& word : key.words) check(word.meaning);
    for (const ProblemWord& word : key.list_words) check(word.meaning);
    for (const std::string& note : key.notes) check(note);
  }
}

}  // namespace
}  // namespace ibrdf
