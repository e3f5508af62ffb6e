#include <gtest/gtest.h>

#include <filesystem>

#include "ibrdf/io/model_file.h"
#include "ibrdf/solvers/bench/known_brdf_sweep.h"
#include "ibrdf/solvers/bench/known_light_sweep.h"
#include "ibrdf/solvers/bench/sphere_metrics.h"
#include "tests/bench/sweep_testing.h"
#include "tests/support/tiny_model.h"

namespace ibrdf {
namespace {

class KnownSweepsTest : public testing::SweepTest {};

TEST_F(KnownSweepsTest, KnownLightSolvesWithModelsThatHaveNotSeenTheMaterial) {
  NeuralBrdfModel model = TinyModel(2);
  std::filesystem::create_directories(dir_.File("models/fold0"));
  std::filesystem::create_directories(dir_.File("models/fold1"));
  ASSERT_TRUE(WriteModel(model, dir_.File("models/fold1/m.ibrdf")).ok());
  model.names = {"m0.red",    "m0.green",    "m0.blue",
                 "paint.red", "paint.green", "paint.blue"};
  ASSERT_TRUE(WriteModel(model, dir_.File("models/fold0/m.ibrdf")).ok());

  KnownLightSweepOptions options;
  Apply(&options);
  options.models = dir_.File("models");
  options.map_names = {"a", "b"};
  ASSERT_TRUE(Run(options, KnownLightSweep(options)).ok());
  const auto& columns = KnownLightColumns();
  ASSERT_EQ(2u, Rows(columns).size());
  const ResultsRow row = Rows(columns)[1];
  EXPECT_EQ("b", Cell(columns, row, "map"));
  EXPECT_EQ("fold1/m.ibrdf", Cell(columns, row, "model"));
  EXPECT_EQ("0.25", Cell(columns, row, "misfit"));
  EXPECT_EQ("ok", Cell(columns, row, "status"));
  EXPECT_NEAR(0.0, std::stod(Cell(columns, row, "relit_log_rmse")), 1e-6);
  const std::string yaml =
      ReadBytes(options.out + "/cases/paint_b/known_light.yaml");
  EXPECT_NE(std::string::npos, yaml.find("problem: reflectance\n"));
  EXPECT_NE(std::string::npos, yaml.find("models/fold1/m.ibrdf"));
  EXPECT_NE(std::string::npos, yaml.find("known: "));

  CutResults();
  ASSERT_TRUE(Run(options, KnownLightSweep(options)).ok());
  EXPECT_EQ(3u, Calls());
  EXPECT_EQ(2u, Rows(columns).size());
  // Another model is another run.
  options.models.clear();
  ASSERT_TRUE(Run(options, KnownLightSweep(options)).ok());
  EXPECT_EQ(5u, Calls());
  ASSERT_TRUE(Run(options, KnownLightSweep(options)).ok());
  EXPECT_EQ(5u, Calls());
}

TEST_F(KnownSweepsTest, KnownBrdfComparesPriorsAndSpheres) {
  Image estimate =
      ResizeMap(testing::SmoothMap(8, 16), kSweepMapHeight, kSweepMapWidth);
  for (float& v : estimate.rgb) v *= 3.0f;
  ASSERT_TRUE(
      WriteMap(estimate, MapFrame::kCamera, dir_.File("estimate.exr")).ok());
  KnownBrdfSweepOptions options;
  Apply(&options);
  options.map_names = {"a"};
  ASSERT_TRUE(Run(options, KnownBrdfSweep(options)).ok());
  const auto& columns = KnownBrdfColumns();
  const std::vector<ResultsRow> rows = Rows(columns);
  ASSERT_EQ(2u, rows.size());
  EXPECT_EQ("process", Cell(columns, rows[0], "prior"));
  EXPECT_EQ("none", Cell(columns, rows[1], "prior"));
  for (const ResultsRow& row : rows) {
    EXPECT_EQ("0.125", Cell(columns, row, "illumination_relative_log_rmse"));
    EXPECT_LT(0.0,
              std::stod(Cell(columns, row, "constant_map_relative_log_rmse")));
    for (const char* column :
         {"mirror_log_rmse", "diffuse_log_rmse", "glossy_log_rmse"}) {
      // The true map but for the scale.
      EXPECT_NEAR(0.0, std::stod(Cell(columns, row, column)), 1e-4) << column;
    }
  }
  const std::string folder = options.out + "/cases/paint_a/";
  EXPECT_NE(std::string::npos,
            ReadBytes(folder + "known_brdf_none.yaml").find("prior: none"));

  // A kill after the first prior: only the second runs again.
  const std::string csv = ReadBytes(Results());
  WriteBytes(Results(), csv.substr(0, csv.rfind("paint") + 4));
  ASSERT_TRUE(Run(options, KnownBrdfSweep(options)).ok());
  EXPECT_EQ(3u, Calls());
  EXPECT_EQ(2u, Rows(columns).size());
}

// The light of the input says nothing new of the reflectance.
TEST_F(KnownSweepsTest, ReflectanceIsComparedUnderTheNextMap) {
  const MerlTable other = SampleMerl(testing::Glossy(0.3, 0.5, 60.0));
  ASSERT_TRUE(WriteMerl(other, dir_.File("other.binary")).ok());
  WriteSolver("{\"metrics\": {}}", 0,
              "cp '" + dir_.File("other.binary") + "' \"$out/brdf.binary\"");
  Image sun = testing::SmoothMap(8, 16);
  for (int c = 0; c < 3; ++c) sun.At(2, 5)[c] *= 100.0f;
  ASSERT_TRUE(WriteExr(sun, dir_.File("maps/a.exr")).ok());
  KnownLightSweepOptions options;
  Apply(&options);
  options.map_names = {"a", "c"};
  ASSERT_TRUE(Run(options, KnownLightSweep(options)).ok());
  const MerlTable truth = ReadMerl(dir_.File("data/paint.binary")).value();
  const auto relit = [&](const Image& map) {
    return CompareRelit(other, truth,
                        ResizeMap(map, kSweepMapHeight, kSweepMapWidth), 1)
        .value()
        .log_rmse;
  };
  const auto& columns = KnownLightColumns();
  const std::vector<ResultsRow> rows = Rows(columns);
  ASSERT_EQ(2u, rows.size());
  const double smooth = relit(testing::SmoothMap(8, 16)), sunny = relit(sun);
  EXPECT_GT(std::abs(std::log(sunny / smooth)), 0.1);
  EXPECT_NEAR(smooth, std::stod(Cell(columns, rows[0], "relit_log_rmse")),
              1e-4 * smooth);
  EXPECT_NEAR(sunny, std::stod(Cell(columns, rows[1], "relit_log_rmse")),
              1e-4 * sunny);

  std::filesystem::remove(dir_.File("maps/b.exr"));
  std::filesystem::remove(dir_.File("maps/c.exr"));
  options.map_names = {"a"};
  options.out = dir_.File("alone");
  ASSERT_TRUE(Run(options, KnownLightSweep(options)).ok());
  const ResultsRow alone =
      ReadResults(options.out + "/results.csv", columns).value().at(0);
  EXPECT_EQ("ok", Cell(columns, alone, "status"));
  EXPECT_EQ("", Cell(columns, alone, "relit_log_rmse"));
}

TEST_F(KnownSweepsTest, AnEstimateThatIsNotThereLeavesCellsEmpty) {
  WriteSolver("{}", 1);
  KnownBrdfSweepOptions options;
  Apply(&options);
  options.map_names = {"a"};
  options.priors = {"none"};
  ASSERT_TRUE(Run(options, KnownBrdfSweep(options)).ok());
  const auto& columns = KnownBrdfColumns();
  const ResultsRow row = Rows(columns).at(0);
  EXPECT_EQ("internal_error", Cell(columns, row, "status"));
  EXPECT_EQ("", Cell(columns, row, "mirror_rmse"));
  EXPECT_NE("", Cell(columns, row, "constant_map_relative_log_rmse"));
}

TEST_F(KnownSweepsTest, ListRuns) {
  KnownBrdfSweepOptions brdf;
  Apply(&brdf);
  EXPECT_EQ(6u, KnownBrdfSweep(brdf).value().runs.size());
  brdf.only_index = brdf.only_count = 3;
  const std::vector<SolverRun> runs = KnownBrdfSweep(brdf).value().runs;
  ASSERT_EQ(2u, runs.size());
  EXPECT_EQ("paint_c", runs[1].of.name);
  EXPECT_EQ("known_brdf_none_auto", runs[1].estimate);
  KnownLightSweepOptions light;
  Apply(&light);
  light.materials = {"gold"};
  EXPECT_NE(std::string::npos,
            KnownLightSweep(light).status().message().find("gold.binary"));
  EXPECT_EQ(0u, Calls());
}

}  // namespace
}  // namespace ibrdf
