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

constexpr int kModelTexels = 8 * 16;

class IlluminationModelTest : public ::testing::TestWithParam<bool> {
 protected:
  std::vector<float> Forward(const std::vector<float>& parameters) {
    LogMap map;
    model_->Forward(parameters.data(), &map);
    return map.values();
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
    EXPECT_NEAR(before[i] + shift[i / kModelTexels], after[i], 4e-6);
  }
}

TEST_P(IlluminationModelTest, ConstantMapIsConstant) {
  const double level[3] = {0.5, -2.0, 1.0};
  const std::vector<float> p = model_->ConstantMap(level);
  ASSERT_EQ(model_->num_parameters(), static_cast<int>(p.size()));
  const std::vector<float> map = Forward(p);
  for (int i = 0; i < model_->num_outputs(); ++i) {
    EXPECT_FLOAT_EQ(static_cast<float>(level[i / kModelTexels]), map[i]);
  }
}

INSTANTIATE_TEST_SUITE_P(Models, IlluminationModelTest, ::testing::Bool(),
                         [](const ::testing::TestParamInfo<bool>& p) {
                           return p.param ? "Unet" : "Free";
                         });

}  // namespace
}  // namespace ibrdf
