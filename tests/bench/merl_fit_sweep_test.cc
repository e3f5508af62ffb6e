#include "ibrdf/solvers/bench/merl_fit_sweep.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <filesystem>
#include <set>

#include "ibrdf/brdf/cook_torrance.h"
#include "ibrdf/brdf/lambertian.h"
#include "ibrdf/brdf/sample_merl.h"
#include "ibrdf/brdf/void_bins.h"
#include "ibrdf/io/merl.h"
#include "ibrdf/solvers/bench/baseline_fitters.h"
#include "ibrdf/solvers/bench/merl_fit_summary.h"
#include "tests/support/temp_dir.h"

namespace ibrdf {
namespace {

// Returns the table times a factor, or fails; counts its calls.
class ScalingFitter final : public TableFitter {
 public:
  ScalingFitter(std::string method, double factor)
      : method_(std::move(method)), factor_(factor) {}
  std::string method() const override { return method_; }
  std::string lobes() const override { return "2"; }
  std::string model() const override { return "weights"; }
  StatusOr<FittedTable> Fit(const MerlTable& table,
                            const TableFitContext& context) const override {
    ++calls;
    materials.insert(context.material);
    if (!failure.ok()) return failure;
    FittedTable fit{table, 0.25};
    for (double& raw : fit.table.raw) raw *= raw > 0.0 ? factor_ : 1.0;
    return fit;
  }

  mutable int calls = 0;
  mutable std::set<std::string> materials;
  Status failure;

 private:
  const std::string method_;
  const double factor_;
};

MerlTable Constant(double albedo) {
  Lambertian brdf;
  brdf.albedo.setConstant(albedo);
  return SampleMerl(brdf.Function());
}

class MerlFitSweepTest : public ::testing::Test {
 protected:
  MerlFitSweepTest() {
    std::filesystem::create_directories(dir_.File("data"));
    std::filesystem::create_directories(dir_.File("other"));
    for (const char* name : {"clay", "paper"}) {
      CHECK(WriteMerl(Constant(0.5),
                      dir_.File(std::string("data/") + name + ".binary"))
                .ok());
      CHECK(WriteMerl(Constant(0.5 * 2.718281828459045),
                      dir_.File(std::string("other/") + name + ".binary"))
                .ok());
    }
    options_.data = dir_.File("data");
    options_.out = dir_.File("out");
    options_.fitters = {near_, far_};
    options_.command = "the command";
  }
  std::vector<ResultsRow> Rows() const {
    return ReadResults(options_.out + "/results.csv", MerlFitColumns()).value();
  }
  static std::string Cell(const ResultsRow& row, const std::string& column) {
    const auto& columns = MerlFitColumns();
    const auto at = std::find(columns.begin(), columns.end(), column);
    CHECK(at != columns.end());
    return row[at - columns.begin()];
  }

  const TempDir dir_;
  const std::shared_ptr<ScalingFitter> near_ =
      std::make_shared<ScalingFitter>("near", 1.0);
  const std::shared_ptr<ScalingFitter> far_ =
      std::make_shared<ScalingFitter>("far", 2.718281828459045);
  MerlFitSweepOptions options_;
};

TEST_F(MerlFitSweepTest, WritesRowsAndResumes) {
  options_.materials = {"clay"};
  options_.score_data = dir_.File("other");
  options_.seed = 7;
  ASSERT_TRUE(RunMerlFitSweep(options_).ok());
  ASSERT_EQ(2u, Rows().size());
  const ResultsRow row = Rows()[1];
  EXPECT_EQ("clay", Cell(row, "material"));
  EXPECT_EQ("far", Cell(row, "method"));
  EXPECT_EQ("2", Cell(row, "lobes"));
  EXPECT_EQ("weights", Cell(row, "model"));
  EXPECT_EQ("7", Cell(row, "seed"));
  EXPECT_EQ("0.25", Cell(row, "seconds"));
  EXPECT_EQ("ok", Cell(row, "status"));
  // A factor e; the floor of 1e-6 beside raw values above 100.
  EXPECT_NEAR(1.0, std::stod(Cell(row, "brdf_log_rmse")), 1e-5);
  EXPECT_NEAR(0.0, std::stod(Cell(row, "brdf_log_rmse_aligned")), 1e-5);
  EXPECT_NEAR(1.0, std::stod(Cell(row, "brdf_log_rmse_below80")), 1e-5);
  EXPECT_NEAR(0.0, std::stod(Cell(row, "score_data_log_rmse")), 1e-5);
  EXPECT_NEAR(1.0, std::stod(Cell(Rows()[0], "score_data_log_rmse")), 1e-5);

  ASSERT_TRUE(RunMerlFitSweep(options_).ok());
  EXPECT_EQ(1, far_->calls);
  // A row that a kill cut is made again; so are another seed's and material's.
  const std::string csv = ReadBytes(options_.out + "/results.csv");
  WriteBytes(options_.out + "/results.csv", csv.substr(0, csv.size() - 3));
  ASSERT_TRUE(RunMerlFitSweep(options_).ok());
  EXPECT_EQ(1, near_->calls);
  EXPECT_EQ(2, far_->calls);
  EXPECT_EQ(2u, Rows().size());
  options_.seed = 8;
  options_.materials.clear();
  options_.only_index = options_.only_count = 2;
  options_.methods = {"near"};
  options_.score_data.clear();
  ASSERT_TRUE(RunMerlFitSweep(options_).ok());
  ASSERT_EQ(3u, Rows().size());
  EXPECT_EQ("paper", Cell(Rows()[2], "material"));
  EXPECT_EQ("", Cell(Rows()[2], "score_data_log_rmse"));
  EXPECT_EQ(2, far_->calls);
}

// A table that is bright beyond 80 degrees alone scores as the dark rest of it.
TEST_F(MerlFitSweepTest, BinsThatAreVoidedAreNeitherFittedNorScored) {
  MerlTable table = Constant(0.5);
  MerlTable trusted = table;
  VoidBeyond(80.0, &trusted);
  for (size_t i = 0; i < table.raw.size(); ++i) {
    if (trusted.raw[i] < 0.0 && table.raw[i] > 0.0) table.raw[i] *= 50.0;
  }
  ASSERT_NE(trusted.raw, Constant(0.5).raw);
  ASSERT_TRUE(WriteMerl(table, dir_.File("data/clay.binary")).ok());
  options_.materials = {"clay"};
  options_.methods = {"lambertian"};
  options_.fitters = BaselineFitters();
  ASSERT_TRUE(RunMerlFitSweep(options_).ok());
  EXPECT_LT(0.5, std::stod(Cell(Rows()[0], "brdf_log_rmse")));
  options_.out = dir_.File("trusted");
  options_.void_beyond = 80.0;
  options_.score_data = dir_.File("other");
  ASSERT_TRUE(RunMerlFitSweep(options_).ok());
  EXPECT_NEAR(0.0, std::stod(Cell(Rows()[0], "brdf_log_rmse")), 1e-9);
  EXPECT_NEAR(1.0, std::stod(Cell(Rows()[0], "score_data_log_rmse")), 1e-5);
}

TEST_F(MerlFitSweepTest, FailuresGoToStatusAndInterruptsEndTheSweep) {
  options_.materials = {"clay"};
  far_->failure = InvalidInput("table", "expected something else");
  ASSERT_TRUE(RunMerlFitSweep(options_).ok());
  ASSERT_EQ(2u, Rows().size());
  EXPECT_EQ("bad_input", Cell(Rows()[1], "status"));
  EXPECT_EQ("", Cell(Rows()[1], "brdf_log_rmse"));
  far_->failure = Status(StatusCode::kInterrupted, "stopped");
  options_.materials = {"paper"};
  EXPECT_EQ(StatusCode::kInterrupted, RunMerlFitSweep(options_).code());
  EXPECT_EQ(3u, Rows().size());
}

TEST_F(MerlFitSweepTest, RefusesUnknownNamesNamingTheOption) {
  options_.methods = {"flow"};
  const Status method = RunMerlFitSweep(options_);
  EXPECT_EQ(2, method.ExitCode());
  EXPECT_EQ("command line: --methods: expected some of: near, far; found flow",
            method.message());
  options_.methods.clear();
  options_.materials = {"gold"};
  const Status material = RunMerlFitSweep(options_);
  EXPECT_EQ(2, material.ExitCode());
  EXPECT_EQ(options_.data + ": --materials: expected a file gold.binary",
            material.message());
  options_.materials = {"clay"};
  options_.score_data = dir_.File("out");
  EXPECT_EQ(options_.score_data + ": --score-data: expected a file clay.binary",
            RunMerlFitSweep(options_).message());
  options_.score_data.clear();
  WriteBytes(dir_.File("data/clay.binary"), "short");
  EXPECT_EQ(2, RunMerlFitSweep(options_).ExitCode());
  // Columns of another sweep.
  std::filesystem::create_directories(options_.out);
  WriteBytes(options_.out + "/results.csv", "material,map\n");
  EXPECT_NE(std::string::npos,
            RunMerlFitSweep(options_).message().find("results.csv: line 1"));
}

TEST(BaselineFitters, AreListedByNameAndScoreWhatTheyShould) {
  std::set<std::string> names;
  const MerlTable table = Constant(0.3);
  for (const auto& fitter : BaselineFitters()) {
    names.insert(fitter->method());
    EXPECT_EQ("", fitter->model());
    if (fitter->method() != "lambertian") continue;
    const FittedTable fit = fitter->Fit(table, {}).value();
    const int bin = MerlTable::Bin(3, 4, 5);
    // Rounding of a mean over a million logarithms.
    EXPECT_NEAR(table.Raw(1, bin), fit.table.Raw(1, bin),
                1e-9 * table.Raw(1, bin));
  }
  std::vector<std::string> dsbrdf;
  for (const auto& fitter : BaselineFitters({2})) {
    if (fitter->method() == "dsbrdf") dsbrdf.push_back(fitter->lobes());
  }
  EXPECT_EQ(std::vector<std::string>{"2"}, dsbrdf);
  EXPECT_EQ(
      (std::set<std::string>{"bivariate", "bivariate_arithmetic", "lambertian",
                             "cook_torrance", "disney", "dsbrdf"}),
      names);
}

ResultsRow MakeRow(const std::string& material, const std::string& method,
                   const std::string& score) {
  NamedRow row(MerlFitColumns());
  row.Set("material", material);
  row.Set("method", method);
  row.Set("seed", "1");
  row.Set("brdf_log_rmse", score);
  row.Set("status", score.empty() ? "bad_input" : "ok");
  return row.cells();
}

TEST(SummarizeMerlFits, CountsMeansMediansAndWins) {
  const std::string text = SummarizeMerlFits(
      {MakeRow("a", "x", "1"), MakeRow("a", "y", "2"), MakeRow("b", "x", "2"),
       MakeRow("b", "y", "0.5"), MakeRow("ss440", "x", "6"),
       MakeRow("ss440", "y", ""), MakeRow("c", "x", "4")});
  const auto count = [&](const std::string& part) {
    return text.find(part) != std::string::npos;
  };
  EXPECT_TRUE(count("| x | 4 | 3.25 | 3 | 6 |")) << text;
  EXPECT_TRUE(count("| x | 3 | 2.333 | 2 | 4 |")) << text;  // without ss440
  EXPECT_TRUE(count("| y | 2 | 1.25 | 1.25 | 2 |")) << text;
  EXPECT_TRUE(count("| x |  | 1 of 2 |")) << text;
  EXPECT_TRUE(count("| y | 1 of 2 |  |")) << text;
  EXPECT_FALSE(count("score_data")) << text;
  EXPECT_EQ(std::string::npos, SummarizeMerlFits({}).find("nan"));
}

}  // namespace
}  // namespace ibrdf
