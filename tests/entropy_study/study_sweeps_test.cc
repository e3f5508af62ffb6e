#include <gtest/gtest.h>

#include <algorithm>
#include <atomic>
#include <cmath>
#include <cstdlib>
#include <filesystem>
#include <string>
#include <vector>

#include "ibrdf/base/pi.h"
#include "ibrdf/io/exr.h"
#include "ibrdf/solvers/bench/results_table.h"
#include "ibrdf/solvers/entropy_study/best_view_sweep.h"
#include "ibrdf/solvers/entropy_study/entropy_sweep.h"
#include "ibrdf/solvers/entropy_study/evaluator_variants.h"
#include "ibrdf/solvers/entropy_study/study_cases.h"
#include "tests/support/temp_dir.h"

namespace ibrdf {
namespace {

// Radiance 1, with `peak` in one texel beside the equator.
Image PeakedMap(float peak) {
  Image map(32, 16);
  std::fill(map.rgb.begin(), map.rgb.end(), 1.0f);
  for (int c = 0; c < 3; ++c) map.At(20, 7)[c] = peak;
  return map;
}

class StudySweepTest : public ::testing::Test {
 protected:
  StudySweepTest() {
    std::filesystem::create_directories(dir_.File("maps"));
    for (const auto& [name, peak] :
         {std::pair("a", 90.0f), std::pair("b", 1.0f), std::pair("c", 9.0f)}) {
      CHECK(WriteExr(PeakedMap(peak),
                     dir_.File(std::string("maps/") + name + ".exr"))
                .ok());
    }
    options_.data = dir_.path();
    options_.maps = dir_.File("maps");
    options_.out = dir_.File("out");
    options_.shapes = {"sphere", "torus"};
    options_.num_texels = 8;
    options_.num_threads = 1;
  }
  std::vector<ResultsRow> Rows(const std::vector<std::string>& columns) const {
    return ReadResults(dir_.File("out/results.csv"), columns).value();
  }

  TempDir dir_;
  StudyOptions options_;
};

TEST_F(StudySweepTest, MapsAreSortedAndTakeShapesInTurn) {
  options_.rounds = 2;
  const std::vector<StudyCase> cases = ListStudyCases(options_).value();
  ASSERT_EQ(6u, cases.size());
  const char* const names[] = {"sphere_b", "torus_c",  "sphere_a",
                               "torus_b",  "sphere_c", "torus_a"};
  const MapKind kinds[] = {MapKind::kSoft, MapKind::kMedium, MapKind::kHard};
  for (size_t i = 0; i < 6; ++i) {
    EXPECT_EQ(names[i], cases[i].name);
    EXPECT_EQ(kinds[i % 3], cases[i].kind);
    EXPECT_EQ(1 + i, cases[i].seed);
  }
  options_.only_index = 2;
  options_.only_count = 4;
  const std::vector<StudyCase> some = ListStudyCases(options_).value();
  ASSERT_EQ(2u, some.size());
  EXPECT_EQ("torus_c", some[0].name);
  EXPECT_EQ(6u, some[1].seed);
}

TEST_F(StudySweepTest, BrightestShareIsThatOfOneHundredth) {
  EXPECT_NEAR(0.01, BrightestShare(PeakedMap(1.0f)), 1e-6);
  // A texel beside the equator, as a share of the sphere.
  const double texel = std::sin(kPi / 16.0) / 64.0, peak = 90.0;
  EXPECT_NEAR((peak * texel + 0.01 - texel) / (peak * texel + 1.0 - texel),
              BrightestShare(PeakedMap(90.0f)), 1e-4);
}

TEST_F(StudySweepTest, EntropyHasARowForEachEvaluatorAndGoesOn) {
  options_.map_names = {"a"};
  ASSERT_TRUE(RunEntropySweep(options_).ok());
  const size_t evaluators = EvaluatorVariants().size() + 2;
  std::vector<ResultsRow> rows = Rows(EntropyColumns());
  ASSERT_EQ(evaluators, rows.size());
  EXPECT_EQ("trivial", rows[0][2]);
  for (const auto& [name, values] :
       ValuesByName(EntropyColumns(), rows, "pearson")) {
    ASSERT_EQ(1u, values.size());
    EXPECT_LE(std::abs(values[0]), 1.0) << name;
  }
  // As a kill in the middle of a scene leaves it.
  const std::string path = dir_.File("out/results.csv");
  const std::string whole = ReadBytes(path);
  WriteBytes(path, whole.substr(0, whole.size() / 2));
  ASSERT_TRUE(RunEntropySweep(options_).ok());
  rows = Rows(EntropyColumns());
  EXPECT_EQ(evaluators, rows.size());
  EXPECT_NE(std::string::npos,
            ReadBytes(dir_.File("out/results.md")).find("| angular | "));
}

TEST_F(StudySweepTest, BestViewsReachTheGoalAndTheOracleIsNoWorse) {
  options_.oracle = true;
  options_.map_names = {"a", "c"};
  ASSERT_TRUE(RunBestViewSweep(options_).ok());
  const std::vector<ResultsRow> rows = Rows(BestViewColumns());
  const ColumnByName views =
      ValuesByName(BestViewColumns(), rows, "views_that_reach_20");
  EXPECT_EQ("oracle", views[0].first);
  EXPECT_EQ("best view", views[1].first);
  const ColumnByName entropy =
      ValuesByName(BestViewColumns(), rows, "entropy_best");
  for (const auto& [name, values] : views) {
    ASSERT_EQ(2u, values.size());
    for (const double count : values) {
      EXPECT_TRUE(count >= 10.0 && count <= 20.0) << name;
    }
  }
  for (size_t i = 0; i < 2; ++i) {
    EXPECT_LT(entropy[0].second[i], entropy[1].second[i] + 1e-9);
  }
  EXPECT_NE(std::string::npos,
            ReadBytes(dir_.File("out/results.md")).find("2 of 2"));
}

TEST_F(StudySweepTest, BadInputIsOneLine) {
  const auto message = [&] {
    const Status status = RunEntropySweep(options_);
    EXPECT_EQ(2, status.ExitCode());
    EXPECT_EQ(std::string::npos, status.message().find('\n'));
    return status.message();
  };
  options_.map_names = {"none"};
  EXPECT_NE(std::string::npos, message().find("none"));
  options_.map_names = {"a"};
  options_.shapes = {"cow"};
  EXPECT_NE(std::string::npos, message().find("cow"));
  options_.shapes = {"sp,here"};
  EXPECT_NE(std::string::npos, message().find("without comma"));
  options_.shapes = {};
  EXPECT_NE(std::string::npos, message().find("--shapes"));
  options_.shapes = {"sphere"};
  CHECK(WriteExr(Image(8, 4), dir_.File("maps/black.exr")).ok());
  options_.map_names = {"black"};
  EXPECT_NE(std::string::npos, message().find("black.exr"));
  options_.maps = dir_.File("nowhere");
  options_.map_names = {};
  EXPECT_NE(std::string::npos, message().find("nowhere"));
}

TEST_F(StudySweepTest, StopsBetweenScenes) {
  const std::atomic<bool> stop{true};
  options_.stop = &stop;
  EXPECT_EQ(StatusCode::kInterrupted, RunEntropySweep(options_).code());
}

}  // namespace
}  // namespace ibrdf
