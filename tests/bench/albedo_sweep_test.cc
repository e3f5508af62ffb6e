#include "ibrdf/solvers/bench/albedo_sweep.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <cstdlib>
#include <filesystem>

#include "ibrdf/brdf/cook_torrance.h"
#include "ibrdf/brdf/lambertian.h"
#include "ibrdf/brdf/sample_merl.h"
#include "ibrdf/io/merl.h"
#include "ibrdf/io/model_file.h"
#include "ibrdf/metrics/albedo.h"
#include "ibrdf/solvers/bench/results_table.h"
#include "tests/support/small_embedding.h"
#include "tests/support/temp_dir.h"

namespace ibrdf {
namespace {

constexpr double kSixDigits = 1e-5;  // of a cell

class AlbedoSweepTest : public ::testing::Test {
 protected:
  AlbedoSweepTest() : model_(SmallEmbedding(2)) {
    std::filesystem::create_directories(dir_.File("data"));
    Lambertian bright;
    bright.albedo = {1.1, 0.5, 0.2};
    CHECK(WriteMerl(SampleMerl(bright.Function()), dir_.File("data/m1.binary"))
              .ok());
    CHECK(WriteModel(model_, dir_.File("small.ibrdf")).ok());
    options_.model = dir_.File("small.ibrdf");
    options_.data = dir_.File("data");
    options_.out = dir_.File("out");
    options_.command = "ibrdf_bench albedo";
    options_.num_threads = 1;
  }
  std::vector<ResultsRow> Rows() const {
    const auto rows =
        ReadResults(dir_.File("out/results.csv"), AlbedoColumns());
    CHECK(rows.ok()) << rows.status().message();
    return *rows;
  }
  static double Number(const ResultsRow& row, const std::string& column) {
    const auto& c = AlbedoColumns();
    return std::strtod(
        row[std::find(c.begin(), c.end(), column) - c.begin()].c_str(),
        nullptr);
  }

  TempDir dir_;
  NeuralBrdfModel model_;
  AlbedoSweepOptions options_;
};

TEST_F(AlbedoSweepTest, RowsHoldTheFiguresOfModelAndTable) {
  ASSERT_TRUE(RunAlbedoSweep(options_).ok());
  const std::vector<ResultsRow> rows = Rows();
  ASSERT_EQ(rows.size(), 3u);  // m0 has no table
  EXPECT_EQ(rows[0][0] + rows[0][1], "m0model");
  EXPECT_EQ(rows[2][0] + rows[2][1], "m1table");
  // The table: red exceeds 1 at each of the 18 views.
  EXPECT_EQ(Number(rows[2], "views_above_one"), 18);
  EXPECT_NEAR(Number(rows[2], "albedo_60"), 0.6, kSixDigits);
  EXPECT_NEAR(Number(rows[2], "largest"), 1.1, kSixDigits);
  EXPECT_NEAR(Number(rows[2], "hemispherical_green"), 0.5, kSixDigits);
  // The model, by itself.
  const BrdfBatch brdf =
      FlowBrdf(model_, MaterialLobes(model_, 3).data(), 3, 1).Batch();
  const FurnaceFigures figures = FurnaceRules().Measure(brdf);
  EXPECT_NEAR(Number(rows[1], "albedo_75"), figures.albedo[3].mean(),
              kSixDigits * figures.albedo[3].mean());
  EXPECT_NEAR(Number(rows[1], "hemispherical_blue"), figures.hemispherical[2],
              kSixDigits * figures.hemispherical[2]);
  EXPECT_LT(Number(rows[1], "deviation_sampler"),
            Number(rows[1], "deviation_cosine"));
  const std::string text = ReadBytes(dir_.File("out/results.md"));
  EXPECT_NE(text.find("table: 1 of 1 materials, 18 of 54"), std::string::npos)
      << text;
}

TEST_F(AlbedoSweepTest, GoesOnWhereItWasStopped) {
  options_.materials = {"m1"};
  ASSERT_TRUE(RunAlbedoSweep(options_).ok());
  options_.materials.clear();
  ASSERT_TRUE(RunAlbedoSweep(options_).ok());
  const std::vector<ResultsRow> rows = Rows();
  ASSERT_EQ(rows.size(), 3u);
  EXPECT_EQ(rows[2][0], "m0");
}

TEST_F(AlbedoSweepTest, RefusesWhatIsNotThere) {
  options_.materials = {"m7"};
  Status status = RunAlbedoSweep(options_);
  EXPECT_EQ(status.code(), StatusCode::kInvalidInput);
  EXPECT_NE(status.message().find("m7"), std::string::npos);
  options_.materials.clear();
  std::swap(model_.names[1], model_.names[2]);
  ASSERT_TRUE(WriteModel(model_, options_.model).ok());
  status = RunAlbedoSweep(options_);
  EXPECT_EQ(status.code(), StatusCode::kInvalidInput);
  EXPECT_NE(status.message().find("m0.red"), std::string::npos);
}

// The lobes of a material are its codes, each in its own channel.
TEST(FlowBrdf, IsTheDensityOfEachChannelsCode) {
  const NeuralBrdfModel model = SmallEmbedding(2);
  const FlowBrdf brdf(model, MaterialLobes(model, 3).data(), 3, 1);
  const HalfDiff angles{0.2, 0.7, 1.1};
  const Eigen::Array3d f = brdf.Evaluate({angles})[0];
  const Eigen::Vector3f x =
      ToUnitCube(angles.theta_h, angles.theta_d, angles.phi_d).cast<float>();
  const auto flow = BrdfFlow::Create(model.shape, model.weights);
  for (int c = 0; c < 3; ++c) {
    float log_density = 0.0f;
    flow->LogDensity(x.data(), 1, model.codes.data() + 3 * (3 + c), 1,
                     &log_density, nullptr, nullptr);
    const double expected =
        kMerlScale[c] * std::exp(model.log_colours[3 + c] + log_density);
    EXPECT_NEAR(f[c], expected, 1e-6 * expected) << c;  // float exponents
  }
}

}  // namespace
}  // namespace ibrdf
