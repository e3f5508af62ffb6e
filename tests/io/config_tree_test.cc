#include "ibrdf/io/config_tree.h"

#include <gtest/gtest.h>

#include <string>

namespace ibrdf {
namespace {

std::string ErrorOf(const std::string& text) {
  const StatusOr<ConfigNode> node = ParseConfig("f.yaml", text);
  return node.ok() ? "" : node.status().message();
}

bool Contains(const std::string& text, const std::string& part) {
  return text.find(part) != std::string::npos;
}

TEST(ConfigTree, KeepsOrderKindsAndLines) {
  const StatusOr<ConfigNode> root =
      ParseConfig("f", "a: 1\nb: [x, 'y', ~]\nc: {d: }\n");
  ASSERT_TRUE(root.ok()) << root.status().message();
  ASSERT_EQ(3u, root->entries.size());
  EXPECT_EQ("a", root->entries[0].first);
  EXPECT_EQ("1", root->Find("a")->scalar);
  const ConfigNode* b = root->Find("b");
  ASSERT_EQ(3u, b->items.size());
  EXPECT_FALSE(b->items[0].quoted);
  EXPECT_TRUE(b->items[1].quoted);
  EXPECT_EQ(ConfigNode::Kind::kNull, b->items[2].kind);
  EXPECT_EQ(2, b->line);
  EXPECT_EQ(ConfigNode::Kind::kNull, root->Find("c")->Find("d")->kind);
  EXPECT_EQ(nullptr, root->Find("d"));
}

TEST(ConfigTree, RefusesDuplicatesAliasesTagsAndDocuments) {
  EXPECT_TRUE(Contains(ErrorOf("a: 1\nb: 2\na: 3\n"),
                       "f.yaml: line 3: duplicate key 'a'"));
  EXPECT_TRUE(Contains(ErrorOf("a: {b: 1, b: 2}"), "duplicate key 'b'"));
  EXPECT_EQ("", ErrorOf(std::string(200, 'k') + ": 1"));
  EXPECT_TRUE(Contains(ErrorOf(std::string(201, 'k') + ": 1"), "200 bytes"));
  EXPECT_TRUE(Contains(ErrorOf("a: &x 1\nb: *x\n"), "anchors"));
  EXPECT_TRUE(Contains(ErrorOf("a: &x [1]\n"), "anchors"));
  EXPECT_TRUE(Contains(ErrorOf("b: *x\n"), "f.yaml: line 1"));
  EXPECT_TRUE(Contains(ErrorOf("a: !!int 3\n"), "tags"));
  EXPECT_TRUE(Contains(ErrorOf("a: 1\n---\nb: 2\n"), "one YAML document"));
  EXPECT_TRUE(Contains(ErrorOf("[1, 2]: 3\n"), "word as key"));
}

TEST(ConfigTree, RefusesWhatIsNotYaml) {
  EXPECT_TRUE(Contains(ErrorOf("a: [1, 2\n"), "f.yaml: line"));
  EXPECT_TRUE(Contains(ErrorOf("a: }\n"), "f.yaml: line"));
  EXPECT_TRUE(Contains(ErrorOf(std::string("a: \0b", 5)), "zero byte"));
  EXPECT_NE("", ErrorOf(std::string(200000, '[')));
  std::string nested;
  for (int i = 0; i < 40; ++i) nested += "- ";
  EXPECT_TRUE(Contains(ErrorOf(nested + "a"), "levels deep"));
  EXPECT_TRUE(Contains(ErrorOf(std::string((1 << 20) + 1, 'a')), "1 MiB"));
}

TEST(ConfigTree, OverridesReplaceCreateAndRemove) {
  ConfigNode root = ParseConfig("f", "a: {b: 1, c: 2}\nd: 3\n").value();
  ASSERT_TRUE(ApplyOverride("a.b=[5, 6]", &root).ok());
  EXPECT_EQ(2u, root.Find("a")->Find("b")->items.size());
  ASSERT_TRUE(ApplyOverride("x.y.z=a=b", &root).ok());
  EXPECT_EQ("a=b", root.Find("x")->Find("y")->Find("z")->scalar);
  ASSERT_TRUE(ApplyOverride("d.e=1", &root).ok());
  EXPECT_EQ("1", root.Find("d")->Find("e")->scalar);
  ASSERT_TRUE(ApplyOverride("a.c=", &root).ok());
  EXPECT_EQ(nullptr, root.Find("a")->Find("c"));
  for (const char* bad : {"a", "=1", "a..b=1", ".a=1", "a.=1", "a=[1"}) {
    EXPECT_EQ(StatusCode::kInvalidInput, ApplyOverride(bad, &root).code())
        << bad;
  }
}

}  // namespace
}  // namespace ibrdf
