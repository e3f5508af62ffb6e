#include "ibrdf/solvers/bench/solver_trace.h"

#include <gtest/gtest.h>

#include "tests/support/temp_dir.h"

namespace ibrdf {
namespace {

TEST(SolverTrace, TimeToAMisfitCountsMapsOnly) {
  const TempDir dir;
  WriteBytes(dir.File("result.json"), R"({"trace": [
      {"stage": "search", "seconds": 1, "scale": 0, "pixels": 9,
       "misfit": 0.01},
      {"stage": "coarse iteration 1", "seconds": 4, "scale": 0.2, "pixels": 4,
       "misfit": 0.3},
      {"stage": "full iteration 1", "seconds": 6, "scale": 0.1, "pixels": 4,
       "misfit": 0.2},
      {"stage": "end", "seconds": 8, "scale": 0.1, "pixels": 9,
       "misfit": 0.25}]})");
  const std::vector<TraceLine> trace =
      ReadTrace(dir.File("result.json")).value();
  ASSERT_EQ(4u, trace.size());
  EXPECT_EQ("end", trace[3].stage);
  EXPECT_EQ(2, CountIterations(trace));
  EXPECT_EQ("full iteration 1", LastIteration(trace)->stage);
  EXPECT_EQ(nullptr, LastIteration({trace[0], trace[3]}));
  const auto seconds_to = [&](double misfit, int64_t pixels) {
    TraceLine of;
    of.misfit = misfit;
    of.pixels = pixels;
    return SecondsToMisfit(trace, of);
  };
  EXPECT_EQ(4.0, seconds_to(0.5, 4).value());
  EXPECT_EQ(4.0, seconds_to(0.3, 4).value());
  EXPECT_EQ(6.0, seconds_to(0.25, 4).value());
  EXPECT_EQ(8.0, seconds_to(0.25, 9).value());
  EXPECT_FALSE(seconds_to(0.1, 4).has_value());
  EXPECT_FALSE(seconds_to(0.5, 5).has_value());
}

TEST(SolverTrace, MalformedFilesAreNamed) {
  const TempDir dir;
  const std::string file = dir.File("result.json");
  EXPECT_FALSE(ReadTrace(file).ok());
  for (const char* text :
       {"", "[]", "{}", R"({"trace": []})", R"({"trace": {}})",
        R"({"trace": [1]})",
        R"({"trace": [{"stage": "a", "seconds": 1, "misfit": null,
                       "scale": 1, "pixels": 4}]})",
        R"({"trace": [{"stage": "a", "seconds": 1, "misfit": 1,
                       "scale": 1}]})",
        R"({"trace": [{"stage": 1, "seconds": 1, "misfit": 1, "scale": 1,
                       "pixels": 4}]})"}) {
    WriteBytes(file, text);
    const auto trace = ReadTrace(file);
    ASSERT_FALSE(trace.ok()) << text;
    EXPECT_NE(std::string::npos, trace.status().message().find(file));
  }
}

}  // namespace
}  // namespace ibrdf
