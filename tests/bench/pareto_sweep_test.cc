#include "ibrdf/solvers/bench/pareto_sweep.h"

#include <filesystem>
#include <map>
#include <set>

#include "ibrdf/io/problem_file.h"
#include "ibrdf/solvers/bench/pareto_settings.h"
#include "tests/bench/sweep_testing.h"

namespace ibrdf {
namespace {

class ParetoSweepTest : public testing::SweepTest {
 protected:
  ParetoSweepTest() {
    Apply(&options_);
    options_.map_names = {"a"};
    Image map =
        ResizeMap(testing::SmoothMap(8, 16), kSweepMapHeight, kSweepMapWidth);
    CHECK(WriteMap(map, MapFrame::kCamera, dir_.File("estimate.exr")).ok());
    Solve(0.25, 2);
  }
  // The stand-in comes to this misfit of joined pixels after `seconds`, and
  // ends ten later.
  void Solve(double misfit, double seconds) {
    const auto line = [](const char* stage, double at, int pixels, double m) {
      return std::string(R"({"stage": ")") + stage + R"(", "seconds": )" +
             std::to_string(at) + R"(, "scale": 1, "pixels": )" +
             std::to_string(pixels) + R"(, "misfit": )" + std::to_string(m) +
             "}";
    };
    WriteSolver(R"({"metrics": {"misfit": )" + std::to_string(misfit) +
                    R"(, "illumination_relative_log_rmse": 0.5}, "trace": [)" +
                    line("coarse iteration 1", seconds, 4, misfit) + ", " +
                    line("end", seconds + 10.0, 9, 3.0 * misfit) + "]}",
                0);
  }
  Status Run() const { return SweepTest::Run(options_, ParetoSweep(options_)); }
  std::vector<SolverRun> Runs() const {
    return ParetoSweep(options_).value().runs;
  }
  static std::string Cell(const ResultsRow& row, const std::string& column) {
    return SweepTest::Cell(ParetoColumns(), row, column);
  }

  ParetoSweepOptions options_;
};

TEST_F(ParetoSweepTest, ListsEachSettingOnceAroundTheDefault) {
  // With 128 pixels and two lobes a setting would be the default again.
  options_.size = 128;
  options_.solver_seconds = 20.0;
  const std::vector<SolverRun> runs = Runs();
  std::set<std::string> names, estimates, problems;
  for (const SolverRun& run : runs) {
    names.insert(Cell(run.row.cells(), "setting"));
    estimates.insert(run.of.name + "/" + run.estimate);
    problems.insert(run.of.name + run.problem);
  }
  EXPECT_EQ(ParetoSettings().size() - 3, runs.size());
  for (const char* left_out : {"size-128", "lobes-2", "seconds-20"}) {
    EXPECT_EQ(0u, names.count(left_out)) << left_out;
  }
  EXPECT_EQ(runs.size(), names.size());
  EXPECT_EQ(runs.size(), estimates.size());
  EXPECT_EQ(runs.size(), problems.size());
  EXPECT_EQ("default", Cell(runs[0].row.cells(), "setting"));
  EXPECT_EQ("20", Cell(runs[0].row.cells(), "budget_seconds"));
}

TEST_F(ParetoSweepTest, ProblemsSayWhatRowsSay) {
  options_.size = 16;
  for (const SolverRun& run : Runs()) {
    const std::string file = dir_.File(run.problem_name);
    WriteBytes(file, run.problem);
    const StatusOr<Problem> problem = ReadProblem(file, {});
    ASSERT_TRUE(problem.ok()) << problem.status().message();
    EXPECT_TRUE(CheckSolvable(*problem).ok());
    const ResultsRow& row = run.row.cells();
    const SolverSpec& solver = problem->solver;
    EXPECT_EQ(Cell(row, "method"), SolverMethodName(solver.method));
    EXPECT_EQ(Cell(row, "estimator"),
              solver.estimator == SolverEstimator::kMarginal ? "marginal"
                                                             : "maximum");
    EXPECT_EQ(std::stod(Cell(row, "budget_seconds")), solver.seconds);
    EXPECT_EQ(std::stoi(Cell(row, "lobes")), problem->reflectance.lobes);
    EXPECT_EQ(std::stoi(Cell(row, "map_width")), problem->illumination.width);
    EXPECT_EQ(problem->illumination.width, 2 * problem->illumination.height);
    const std::map<IlluminationPrior, std::string> priors = {
        {IlluminationPrior::kUNet, "unet"},
        {IlluminationPrior::kProcess, "process"},
        {IlluminationPrior::kNone, "none"}};
    EXPECT_EQ(Cell(row, "prior"), priors.at(problem->illumination.prior));
    if (problem->illumination.prior == IlluminationPrior::kUNet) {
      EXPECT_EQ(std::stoi(Cell(row, "unet_channels")),
                problem->illumination.unet_channels);
    }
    EXPECT_EQ(Cell(row, "quadrature"), QuadratureLevelName(solver.quadrature));
    EXPECT_EQ(Cell(row, "search"), SolverSearchName(solver.search));
    EXPECT_EQ(std::stoi(Cell(row, "turns")), solver.turns);
    EXPECT_EQ(Cell(row, "models") == "1",
              problem->reflectance.model == "default");
    EXPECT_EQ(std::stoi(Cell(row, "size")), run.of.size);
    const bool own_case = run.of.name != "paint_a";
    EXPECT_EQ(own_case, run.of.size != options_.size);
    if (Cell(row, "setting") == "adam") {
      // Nothing but its ten rounds ends the reference.
      EXPECT_EQ(10, solver.max_iterations);
      EXPECT_EQ(0.0, solver.tolerance);
      EXPECT_LE(1e5, solver.seconds);
    }
  }
}

TEST_F(ParetoSweepTest, SettingsAreChosenByName) {
  options_.settings = {"lobes-3", "seconds-60"};
  std::vector<SolverRun> runs = Runs();
  ASSERT_EQ(2u, runs.size());
  // In the table's order; the default's budget, but the default is not run.
  EXPECT_EQ("seconds-60", Cell(runs[0].row.cells(), "setting"));
  EXPECT_EQ("lobes-3", Cell(runs[1].row.cells(), "setting"));
  options_.settings = {"default", "fast"};
  const Status status = ParetoSweep(options_).status();
  EXPECT_NE(std::string::npos, status.message().find("fast"));
  EXPECT_NE(std::string::npos, status.message().find("map-64x32"));
  options_.settings = {"default"};
  options_.map_names.clear();
  options_.only_index = options_.only_count = 3;
  runs = Runs();
  ASSERT_EQ(1u, runs.size());
  EXPECT_EQ("paint_c", runs[0].of.name);
}

TEST_F(ParetoSweepTest, WritesRowsResumesAndComparesTimes) {
  options_.settings = {"adam"};
  Solve(0.25, 90);
  ASSERT_TRUE(Run().ok());
  options_.settings = {"default", "adam", "size-64"};
  Solve(0.125, 15);
  ASSERT_TRUE(Run().ok());
  EXPECT_EQ(3u, Calls());
  const std::vector<ResultsRow> rows = Rows(ParetoColumns());
  ASSERT_EQ(3u, rows.size());
  EXPECT_EQ("adam", Cell(rows[0], "setting"));
  EXPECT_EQ("default", Cell(rows[1], "setting"));
  EXPECT_EQ("1", Cell(rows[1], "rounds"));
  EXPECT_EQ("0.125", Cell(rows[1], "misfit"));
  EXPECT_EQ("0.5", Cell(rows[1], "illumination_relative_log_rmse"));
  EXPECT_EQ("64", Cell(rows[2], "size"));
  EXPECT_EQ("ok", Cell(rows[2], "status"));
  // Inputs of both sizes.
  for (const char* name : {"paint_a", "paint_a_64px"}) {
    EXPECT_TRUE(std::filesystem::exists(options_.out + "/cases/" + name +
                                        "/input.exr"));
  }
  EXPECT_NE(std::string::npos,
            ReadBytes(options_.out + "/results.md")
                .find("| paint | a | 1 | 0.2500 | 90.0 | 100.0 | 15.0 | 6.7 | "
                      "25.0 |"));
  ASSERT_TRUE(Run().ok());
  EXPECT_EQ(3u, Calls());
  CutResults();
  ASSERT_TRUE(Run().ok());
  EXPECT_EQ(4u, Calls());
  // Another default is another run.
  options_.settings = {"default"};
  options_.lobes = 1;
  ASSERT_TRUE(Run().ok());
  EXPECT_EQ(5u, Calls());
}

TEST_F(ParetoSweepTest, SmallMapsAreComparedAtTheOthersSize) {
  // The true map itself, which the sweep has to bring to 128x64.
  ASSERT_TRUE(WriteMap(testing::SmoothMap(8, 16), MapFrame::kCamera,
                       dir_.File("estimate.exr"))
                  .ok());
  options_.settings = {"map-64x32"};
  ASSERT_TRUE(Run().ok());
  const ResultsRow row = Rows(ParetoColumns()).at(0);
  // 0.5 is what the solver said.
  EXPECT_NEAR(0.0, std::stod(Cell(row, "illumination_relative_log_rmse")),
              1e-6);
}

TEST_F(ParetoSweepTest, ARunWithoutResultHasNoRatio) {
  options_.settings = {"default", "adam"};
  WriteSolver("{}", 1);
  ASSERT_TRUE(Run().ok());
  const ResultsRow row = Rows(ParetoColumns()).at(0);
  EXPECT_EQ("internal_error", Cell(row, "status"));
  EXPECT_EQ("", Cell(row, "rounds"));
  EXPECT_EQ(std::string::npos,
            ReadBytes(options_.out + "/results.md").find("Adam's"));
}

}  // namespace
}  // namespace ibrdf
