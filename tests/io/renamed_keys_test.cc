#include "ibrdf/io/renamed_keys.h"

#include <glog/logging.h>
#include <gtest/gtest.h>

#include <string>
#include <vector>

#include "ibrdf/io/problem_file.h"
#include "ibrdf/io/problem_json.h"

namespace ibrdf {
namespace {

constexpr char kLeast[] = "image: {file: a.exr}\ngeometry: {sphere: {}}\n";

// Warnings while it lives.
class Warnings : public google::LogSink {
 public:
  Warnings() { google::AddLogSink(this); }
  ~Warnings() override { google::RemoveLogSink(this); }
  void send(google::LogSeverity severity, const char*, const char*, int,
            const google::LogMessageTime&, const char* message,
            size_t length) override {
    if (severity == google::GLOG_WARNING) texts.emplace_back(message, length);
  }

  std::vector<std::string> texts;
};

// The schema as if a key and a map had been renamed.
ProblemSchema RenamedSchema() {
  ProblemSchema schema = ProblemFileSchema();
  for (ProblemKey& key : schema.keys) {
    if (key.path == "solver") key.old_name = "optimiser";
    if (key.path == "solver.seconds") key.old_name = "time_limit";
  }
  return schema;
}

StatusOr<Problem> Parse(const std::string& more,
                        const std::vector<std::string>& overrides = {}) {
  return ParseProblem("p.yaml", kLeast + more, overrides, RenamedSchema());
}

TEST(RenamedKeys, NoKeyIsRenamedNow) {
  for (const ProblemKey& key : ProblemFileSchema().keys) {
    EXPECT_EQ("", key.old_name) << key.path;
  }
}

TEST(RenamedKeys, FormerNamesAreReadWithAWarning) {
  Warnings warnings;
  const StatusOr<Problem> problem = Parse("solver: {time_limit: 7}");
  ASSERT_TRUE(problem.ok()) << problem.status().message();
  EXPECT_EQ(7.0, problem->solver.seconds);
  const std::vector<std::string> expected = {
      "p.yaml: solver.time_limit has been renamed, please write "
      "solver.seconds"};
  EXPECT_EQ(expected, warnings.texts);
}

TEST(RenamedKeys, ResultsHaveTheNewName) {
  const nlohmann::json solver =
      ProblemToJson(*Parse("solver: {time_limit: 7}"))["solver"];
  EXPECT_EQ(7.0, solver["seconds"]);
  EXPECT_EQ(0u, solver.count("time_limit"));
}

TEST(RenamedKeys, KeysOfARenamedMapAreFound) {
  Warnings warnings;
  const StatusOr<Problem> problem =
      Parse("optimiser: {time_limit: 7, tolerance: 0.5}");
  ASSERT_TRUE(problem.ok()) << problem.status().message();
  EXPECT_EQ(7.0, problem->solver.seconds);
  EXPECT_EQ(0.5, problem->solver.tolerance);
  ASSERT_EQ(2u, warnings.texts.size());
  EXPECT_EQ("p.yaml: optimiser has been renamed, please write solver",
            warnings.texts[0]);
}

TEST(RenamedKeys, OverridesHaveThemToo) {
  for (const std::string override_text :
       {"solver.time_limit=7", "optimiser.seconds=7", "optimiser.time_limit=7",
        "solver={time_limit: 7}", "optimiser={time_limit: 7}"}) {
    Warnings warnings;
    const StatusOr<Problem> problem =
        Parse("solver: {seconds: 5}", {override_text});
    ASSERT_TRUE(problem.ok()) << problem.status().message();
    EXPECT_EQ(7.0, problem->solver.seconds) << override_text;
    ASSERT_FALSE(warnings.texts.empty()) << override_text;
    EXPECT_EQ(0u, warnings.texts[0].find("p.yaml: ")) << override_text;
  }
  // A key under its former name is overridden under the new one, and taken out.
  EXPECT_EQ(
      7.0,
      Parse("solver: {time_limit: 5}", {"solver.seconds=7"})->solver.seconds);
  EXPECT_EQ(120.0, Parse("solver: {seconds: 5}", {"solver.time_limit=null"})
                       ->solver.seconds);
}

TEST(RenamedKeys, BothNamesAreRefused) {
  EXPECT_EQ(
      "p.yaml: solver.seconds: expected once, found also under its former name "
      "solver.time_limit",
      Parse("solver: {time_limit: 7, seconds: 8}").status().message());
}

TEST(RenamedKeys, NothingElseIsRenamed) {
  Warnings warnings;
  // "time_limits" begins like a former name.
  EXPECT_NE(std::string::npos, Parse("", {"solver.time_limits=7"})
                                   .status()
                                   .message()
                                   .find("solver.time_limits: unknown key"));
  EXPECT_NE(std::string::npos, Parse("time_limit: 7")
                                   .status()
                                   .message()
                                   .find("time_limit: unknown key"));
  // What is no map is told as ever.
  EXPECT_NE(std::string::npos, Parse("solver: [1]")
                                   .status()
                                   .message()
                                   .find("solver: expected a map of"));
  EXPECT_TRUE(warnings.texts.empty());
}

}  // namespace
}  // namespace ibrdf
