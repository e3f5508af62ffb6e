#include "solvers/bench/solver_trace.h"

#include <gtest/gtest.h>

#include "tests/support/temp_dir.h"

namespace ibrdf {
namespace {

TEST(SolverTrace, TimeToAMisfitCountsMapsOnly) {
  const TempDir dir;
  WriteBytes(dir.File("result.json"), R"({"trace": [
      {"stage": "search", "seconds": 1, "scale": 0, "misfit": 0.01},
      {"stage": "coarse round 1", "seconds": 4, "scale": 0.2, "misfit": 0.3},
      {"stage": "full round 1", "seconds": 6, "scale": 0.1, "misfit": 0.2},
      {"stage": "end", "seconds": 8, "scale": 0.1, "misfit": 0.2}]})");
  const std::vector<TraceLine> trace =
      ReadTrace(dir.File("result.json")).value();
  ASSERT_EQ(4u, trace.size());
  EXPECT_EQ("end", trace[3].stage);
  EXPECT_EQ(2, CountRounds(trace));
  EXPECT_EQ(4.0, SecondsToMisfit(trace, 0.5).value());
  EXPECT_EQ(4.0, SecondsToMisfit(trace, 0.3).value());
  EXPECT_EQ(6.0, SecondsToMisfit(trace, 0.25).value());
  EXPECT_FALSE(SecondsToMisfit(trace, 0.1).has_value());
}

TEST(SolverTrace, MalformedFilesAreNamed) {
  const TempDir dir;
  const std::string file = dir.File("result.json");
  EXPECT_FALSE(ReadTrace(file).ok());
  for (
      const char* text :
      {"", "[]", "{}", R"({"trace": []})", R"({"trace": {}})",
       R"({"trace": [1]})",
       R"({"trace": [{"stage": "a", "seconds": 1, "misfit": null,
                       "scale": 1}]})",
       R"({"trace": [{"stage": 1, "seconds": 1, "misfit": 1, "scale": 1}]})"}) {
    WriteBytes(file, text);
    const auto trace = ReadTrace(file);
    ASSERT_FALSE(trace.ok()) << text;
    EXPECT_NE(std::string::npos, trace.status().message().find(file));
  }
}

}  // namespace
}  // namespace ibrdf
