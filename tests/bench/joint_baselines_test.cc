#include "ibrdf/solvers/bench/joint_baselines.h"

#include <filesystem>

#include "ibrdf/solvers/bench/sweep_inputs.h"
#include "tests/bench/sweep_testing.h"

namespace ibrdf {
namespace {

class JointBaselinesTest : public testing::SweepTest {
 protected:
  JointBaselinesTest() {
    Apply(&options_);
    options_.map_names = {"a"};
    fit_.start_roughness = {0.3};
    fit_.start_f0 = {0.1};
    MakeInput();
  }
  void MakeInput() {
    case_ = ListSweepCases(options_).value().at(0);
    CHECK(MakeInputs(options_, {case_}).ok());
  }
  std::string File() const {
    return CaseFolder(options_, case_) + "/cook_torrance.json";
  }
  CookTorranceScore Score() const {
    return ScoreCookTorrance(options_, case_, fit_).value();
  }
  // Whether the next call takes what the file holds, here a misfit of 7.
  bool IsKept() {
    std::string text = ReadBytes(File());
    const size_t at = text.find("\"misfit\": ") + 10;
    WriteBytes(File(), text.replace(at, text.find(',', at) - at, "7.0"));
    return Score().misfit == 7.0;
  }

  SweepOptions options_;
  CookTorranceFitOptions fit_;
  SweepCase case_;
};

TEST_F(JointBaselinesTest, IsComputedOnce) {
  const CookTorranceScore first = Score();
  EXPECT_LT(0.0, first.misfit);
  EXPECT_LT(0.0, first.brdf_log_rmse_aligned);
  EXPECT_LE(first.brdf_log_rmse_aligned, first.brdf_log_rmse);
  const CookTorranceScore again = Score();
  EXPECT_EQ(first.misfit, again.misfit);
  EXPECT_EQ(first.brdf_log_rmse, again.brdf_log_rmse);
  EXPECT_EQ(first.brdf_log_rmse_aligned, again.brdf_log_rmse_aligned);
  EXPECT_LT(0.0, first.brdf_log_rmse_aligned_below80);
  EXPECT_EQ(first.brdf_log_rmse_aligned_below80,
            again.brdf_log_rmse_aligned_below80);
  EXPECT_TRUE(IsKept());
  options_.num_threads = 1;
  EXPECT_EQ(7.0, Score().misfit);
}

TEST_F(JointBaselinesTest, OtherOptionsAndInputsAreComputedAnew) {
  const double misfit = Score().misfit;
  ASSERT_TRUE(IsKept());
  fit_.start_roughness = {0.2};
  EXPECT_NE(7.0, Score().misfit);
  ASSERT_TRUE(IsKept());
  fit_.start_roughness = {0.3};
  EXPECT_EQ(misfit, Score().misfit);
  ASSERT_TRUE(IsKept());
  options_.noise = 0.3;
  MakeInput();
  const double noisy = Score().misfit;
  EXPECT_NE(7.0, noisy);
  // What 30 % noise alone leaves is sqrt(2 / pi) 0.3, less what eight
  // parameters take.
  EXPECT_LT(misfit + 0.05, noisy);
}

TEST_F(JointBaselinesTest, BrokenFilesAreReplaced) {
  const double misfit = Score().misfit;
  const std::string whole = ReadBytes(File());
  for (const std::string& text :
       {std::string(), whole.substr(0, whole.size() / 2), std::string("[]"),
        std::string("{\"misfit\": 7.0}")}) {
    WriteBytes(File(), text);
    EXPECT_EQ(misfit, Score().misfit);
    EXPECT_EQ(whole, ReadBytes(File()));
  }
  std::filesystem::remove(File());
  std::filesystem::remove(CaseFolder(options_, case_) + "/input.exr");
  EXPECT_NE(std::string::npos, ScoreCookTorrance(options_, case_, fit_)
                                   .status()
                                   .message()
                                   .find("input.exr"));
  EXPECT_FALSE(std::filesystem::exists(File()));
}

}  // namespace
}  // namespace ibrdf
