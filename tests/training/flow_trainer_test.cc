#include "ibrdf/solvers/training/flow_trainer.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <atomic>
#include <cmath>
#include <filesystem>

#include "ibrdf/brdf/brdf_grid.h"
#include "ibrdf/brdf/cook_torrance.h"
#include "ibrdf/brdf/sample_merl.h"
#include "ibrdf/io/merl.h"
#include "ibrdf/solvers/optim/adam.h"
#include "ibrdf/solvers/table_fit/table_columns.h"
#include "ibrdf/solvers/training/checkpoint.h"
#include "tests/support/temp_dir.h"

namespace ibrdf {
namespace {

TEST(Adam, FirstStepIsTheRateWhateverTheGradient) {
  for (const float g : {1e-4f, 1.0f, -300.0f}) {
    Adam adam(1);
    float x = 2.0f;
    adam.Step(&g, 0.1, 1, 0, 1, &x);
    // Two corrections for bias, and 1e-8 beside the root.
    EXPECT_NEAR(2.0f - std::copysign(0.1f, g), x, 2e-5);
  }
}

TEST(Adam, FindsTheMinimumOfAnIllConditionedQuadratic) {
  Adam adam(3);
  const float curvature[] = {1e-2f, 1.0f, 1e3f}, centre[] = {1, -2, 0.5};
  float x[] = {0, 0, 0}, g[3];
  for (int t = 1; t <= 2000; ++t) {
    for (int i = 0; i < 3; ++i) g[i] = curvature[i] * (x[i] - centre[i]);
    adam.Step(g, 0.05 * (1 - t / 2001.0), t, 0, 3, x);
  }
  for (int i = 0; i < 3; ++i) EXPECT_NEAR(centre[i], x[i], 1e-3);
}

TEST(Adam, TouchesItsRangeOnly) {
  Adam adam(4);
  float x[] = {1, 1, 1, 1};
  const float g[] = {1, 1};
  adam.Step(g, 0.1, 1, 1, 2, x);
  EXPECT_EQ(1.0f, x[0]);
  EXPECT_LT(x[1], 1.0f);
  EXPECT_LT(x[2], 1.0f);
  EXPECT_EQ(1.0f, x[3]);
}

TEST(TrainerOptions, CheckNamesTheFlag) {
  TrainerOptions options;
  EXPECT_TRUE(options.Check().ok());
  options.columns_per_code = 24;
  EXPECT_EQ("command line: --columns-per-code: expected a multiple of 16",
            options.Check().message());
  options.columns_per_code = 16;
  options.points_per_column = 6;
  EXPECT_EQ("command line: --points-per-column: expected a multiple of 4",
            options.Check().message());
}

// Three analytic materials on disk: matte, glossy and coloured.
class TrainerTest : public ::testing::Test {
 protected:
  static void SetUpTestSuite() {
    dir_ = new TempDir;
    const double roughness[] = {0.6, 0.15, 0.3};
    const char* names[] = {"b_matte", "a_glossy", "c_red"};
    for (int i = 0; i < 3; ++i) {
      CookTorrance brdf;
      brdf.diffuse = i == 2 ? Eigen::Array3d(0.5, 0.1, 0.05)
                            : Eigen::Array3d(0.2, 0.2, 0.3);
      brdf.roughness.setConstant(roughness[i]);
      ASSERT_TRUE(WriteMerl(SampleMerl(brdf.Function()),
                            dir_->File(std::string(names[i]) + ".binary"))
                      .ok());
    }
    data_ = new TrainingData(
        ReadTrainingData({{dir_->path()}}, {}, kColumns, 7).value());
  }
  static void TearDownTestSuite() {
    delete data_;
    delete dir_;
  }

  static constexpr int kColumns = 240, kTrainColumns = 200;

  static TrainerOptions Options(
      int64_t steps,
      FlowArchitecture architecture = FlowArchitecture::kTriangular) {
    TrainerOptions options;
    options.shape.architecture = architecture;
    options.shape.triangular.bins = {6, 4, 4};
    options.shape.triangular.code_size = 4;
    options.shape.triangular.widths = {16, 8};
    options.shape.triangular.marginal_widths = {8};
    options.shape.coupling.layers = 3;
    options.shape.coupling.bins = 4;
    options.shape.coupling.code_size = 4;
    options.shape.coupling.widths = {16, 8};
    options.steps = steps;
    options.codes_per_step = 6;
    options.columns_per_code = 16;
    options.points_per_column = 8;
    options.num_threads = 1;
    return options;
  }
  static TrainingData Train() { return data_->Slice(0, kTrainColumns); }
  static TrainingData HeldOut() {
    return data_->Slice(kTrainColumns, kColumns);
  }
  static NeuralBrdfModel Run(const TrainerOptions& options) {
    const StatusOr<NeuralBrdfModel> model =
        TrainFlow(Train(), HeldOut(), options, nullptr, nullptr);
    EXPECT_TRUE(model.ok()) << model.status().message();
    return *model;
  }
  static double Score(const NeuralBrdfModel& model) {
    double sum = 0.0;
    for (const double s : ScoreModel(model, HeldOut(), 1)) sum += s * s;
    return std::sqrt(sum / model.num_codes());
  }
  static void ExpectSameBits(const NeuralBrdfModel& a,
                             const NeuralBrdfModel& b) {
    EXPECT_EQ(a.weights, b.weights);
    EXPECT_EQ(a.codes, b.codes);
    EXPECT_EQ(a.log_colours, b.log_colours);
  }
  // Trains until step `stop_at`, leaving a checkpoint.
  static void Interrupt(const TrainerOptions& options, int64_t stop_at) {
    std::atomic<bool> stop{false};
    const StatusOr<NeuralBrdfModel> model = TrainFlow(
        Train(), HeldOut(), options,
        [&](const TrainerProgress& p) { stop = p.step >= stop_at - 1; }, &stop);
    ASSERT_FALSE(model.ok());
    EXPECT_EQ(StatusCode::kInterrupted, model.status().code());
    ASSERT_TRUE(std::filesystem::exists(options.checkpoint));
  }

  static TempDir* dir_;
  static TrainingData* data_;
};
TempDir* TrainerTest::dir_ = nullptr;
TrainingData* TrainerTest::data_ = nullptr;

TEST_F(TrainerTest, DataAreTheTablesInOrderOfName) {
  EXPECT_EQ((std::vector<std::string>{
                "a_glossy.red", "a_glossy.green", "a_glossy.blue",
                "b_matte.red", "b_matte.green", "b_matte.blue", "c_red.red",
                "c_red.green", "c_red.blue"}),
            data_->names);
  ASSERT_EQ(kColumns, data_->num_columns());
  EXPECT_EQ(kMerlThetaH, data_->columns.points);
  const std::vector<int> columns = DrawColumns(kColumns, 7);
  const MerlTable table = ReadMerl(dir_->File("c_red.binary")).value();
  for (int c = 0; c < kColumns; c += 7) {
    const int j = columns[c] / kMerlPhiD, k = columns[c] % kMerlPhiD;
    ASSERT_GE(data_->count[c], 1);
    for (int i = 0; i < kMerlThetaH; ++i) {
      ASSERT_EQ(i < data_->count[c], MerlBinAboveHorizon(i, j, k));
      const Eigen::Vector3d x =
          ToUnitCube(MerlThetaH(i), MerlThetaD(j), MerlPhiD(k));
      EXPECT_FLOAT_EQ(
          static_cast<float>(std::min(x[0], 1.0)),
          data_->columns.x_h[static_cast<size_t>(i) * kColumns + c]);
      EXPECT_FLOAT_EQ(static_cast<float>(x[1]), data_->columns.x_d[c]);
      EXPECT_FLOAT_EQ(static_cast<float>(x[2]), data_->columns.x_p[c]);
      if (i >= data_->count[c]) continue;
      EXPECT_FLOAT_EQ(static_cast<float>(std::log(
                          table.Raw(1, MerlTable::Bin(i, j, k)) + kLogFloor)),
                      data_->LogRaw(7, c)[i]);
    }
  }
}

TEST_F(TrainerTest, NegativeValuesAreNotMeasured) {
  MerlTable table = ReadMerl(dir_->File("c_red.binary")).value();
  const std::vector<int> columns = DrawColumns(2, 7);
  const int bin = 3 * kMerlThetaD * kMerlPhiD + columns[1];
  table.raw[kMerlBins + bin] = -1.0;
  table.raw[size_t{2} * kMerlBins + bin] = 0.0;
  TrainingData data = ColumnsOfTable(columns);
  AddTable(table, columns, "m", &data);
  EXPECT_TRUE(std::isfinite(data.LogRaw(0, 1)[3]));
  EXPECT_EQ(kNotMeasured, data.LogRaw(1, 1)[3]);
  EXPECT_FLOAT_EQ(static_cast<float>(std::log(kLogFloor)),
                  data.LogRaw(2, 1)[3]);
}

TEST_F(TrainerTest, ColumnsAreDifferentAndDrawnByTheirBins) {
  const int all = kMerlThetaD * kMerlPhiD;
  std::vector<int> columns = DrawColumns(all + 5, 3);
  // The draw of all is a permutation, the one of fewer its start.
  const std::vector<int> few = DrawColumns(100, 3);
  EXPECT_TRUE(std::equal(few.begin(), few.end(), columns.begin()));
  EXPECT_NE(few, DrawColumns(100, 4));
  std::sort(columns.begin(), columns.end());
  ASSERT_EQ(static_cast<size_t>(all), columns.size());
  for (int c = 0; c < all; ++c) ASSERT_EQ(c, columns[c]);
  // The mean of 1 / bins over columns drawn by their bins is columns / bins of
  // the table; 400 of 16200 columns leave an error of a few per cent.
  const TrainingData some = ColumnsOfTable(DrawColumns(400, 5));
  const TrainingData whole = ColumnsOfTable(columns);
  double inverse = 0.0, bins = 0.0, with_bins = 0.0;
  for (const int n : some.count) inverse += 1.0 / std::max(n, 1);
  for (const int n : whole.count) {
    bins += n;
    with_bins += n > 0;
  }
  EXPECT_NEAR(with_bins / bins, inverse / 400, 0.1 * with_bins / bins);
}

TEST_F(TrainerTest, SlicesPartitionTheColumns) {
  const TrainingData a = Train(), b = HeldOut();
  EXPECT_EQ(kTrainColumns, a.num_columns());
  EXPECT_EQ(kColumns - kTrainColumns, b.num_columns());
  const auto same = [](const TrainingData& part, int at, int whole_at) {
    const FlowColumns& x = part.columns;
    EXPECT_EQ(data_->count[whole_at], part.count[at]);
    EXPECT_EQ(data_->columns.x_d[whole_at], x.x_d[at]);
    EXPECT_EQ(data_->columns.x_p[whole_at], x.x_p[at]);
    for (int f = 0; f < kColumnFeatures; ++f) {
      EXPECT_EQ(data_->columns.features[f * kColumns + whole_at],
                x.features[f * x.columns + at]);
    }
    for (int i = 0; i < kMerlThetaH; ++i) {
      ASSERT_EQ(data_->columns.x_h[i * kColumns + whole_at],
                x.x_h[i * x.columns + at]);
      ASSERT_EQ(data_->LogRaw(4, whole_at)[i], part.LogRaw(4, at)[i]);
    }
  };
  same(a, 0, 0);
  same(a, kTrainColumns - 1, kTrainColumns - 1);
  same(b, 0, kTrainColumns);
  same(b, 17, kTrainColumns + 17);
}

TEST_F(TrainerTest, SelectedDistributionsKeepTheirTables) {
  const TrainingData part = data_->Select({7, 2});
  EXPECT_EQ((std::vector<std::string>{"c_red.green", "a_glossy.blue"}),
            part.names);
  EXPECT_EQ(kColumns, part.num_columns());
  for (const int c : {0, 5, kColumns - 1}) {
    EXPECT_EQ(data_->LogRaw(7, c)[0], part.LogRaw(0, c)[0]);
    EXPECT_EQ(data_->LogRaw(2, c)[0], part.LogRaw(1, c)[0]);
  }
}

TEST_F(TrainerTest, LeftOutMaterialsAreNotRead) {
  const TrainingData data =
      ReadTrainingData({{dir_->path()}}, {"b_matte", "a_glossy"}, 10, 1)
          .value();
  EXPECT_EQ(size_t{3}, data.names.size());
  EXPECT_EQ("c_red.red", data.names[0]);
}

// Bins of a folder beyond the angle it is trusted up to are void, and the
// others are as they were. Those of the first folder are all there.
TEST_F(TrainerTest, FoldersAreTrustedUpToTheirAngle) {
  const TempDir more;
  std::filesystem::copy(dir_->File("c_red.binary"), more.File("paper.binary"));
  const TrainingData data =
      ReadTrainingData({{dir_->path()}, {more.path(), 80.0}}, {"b_matte"},
                       kColumns, 7)
          .value();
  ASSERT_EQ(size_t{9}, data.names.size());
  EXPECT_EQ("c_red.blue", data.names[5]);
  EXPECT_EQ("paper.red", data.names[6]);
  const std::vector<int> columns = DrawColumns(kColumns, 7);
  int voided = 0, kept = 0;
  for (int c = 0; c < kColumns; ++c) {
    for (int i = 0; i < data.count[c]; ++i) {
      const bool far =
          MerlBinLowestCosine(i, columns[c] / kMerlPhiD,
                              columns[c] % kMerlPhiD) < 0.17364817766693;
      for (int channel = 0; channel < 3; ++channel) {
        const float whole = data.LogRaw(3 + channel, c)[i];
        EXPECT_NE(kNotMeasured, whole);
        EXPECT_EQ(far ? kNotMeasured : whole, data.LogRaw(6 + channel, c)[i]);
      }
      ++(far ? voided : kept);
    }
  }
  EXPECT_GT(voided, 1000);
  EXPECT_GT(kept, 1000);
  // A name that both have.
  const Status twice =
      ReadTrainingData({{dir_->path()}, {dir_->path(), 80.0}}, {}, 10, 1)
          .status();
  EXPECT_EQ(StatusCode::kInvalidInput, twice.code());
  EXPECT_NE(std::string::npos, twice.message().find("a_glossy"));
}

TEST_F(TrainerTest, BadFoldersAreNamed) {
  const auto expect = [](const std::string& folder,
                         const std::vector<std::string>& leave_out,
                         const std::string& word) {
    const Status s = ReadTrainingData({{folder}}, leave_out, 10, 1).status();
    EXPECT_EQ(StatusCode::kInvalidInput, s.code());
    EXPECT_NE(std::string::npos, s.message().find(word)) << s.message();
  };
  const TempDir empty;
  expect(empty.path(), {}, "none");
  expect(empty.File("absent"), {}, "absent");
  expect(dir_->path(), {"no_such"}, "no_such");
  expect(dir_->path(), {"a_glossy", "b_matte", "c_red"}, "none");
  WriteBytes(empty.File("broken.binary"), "abc");
  expect(empty.path(), {}, "broken.binary");
}

// What holds for every architecture.
class FlowTrainerTest : public TrainerTest,
                        public testing::WithParamInterface<FlowArchitecture> {
 protected:
  static TrainerOptions ParamOptions(int64_t steps) {
    return Options(steps, GetParam());
  }
};
INSTANTIATE_TEST_SUITE_P(
    All, FlowTrainerTest,
    testing::Values(FlowArchitecture::kTriangular, FlowArchitecture::kCoupling),
    [](const testing::TestParamInfo<FlowArchitecture>& flow) {
      return flow.param == FlowArchitecture::kTriangular ? "Triangular"
                                                         : "Coupling";
    });

TEST_P(FlowTrainerTest, TrainingLowersTheHeldOutScore) {
  const NeuralBrdfModel first = Run(ParamOptions(1));
  TrainerOptions options = ParamOptions(500);
  options.learning_rate = 1e-2;
  options.report_seconds = 0.0;
  std::vector<TrainerProgress> reports;
  const StatusOr<NeuralBrdfModel> last = TrainFlow(
      Train(), HeldOut(), options,
      [&](const TrainerProgress& p) { reports.push_back(p); }, nullptr);
  ASSERT_TRUE(last.ok());
  EXPECT_LT(Score(*last), 0.6 * Score(first));
  ASSERT_FALSE(reports.empty());
  EXPECT_EQ(500, reports.back().step);
  EXPECT_LT(reports.back().training_rmse, reports.front().training_rmse);
  // The report's score is of the same points.
  EXPECT_NEAR(Score(*last), reports.back().held_out_rmse, 0.1 * Score(*last));
  for (int i = 0; i < last->num_codes(); ++i) {
    double square = 0.0;
    for (int k = 0; k < 4; ++k) square += std::pow(last->codes[4 * i + k], 2);
    EXPECT_LE(std::sqrt(square), 1 + 1e-6);
  }
}

// Where junk would be, it is as good as without it.
TEST_P(FlowTrainerTest, BinsThatWereNotMeasuredPlayNoPart) {
  TrainerOptions options = ParamOptions(300);
  options.learning_rate = 1e-2;
  const double whole = Score(Run(options));
  for (const float value : {kNotMeasured, 9.0f}) {
    TrainingData data = Train();
    for (size_t i = 0; i < data.log_raw.size(); i += 3) data.log_raw[i] = value;
    const StatusOr<NeuralBrdfModel> model =
        TrainFlow(data, HeldOut(), options, nullptr, nullptr);
    ASSERT_TRUE(model.ok());
    const double score = Score(*model);
    if (value == kNotMeasured) {
      EXPECT_LT(score, 1.3 * whole);
      for (const double s : ScoreModel(*model, data, 1)) EXPECT_LT(s, 1.0);
    } else {
      EXPECT_GT(score, 1.5 * whole);
    }
  }
}

TEST_P(FlowTrainerTest, CodesStayInTheUnitBallUnderHugeRates) {
  TrainerOptions options = ParamOptions(20);
  options.code_learning_rate = 100.0;
  const NeuralBrdfModel model = Run(options);
  int on_sphere = 0;
  for (int i = 0; i < model.num_codes(); ++i) {
    double square = 0.0;
    for (int k = 0; k < 4; ++k) square += std::pow(model.codes[4 * i + k], 2);
    EXPECT_LE(std::sqrt(square), 1 + 1e-6);  // rounding of a float
    on_sphere += square > 0.99;
  }
  EXPECT_GT(on_sphere, 0);
}

TEST_P(FlowTrainerTest, ThreadsDoNotChangeBits) {
  TrainerOptions options = ParamOptions(20);
  const NeuralBrdfModel one = Run(options);
  options.num_threads = 2;
  ExpectSameBits(one, Run(options));
  options.seed = 2;
  EXPECT_NE(one.weights, Run(options).weights);
}

TEST_P(FlowTrainerTest, StopAndResumeGivesTheBitsOfOneRun) {
  const TempDir dir;
  TrainerOptions options = ParamOptions(30);
  // Fewer than there are, so that codes have seen different numbers of steps.
  options.codes_per_step = 4;
  const NeuralBrdfModel whole = Run(options);
  options.checkpoint = dir.File("checkpoint");
  options.report_seconds = 0.0;
  Interrupt(options, 9);
  options.num_threads = 2;
  ExpectSameBits(whole, Run(options));
  // From the last checkpoint there is nothing left to do.
  ExpectSameBits(whole, Run(options));
}

TEST_P(FlowTrainerTest, CheckpointsThatDoNotFitAreRefused) {
  const TempDir dir;
  TrainerOptions options = ParamOptions(30);
  options.checkpoint = dir.File("checkpoint");
  options.report_seconds = 0.0;
  Interrupt(options, 5);
  const std::string bytes = ReadBytes(options.checkpoint);
  const auto expect_refused = [](const TrainerOptions& o,
                                 const std::string& what) {
    const Status s =
        TrainFlow(Train(), HeldOut(), o, nullptr, nullptr).status();
    EXPECT_EQ(StatusCode::kInvalidInput, s.code()) << what;
    EXPECT_EQ(0u, s.message().find(o.checkpoint)) << s.message();
  };
  TrainerOptions other = options;
  other.learning_rate *= 2;
  expect_refused(other, "rate");
  other = options;
  other.seed = 99;
  expect_refused(other, "seed");
  other = options;
  other.shape.triangular.widths = other.shape.coupling.widths = {16, 9};
  expect_refused(other, "widths");
  other = options;
  other.points_per_column *= 2;
  expect_refused(other, "points");
  other = options;
  other.shape.architecture = GetParam() == FlowArchitecture::kTriangular
                                 ? FlowArchitecture::kCoupling
                                 : FlowArchitecture::kTriangular;
  expect_refused(other, "architecture");
  for (const size_t length :
       {size_t{0}, size_t{10}, bytes.size() / 2, bytes.size() - 1}) {
    WriteBytes(options.checkpoint, bytes.substr(0, length));
    expect_refused(options, "truncated");
  }
  WriteBytes(options.checkpoint, bytes + "x");
  expect_refused(options, "longer");
  for (const size_t at : {size_t{3}, size_t{60}, bytes.size() / 2,
                          bytes.size() - 100, bytes.size() - 1}) {
    std::string damaged = bytes;
    damaged[at] = static_cast<char>(damaged[at] ^ 0x40);
    WriteBytes(options.checkpoint, damaged);
    expect_refused(options, "byte " + std::to_string(at));
  }
  WriteBytes(options.checkpoint, bytes);
  EXPECT_TRUE(TrainFlow(Train(), HeldOut(), options, nullptr, nullptr).ok());
}

}  // namespace
}  // namespace ibrdf
