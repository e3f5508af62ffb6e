#include "ibrdf/io/problem_reference.h"

#include <gtest/gtest.h>

#include <string>
#include <vector>

#include "ibrdf/io/problem_file.h"
#include "ibrdf/io/problem_json.h"
#include "tests/support/temp_dir.h"

namespace ibrdf {
namespace {

TEST(ProblemReference, IsTheCommittedPage) {
  const std::string page =
      ReadBytes(std::string(IBRDF_SOURCE_DIR) + "/docs/problem_file.md");
  EXPECT_TRUE(page == ProblemReference(ProblemFileSchema()))
      << "docs/problem_file.md is not what io/problem_*_keys.cc say. Write it "
         "anew: build/release/bin/ibrdf_solve --keys > docs/problem_file.md";
}

TEST(ProblemReference, ExampleIsAProblemAtTheDefaults) {
  const StatusOr<Problem> example =
      ParseProblem("p.yaml", ExampleProblem(ProblemFileSchema()), {});
  ASSERT_TRUE(example.ok()) << example.status().message();
  EXPECT_TRUE(CheckSolvable(*example).ok());
  // The same files, and nothing else.
  std::vector<std::string> files;
  for (const ProblemKey& key : ProblemFileSchema().keys) {
    if (!key.example.empty()) files.push_back(key.path + "=" + key.example);
  }
  const StatusOr<Problem> least = ParseProblem("p.yaml", "", files);
  ASSERT_TRUE(least.ok()) << least.status().message();
  EXPECT_EQ(ProblemToJson(*least), ProblemToJson(*example));
}

TEST(ProblemReference, ExampleOfASceneCanBeRendered) {
  const StatusOr<Problem> scene = ParseProblem("p.yaml", ExampleScene(), {});
  ASSERT_TRUE(scene.ok()) << scene.status().message();
  EXPECT_TRUE(CheckRenderable(*scene).ok());
}

TEST(ProblemReference, EveryKeyAndWordIsInIt) {
  const ProblemSchema& schema = ProblemFileSchema();
  const std::string page = ProblemReference(schema);
  const auto has_row = [&](const std::string& name) {
    return page.find("\n| `" + name + "` | ") != std::string::npos;
  };
  for (const ProblemKey& key : schema.keys) {
    const bool section =
        page.find("\n## " + key.path + "\n") != std::string::npos;
    EXPECT_EQ(section, key.Parent().empty()) << key.path;
    EXPECT_TRUE(section || has_row(key.path)) << key.path;
    for (const std::string& word : key.Words()) {
      EXPECT_TRUE(has_row(word)) << key.path << ": " << word;
    }
    for (const std::string& word : key.ListWords()) {
      EXPECT_TRUE(has_row(word)) << key.path << ": " << word;
    }
  }
}

TEST(ProblemReference, FormerNamesHaveATable) {
  ProblemSchema schema = ProblemFileSchema();
  EXPECT_EQ(std::string::npos, ProblemReference(schema).find("## Former"));
  for (ProblemKey& key : schema.keys) {
    if (key.path == "solver.seconds") key.old_name = "time_limit";
  }
  EXPECT_NE(std::string::npos,
            ProblemReference(schema).find(
                "| `solver.time_limit` | `solver.seconds` |"));
}

}  // namespace
}  // namespace ibrdf
