#include "ibrdf/io/config_text.h"

#include <gtest/gtest.h>

#include <string>

namespace ibrdf {
namespace {

bool SameTree(const ConfigNode& a, const ConfigNode& b) {
  if (a.kind != b.kind || a.scalar != b.scalar ||
      a.items.size() != b.items.size() ||
      a.entries.size() != b.entries.size()) {
    return false;
  }
  for (size_t i = 0; i < a.items.size(); ++i) {
    if (!SameTree(a.items[i], b.items[i])) return false;
  }
  for (size_t i = 0; i < a.entries.size(); ++i) {
    if (a.entries[i].first != b.entries[i].first ||
        !SameTree(a.entries[i].second, b.entries[i].second)) {
      return false;
    }
  }
  return true;
}

void ExpectRoundTrip(const ConfigNode& tree) {
  const std::string text = ConfigText(tree);
  const StatusOr<ConfigNode> back = ParseConfig("f", text);
  ASSERT_TRUE(back.ok()) << back.status().message() << "\n" << text;
  EXPECT_TRUE(SameTree(tree, *back)) << text;
}

TEST(ConfigText, ReadsBackAsTheSameTree) {
  const StatusOr<ConfigNode> tree = ParseConfig(
      "f",
      "a: 1\nb: [x, 'y z', ~, -1.5e-3, .5]\nc: {d: {}, e: {f: no, g: '5'}}\n"
      "h: null\ni: []\nj: true\n");
  ASSERT_TRUE(tree.ok());
  ExpectRoundTrip(*tree);
  ConfigNode nothing;
  nothing.kind = ConfigNode::Kind::kMap;
  ExpectRoundTrip(nothing);
}

TEST(ConfigText, AnyTextComesBack) {
  for (const std::string value :
       {"a b",        "#1.exr",
        "x # y",      "it's",
        "say \"hi\"", "a: b",
        "{a: 1}",     "[1, 2]",
        "*x",         "&x",
        "!x",         "- x",
        "%x",         "@x",
        "`x`",        "|",
        ">",          "~",
        "null",       "true",
        "12",         " 12 ",
        "\\n",        "C:\\x",
        "tab\there",  "new\nline",
        "\x01",       "caf\xc3\xa9/\xe5\x86\x99\xe7\x9c\x9f.exr",
        "---",        "...",
        "?"}) {
    ConfigNode root, leaf;
    root.kind = ConfigNode::Kind::kMap;
    leaf.kind = ConfigNode::Kind::kScalar;
    leaf.scalar = value;
    leaf.quoted = true;
    root.entries.emplace_back("key", leaf);
    ExpectRoundTrip(root);
  }
}

TEST(ConfigText, KeepsQuotesOfNumbers) {
  const StatusOr<ConfigNode> tree = ParseConfig("f", "a: '5'\nb: 5\n");
  ASSERT_TRUE(tree.ok());
  const StatusOr<ConfigNode> back = ParseConfig("f", ConfigText(*tree));
  ASSERT_TRUE(back.ok());
  EXPECT_TRUE(back->Find("a")->quoted);
  EXPECT_FALSE(back->Find("b")->quoted);
}

TEST(ConfigText, Utf8) {
  for (const std::string good :
       {"", "abc", "caf\xc3\xa9", "\xe5\x86\x99", "\xf0\x9f\x98\x80"}) {
    EXPECT_TRUE(IsUtf8(good)) << good;
  }
  for (const std::string bad :
       {"\xff", "\xc3", "a\x80", "\xc0\xaf", "\xe0\x80\xaf", "\xed\xa0\x80",
        "\xf4\x90\x80\x80", "\xe5\x86"}) {
    EXPECT_FALSE(IsUtf8(bad)) << bad;
  }
}

}  // namespace
}  // namespace ibrdf
