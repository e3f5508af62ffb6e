#include "ibrdf/solvers/bench/joint_sweep.h"

#include <gtest/gtest.h>
#include <signal.h>
#include <sys/wait.h>
#include <unistd.h>

#include <filesystem>
#include <fstream>
#include <functional>
#include <string>

#include "ibrdf/solvers/bench/child_process.h"
#include "tests/bench/sweep_testing.h"

namespace ibrdf {
namespace {

class JointSweepTest : public testing::SweepTest {
 protected:
  JointSweepTest() {
    Apply(&options_);
    Image estimate =
        ResizeMap(testing::SmoothMap(8, 16), kSweepMapHeight, kSweepMapWidth);
    for (float& v : estimate.rgb) v *= 3.0f;
    CHECK(
        WriteMap(estimate, MapFrame::kCamera, dir_.File("estimate.exr")).ok());
  }
  Status Run() const { return SweepTest::Run(options_, JointSweep(options_)); }
  std::vector<ResultsRow> Rows() const {
    return SweepTest::Rows(JointColumns());
  }
  static std::string Cell(const ResultsRow& row, const std::string& column) {
    return SweepTest::Cell(JointColumns(), row, column);
  }

  JointSweepOptions options_;
};

TEST_F(JointSweepTest, WritesRowsAndResumes) {
  options_.map_names = {"b"};
  ASSERT_TRUE(Run().ok());
  ASSERT_EQ(1u, Rows().size());
  const ResultsRow row = Rows()[0];
  EXPECT_EQ("paint", Cell(row, "material"));
  EXPECT_EQ("b", Cell(row, "map"));
  EXPECT_EQ("sphere", Cell(row, "geometry"));
  EXPECT_EQ("default", Cell(row, "model"));
  EXPECT_EQ("0.25", Cell(row, "misfit"));
  EXPECT_EQ("", Cell(row, "brdf_log_rmse"));
  EXPECT_EQ("0.375", Cell(row, "brdf_log_rmse_expected"));
  EXPECT_EQ("", Cell(row, "brdf_log_rmse_90"));
  EXPECT_EQ("ok", Cell(row, "status"));
  EXPECT_LT(0.0, std::stod(Cell(row, "peak_mb")));
  EXPECT_LT(0.0, std::stod(Cell(row, "cpu_seconds")));
  EXPECT_LT(0.0, std::stod(Cell(row, "constant_map_relative_log_rmse")));
  EXPECT_LT(std::stod(Cell(row, "cook_torrance_misfit")), 1.0);
  // The true map and table but for the scale.
  EXPECT_NEAR(0.0, std::stod(Cell(row, "mirror_log_rmse")), 1e-4);
  EXPECT_NEAR(0.0, std::stod(Cell(row, "relit_log_rmse")), 1e-4);
  EXPECT_NEAR(0.0, std::stod(Cell(row, "relit_dssim")), 1e-4);
  const std::string folder = options_.out + "/cases/paint_b/";
  for (const char* file : {"input.exr", "mask.png", "joint_process.yaml"}) {
    EXPECT_TRUE(std::filesystem::exists(folder + file)) << file;
  }
  EXPECT_NE(std::string::npos,
            ReadBytes(options_.out + "/results.md").find("the command"));
  // A case in the table is not run again; one that a kill cut is.
  ASSERT_TRUE(Run().ok());
  EXPECT_EQ(1u, Calls());
  CutResults();
  ASSERT_TRUE(Run().ok());
  EXPECT_EQ(2u, Calls());
  EXPECT_EQ(1u, Rows().size());
}

TEST_F(JointSweepTest, RunsEachCaseWithEachPrior) {
  options_.map_names = {"a", "b"};
  options_.priors = {"process", "none"};
  const std::vector<SolverRun> runs = JointSweep(options_).value().runs;
  ASSERT_EQ(4u, runs.size());
  EXPECT_EQ("paint_a", runs[1].of.name);
  EXPECT_EQ("joint_none.yaml", runs[1].problem_name);
  EXPECT_NE(std::string::npos, runs[1].problem.find("prior: none}"));
  EXPECT_EQ("estimate_none_2_auto", runs[1].estimate);
  EXPECT_EQ("process", Cell(runs[2].row.cells(), "prior"));
  EXPECT_EQ("estimate_process_2_auto", runs[2].estimate);
}

TEST_F(JointSweepTest, FailuresGoToStatusAndInterruptsEndTheSweep) {
  options_.map_names = {"a"};
  WriteSolver("{", 3);
  ASSERT_TRUE(Run().ok());
  EXPECT_EQ("no_result", Cell(Rows()[0], "status"));
  WriteSolver("{}", 2);
  options_.map_names = {"b"};
  ASSERT_TRUE(Run().ok());
  EXPECT_EQ("bad_input", Cell(Rows()[1], "status"));
  WriteSolver("{}", 130);
  options_.map_names = {"c"};
  EXPECT_EQ(StatusCode::kInterrupted, Run().code());
  EXPECT_EQ(2u, Rows().size());
}

// Faults of the machine, not of the case: no row, so that the same command
// runs it again.
TEST_F(JointSweepTest, FilesThatGoOrCannotBeWrittenEndTheSweep) {
  options_.map_names = {"a", "b"};
  const std::string map = dir_.File("maps/b.exr");
  const std::string gone = "rm -f '" + map + "'; ";
  const auto expect_stopped = [&](const std::string& words, size_t rows) {
    const Status status = Run();
    EXPECT_EQ(StatusCode::kInvalidInput, status.code());
    for (const std::string& word : {words, std::string("has no row")}) {
      EXPECT_NE(std::string::npos, status.message().find(word))
          << status.message();
    }
    EXPECT_EQ(rows, Rows().size());
  };
  const std::string kept = ReadBytes(map);
  // Between the cases: the first one's row stays.
  WriteSolver("{\"metrics\": {}}", 0,
              "case $out in *paint_b*) " + gone + "echo 'error: " + map +
                  ": cannot open'; exit 2;; esac");
  expect_stopped(map, 1);
  WriteBytes(map, kept);
  // After the solve, before the baselines.
  WriteSolver("{\"metrics\": {}}", 0, gone);
  expect_stopped(map, 1);
  WriteBytes(map, kept);
  WriteSolver("{}", 2, "echo \"error: $out/brdf.binary: cannot write\"");
  expect_stopped("brdf.binary", 1);
  WriteSolver("{}", 2, "");  // not even the log
  expect_stopped("solver.log", 1);
  WriteSolver("{\"metrics\": {}}", 0);
  ASSERT_TRUE(Run().ok());
  ASSERT_EQ(2u, Rows().size());
  EXPECT_EQ("ok", Cell(Rows()[1], "status"));
}

// Rows do not say what they were made with.
TEST_F(JointSweepTest, OtherSettingsDoNotResumeASweep) {
  options_.map_names = {"a"};
  ASSERT_TRUE(Run().ok());
  const auto expect_refused = [&](const std::string& setting) {
    options_.map_names = {"a", "b"};
    const Status s = Run();
    EXPECT_EQ(StatusCode::kInvalidInput, s.code()) << setting;
    EXPECT_NE(std::string::npos, s.message().find("settings.json: " + setting))
        << s.message();
    Apply(&options_);
  };
  options_.size = 9;
  expect_refused("size");
  options_.noise *= 2.0;
  expect_refused("noise");
  options_.noise /= 2.0;
  ++options_.seed;
  expect_refused("seed");
  --options_.seed;
  options_.solver_seconds += 1.0;
  expect_refused("budget_seconds");
  options_.solver_seconds -= 1.0;
  EXPECT_EQ(1u, Calls());
  ASSERT_TRUE(Run().ok());
  EXPECT_EQ(2u, Calls());
}

TEST_F(JointSweepTest, ListsCases) {
  EXPECT_EQ(3u, JointSweep(options_).value().runs.size());
  options_.only_index = 2;
  options_.only_count = 2;
  ASSERT_EQ(1u, JointSweep(options_).value().runs.size());
  EXPECT_EQ("paint_b", JointSweep(options_).value().runs[0].of.name);
  options_.materials = {"gold"};
  EXPECT_NE(std::string::npos,
            JointSweep(options_).status().message().find("gold.binary"));
}

TEST_F(JointSweepTest, MalformedFoldersAreNamed) {
  options_.map_names = {"a"};
  WriteBytes(dir_.File("data/paint.binary"), "too short");
  EXPECT_NE(std::string::npos, Run().message().find("paint.binary"));
  EXPECT_EQ(0u, Calls());
  options_.maps = dir_.File("nowhere");
  options_.map_names = {};
  EXPECT_NE(std::string::npos, Run().message().find("nowhere"));
  options_.maps = dir_.File("data");  // holds none
  EXPECT_NE(std::string::npos, Run().message().find(options_.maps));
  options_.maps = dir_.File("maps");
  options_.solver_program = dir_.File("none");
  EXPECT_EQ(StatusCode::kInvalidInput, Run().code());
  options_.solver_program = dir_.File("solver");
  options_.models = dir_.File("data");  // holds none
  EXPECT_NE(std::string::npos, Run().message().find(".ibrdf"));
}

TEST(RunChild, SignalsAndMissingPrograms) {
  const TempDir dir;
  const ChildResult killed =
      RunChild({"/bin/sh", "-c", "kill -9 $$"}, dir.File("log"), nullptr)
          .value();
  EXPECT_EQ(9, killed.signal);
  EXPECT_EQ(
      127,
      RunChild({dir.File("none")}, dir.File("log"), nullptr).value().exit_code);
}

#if defined(__linux__)
TEST(RunChild, DoesNotOutliveAKilledParent) {
  const TempDir dir;
  const std::string number = dir.File("number");
  const pid_t parent = ::fork();
  if (parent == 0) {
    static_cast<void>(
        RunChild({"/bin/sh", "-c",
                  "echo $$ > '" + number + ".new'; mv '" + number + ".new' '" +
                      number + "'; exec sleep 60"},
                 dir.File("log"), nullptr));
    ::_exit(0);
  }
  const auto wait_for = [](const std::function<bool()>& condition) {
    for (int i = 0; i < 500 && !condition(); ++i) ::usleep(20000);
    return condition();
  };
  ASSERT_TRUE(wait_for([&] { return std::filesystem::exists(number); }));
  const pid_t child = std::stoi(ReadBytes(number));
  ASSERT_EQ(0, ::kill(child, 0));
  ::kill(parent, SIGKILL);
  int status = 0;
  ::waitpid(parent, &status, 0);
  // Gone, or dead and not yet waited for by whom it was left to.
  EXPECT_TRUE(wait_for([&] {
    std::ifstream stat("/proc/" + std::to_string(child) + "/stat");
    std::string pid, name, state;
    return !(stat >> pid >> name >> state) || state == "Z";
  }));
}
#endif

}  // namespace
}  // namespace ibrdf
