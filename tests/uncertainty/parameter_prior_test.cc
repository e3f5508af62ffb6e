#include "ibrdf/uncertainty/parameter_prior.h"

#include <gtest/gtest.h>

#include <cmath>
#include <vector>

namespace ibrdf {
namespace {

TEST(PriorOfMaterials, CountsByTheNearestCell) {
  const std::vector<double> prior = PriorOfMaterials(
      {0.0, 0.3, 0.9}, {0.1, 0.1, 2.0}, {0.0, 0.25, 1.0}, {0.0, 1.0}, 0.5);
  EXPECT_EQ((std::vector<double>{1.5, 0.5, 1.5, 0.5, 0.5, 1.5}), prior);
}

TEST(PriorPenalty, IsTheNegativeLogarithm) {
  const std::vector<double> penalty = PriorPenalty({2.0, 4.0, 1.0});
  EXPECT_DOUBLE_EQ(std::log(2.0), penalty[0]);
  EXPECT_EQ(0.0, penalty[1]);
  EXPECT_DOUBLE_EQ(std::log(4.0), penalty[2]);
  EXPECT_TRUE(PriorPenalty({}).empty());
}

TEST(CheckPrior, NamesWhatIsWrong) {
  EXPECT_TRUE(CheckPrior({}, 4).ok());
  EXPECT_TRUE(CheckPrior({1.0, 2.0}, 2).ok());
  EXPECT_EQ(StatusCode::kInvalidInput, CheckPrior({1.0}, 2).code());
  EXPECT_EQ(StatusCode::kInvalidInput, CheckPrior({1.0, 0.0}, 2).code());
}

}  // namespace
}  // namespace ibrdf
