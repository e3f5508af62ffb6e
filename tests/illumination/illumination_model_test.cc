#include "ibrdf/solvers/illumination/illumination_model.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <memory>
#include <random>

#include "tests/support/solver_testing.h"

namespace ibrdf {
namespace {
using namespace testing;  // NOLINT

constexpr int kTexels = 8 * 16;

class IlluminationModelTest : public ::testing::TestWithParam<bool> {
 protected:
  std::vector<float> Forward(const std::vector<float>& parameters) {
    std::vector<float> map(model_->num_outputs());
    model_->Forward(parameters.data(), map.data());
    return map;
  }
  const std::unique_ptr<IlluminationModel> model_ =
      GetParam() ? MakeUnetIllumination(TinyUnetOptions())
                 : MakeFreeIllumination(16, 8);
};

TEST_P(IlluminationModelTest, ShiftMovesEachChannelByItsOwnAmount) {
  const double zero[3] = {0, 0, 0}, shift[3] = {0.5, -2.0, 7.25};
  std::vector<float> p = model_->ConstantMap(zero);
  const std::vector<float> std = model_->PriorStd();
  std::mt19937 rng(2);
  std::normal_distribution<float> gauss;
  for (size_t i = 0; i < p.size(); ++i) {
    // The biases of a map's level have a wide prior: less of it.
    p[i] += 0.3f * std::min(std[i], 3.0f) * gauss(rng);
  }
  const std::vector<float> before = Forward(p);
  model_->ShiftChannels(shift, p.data());
  const std::vector<float> after = Forward(p);
  for (int i = 0; i < model_->num_outputs(); ++i) {
    // Two roundings of numbers of size up to 10.
    EXPECT_NEAR(before[i] + shift[i / kTexels], after[i], 4e-6);
  }
}

TEST_P(IlluminationModelTest, ConstantMapIsConstant) {
  const double level[3] = {0.5, -2.0, 1.0};
  const std::vector<float> p = model_->ConstantMap(level);
  ASSERT_EQ(model_->num_parameters(), static_cast<int>(p.size()));
  const std::vector<float> map = Forward(p);
  for (int i = 0; i < model_->num_outputs(); ++i) {
    EXPECT_FLOAT_EQ(static_cast<float>(level[i / kTexels]), map[i]);
  }
}

INSTANTIATE_TEST_SUITE_P(Models, IlluminationModelTest, ::testing::Bool(),
                         [](const ::testing::TestParamInfo<bool>& p) {
                           return p.param ? "Unet" : "Free";
                         });

TEST(ToRadianceMap, PlanesBecomePixelsWithoutOverflow) {
  std::vector<float> map;
  ToRadianceMap({0, 1, -1000, 2, 1000, 3}, &map);  // two texels
  ASSERT_EQ(6u, map.size());
  EXPECT_FLOAT_EQ(1.0f, map[0]);
  EXPECT_GT(map[1], 0.0f);
  EXPECT_LT(map[1], 1e-20f);
  EXPECT_GT(map[2], 1e20f);
  EXPECT_TRUE(std::isfinite(map[2]));
  EXPECT_FLOAT_EQ(std::exp(1.0f), map[3]);
  EXPECT_FLOAT_EQ(std::exp(2.0f), map[4]);
  EXPECT_FLOAT_EQ(std::exp(3.0f), map[5]);
  // Slopes are the values but where those are clamped.
  std::vector<float> again, slopes;
  ToRadianceMap({0, 1, -1000, 2, 1000, 3}, &again, &slopes);
  EXPECT_EQ(map, again);
  map[1] = map[2] = 0.0f;
  EXPECT_EQ(map, slopes);
}

}  // namespace
}  // namespace ibrdf
