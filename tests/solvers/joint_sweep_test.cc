#include "solvers/bench/joint_sweep.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <filesystem>

#include "ibrdf/brdf/cook_torrance.h"
#include "io/exr.h"
#include "io/merl.h"
#include "solvers/bench/child_process.h"
#include "solvers/bench/results_table.h"
#include "tests/render/render_testing.h"
#include "tests/support/temp_dir.h"

namespace ibrdf {
namespace {

// A program in place of the solver: counts its calls in DIR/calls, writes
// result.json and exits with `exit_code`.
void WriteFakeSolver(const TempDir& dir, const std::string& json,
                     int exit_code) {
  WriteBytes(
      dir.File("solver"),
      "#!/bin/sh\n"
      "echo call >> '" +
          dir.File("calls") +
          "'\n"
          "while [ $# -gt 0 ]; do [ \"$1\" = --out ] && out=$2; shift; done\n"
          "echo '" +
          json +
          "' > \"$out/result.json\"\n"
          "exit " +
          std::to_string(exit_code) + "\n");
  std::filesystem::permissions(dir.File("solver"),
                               std::filesystem::perms::owner_all);
}

size_t Calls(const TempDir& dir) {
  return std::filesystem::exists(dir.File("calls"))
             ? ReadBytes(dir.File("calls")).size() / 5
             : 0;
}

class JointSweepTest : public ::testing::Test {
 protected:
  JointSweepTest() {
    std::filesystem::create_directories(dir_.File("data"));
    std::filesystem::create_directories(dir_.File("maps"));
    const MerlTable table = SampleMerl(testing::Glossy(0.3, 0.5, 15.0));
    CHECK(WriteMerl(table, dir_.File("data/paint.binary")).ok());
    for (const char* name : {"a", "b", "c"}) {
      CHECK(WriteExr(testing::SmoothMap(8, 16),
                     dir_.File(std::string("maps/") + name + ".exr"))
                .ok());
    }
    options_.data = dir_.File("data");
    options_.maps = dir_.File("maps");
    options_.out = dir_.File("out");
    options_.size = 8;
    options_.solver_program = dir_.File("solver");
    options_.command = "the command";
    WriteFakeSolver(dir_, R"({"metrics": {"misfit": 0.25,
        "brdf_log_rmse": null, "seconds": 9}})",
                    0);
  }
  std::vector<ResultsRow> Rows() const {
    return ReadResults(options_.out + "/results.csv", JointColumns()).value();
  }
  static std::string Cell(const ResultsRow& row, const std::string& column) {
    const auto& columns = JointColumns();
    return row[std::find(columns.begin(), columns.end(), column) -
               columns.begin()];
  }

  const TempDir dir_;
  JointSweepOptions options_;
};

TEST_F(JointSweepTest, WritesRowsAndResumes) {
  options_.map_names = {"b"};
  ASSERT_TRUE(RunJointSweep(options_).ok());
  ASSERT_EQ(1u, Rows().size());
  const ResultsRow row = Rows()[0];
  EXPECT_EQ("paint", Cell(row, "material"));
  EXPECT_EQ("b", Cell(row, "map"));
  EXPECT_EQ("sphere", Cell(row, "geometry"));
  EXPECT_EQ("0.25", Cell(row, "misfit"));
  EXPECT_EQ("", Cell(row, "brdf_log_rmse"));
  EXPECT_EQ("ok", Cell(row, "status"));
  EXPECT_LT(0.0, std::stod(Cell(row, "peak_mb")));
  EXPECT_LT(0.0, std::stod(Cell(row, "constant_map_relative_log_rmse")));
  EXPECT_LT(std::stod(Cell(row, "cook_torrance_misfit")), 1.0);
  const std::string folder = options_.out + "/cases/paint_b/";
  for (const char* file : {"input.exr", "mask.png", "joint.yaml"}) {
    EXPECT_TRUE(std::filesystem::exists(folder + file)) << file;
  }
  EXPECT_NE(std::string::npos,
            ReadBytes(options_.out + "/results.md").find("the command"));
  // A case in the table is not run again; one that a kill cut is.
  ASSERT_TRUE(RunJointSweep(options_).ok());
  EXPECT_EQ(1u, Calls(dir_));
  const std::string csv = ReadBytes(options_.out + "/results.csv");
  WriteBytes(options_.out + "/results.csv", csv.substr(0, csv.size() - 3));
  ASSERT_TRUE(RunJointSweep(options_).ok());
  EXPECT_EQ(2u, Calls(dir_));
  EXPECT_EQ(1u, Rows().size());
}

TEST_F(JointSweepTest, FailuresGoToStatusAndInterruptsEndTheSweep) {
  options_.map_names = {"a"};
  WriteFakeSolver(dir_, "{", 3);
  ASSERT_TRUE(RunJointSweep(options_).ok());
  EXPECT_EQ("no_result", Cell(Rows()[0], "status"));
  WriteFakeSolver(dir_, "{}", 2);
  options_.map_names = {"b"};
  ASSERT_TRUE(RunJointSweep(options_).ok());
  EXPECT_EQ("bad_input", Cell(Rows()[1], "status"));
  WriteFakeSolver(dir_, "{}", 130);
  options_.map_names = {"c"};
  EXPECT_EQ(StatusCode::kInterrupted, RunJointSweep(options_).code());
  EXPECT_EQ(2u, Rows().size());
}

TEST_F(JointSweepTest, ListsCases) {
  EXPECT_EQ(3u, ListJointCases(options_).value().size());
  options_.only_index = 2;
  options_.only_count = 2;
  ASSERT_EQ(1u, ListJointCases(options_).value().size());
  EXPECT_EQ("paint_b", ListJointCases(options_).value()[0].name);
  options_.materials = {"gold"};
  EXPECT_NE(std::string::npos,
            ListJointCases(options_).status().message().find("gold.binary"));
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

}  // namespace
}  // namespace ibrdf
