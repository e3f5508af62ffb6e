#include <gtest/gtest.h>

#include <atomic>
#include <cmath>
#include <filesystem>

#include "ibrdf/brdf/cook_torrance.h"
#include "io/merl.h"
#include "solvers/trainer/adam.h"
#include "solvers/trainer/checkpoint.h"
#include "solvers/trainer/flow_trainer.h"
#include "solvers/trainer/training_data.h"
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
    data_ =
        new TrainingData(ReadTrainingData(dir_->path(), {}, 3000, 7).value());
  }
  static void TearDownTestSuite() {
    delete data_;
    delete dir_;
  }

  static TrainerOptions Options(int64_t steps) {
    TrainerOptions options;
    options.shape.layers = 3;
    options.shape.bins = 4;
    options.shape.code_size = 4;
    options.shape.widths = {16, 8};
    options.steps = steps;
    options.codes_per_step = 6;
    options.points_per_code = 128;
    options.num_threads = 1;
    return options;
  }
  static TrainingData Train() { return data_->Slice(0, 2500); }
  static TrainingData HeldOut() { return data_->Slice(2500, 3000); }
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
  EXPECT_EQ(3000, data_->num_points);
  EXPECT_EQ(size_t{9000}, data_->x.size());
  for (const float x : data_->x) EXPECT_TRUE(x >= 0.0f && x <= 1.0f);
  const MerlTable table = ReadMerl(dir_->File("c_red.binary")).value();
  const std::vector<int> bins = ShuffledBins(7);
  for (int p = 0; p < 3000; p += 100) {
    EXPECT_FLOAT_EQ(
        static_cast<float>(std::log(table.Raw(1, bins[p]) + kLogFloor)),
        data_->LogRaw(7)[p]);
  }
}

TEST_F(TrainerTest, SlicesPartitionThePoints) {
  const TrainingData a = Train(), b = HeldOut();
  EXPECT_EQ(2500, a.num_points);
  EXPECT_EQ(500, b.num_points);
  EXPECT_EQ(data_->LogRaw(4)[2499], a.LogRaw(4)[2499]);
  EXPECT_EQ(data_->LogRaw(4)[2500], b.LogRaw(4)[0]);
  EXPECT_EQ(data_->x[2 * 3000 + 2600], b.x[2 * 500 + 100]);
}

TEST_F(TrainerTest, LeftOutMaterialsAreNotRead) {
  const TrainingData data =
      ReadTrainingData(dir_->path(), {"b_matte", "a_glossy"}, 10, 1).value();
  EXPECT_EQ(size_t{3}, data.names.size());
  EXPECT_EQ("c_red.red", data.names[0]);
}

TEST_F(TrainerTest, BadFoldersAreNamed) {
  const auto expect = [](const std::string& folder,
                         const std::vector<std::string>& leave_out,
                         const std::string& word) {
    const Status s = ReadTrainingData(folder, leave_out, 10, 1).status();
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

TEST_F(TrainerTest, TrainingLowersTheHeldOutScore) {
  const NeuralBrdfModel first = Run(Options(1));
  TrainerOptions options = Options(500);
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

TEST_F(TrainerTest, CodesStayInTheUnitBallUnderHugeRates) {
  TrainerOptions options = Options(20);
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

TEST_F(TrainerTest, ThreadsDoNotChangeBits) {
  TrainerOptions options = Options(20);
  const NeuralBrdfModel one = Run(options);
  options.num_threads = 2;
  ExpectSameBits(one, Run(options));
  options.seed = 2;
  EXPECT_NE(one.weights, Run(options).weights);
}

TEST_F(TrainerTest, StopAndResumeGivesTheBitsOfOneRun) {
  const TempDir dir;
  TrainerOptions options = Options(30);
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

TEST_F(TrainerTest, CheckpointsThatDoNotFitAreRefused) {
  const TempDir dir;
  TrainerOptions options = Options(30);
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
  other.shape.widths = {16, 9};
  expect_refused(other, "widths");
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
