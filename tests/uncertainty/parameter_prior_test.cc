#include "ibrdf/uncertainty/parameter_prior.h"

#include <gtest/gtest.h>

#include <cmath>
#include <fstream>
#include <sstream>
#include <string>
#include <vector>

#include "ibrdf/uncertainty/measured_materials.h"
#include "ibrdf/uncertainty/reflection_filter.h"

namespace ibrdf {
namespace {

TEST(PriorOfMaterials, CountsByTheNearestCell) {
  const std::vector<double> prior = PriorOfMaterials(
      {0.0, 0.3, 0.9}, {0.1, 0.1, 2.0}, {0.0, 0.25, 1.0}, {0.0, 1.0}, 0.5);
  EXPECT_EQ((std::vector<double>{1.5, 0.5, 1.5, 0.5, 0.5, 1.5}), prior);
}

// The table in the code is that of the experiment.
TEST(MeasuredMaterials, AreTheRowsOfTheExperiment) {
  std::ifstream file(std::string(IBRDF_SOURCE_DIR) +
                     "/experiments/entropy/materials.csv");
  std::string line;
  ASSERT_TRUE(std::getline(file, line));
  EXPECT_EQ(0u, line.find("material,roughness,ks_red,ks_green,ks_blue,"));
  size_t row = 0;
  while (std::getline(file, line)) {
    ASSERT_LT(row, MeasuredMaterials().size());
    const MeasuredMaterial& m = MeasuredMaterials()[row++];
    std::istringstream cells(line);
    std::string cell;
    std::getline(cells, cell, ',');
    for (const double value : {m.roughness, m.Ks[0], m.Ks[1], m.Ks[2]}) {
      std::getline(cells, cell, ',');
      // Four digits.
      EXPECT_NEAR(std::stod(cell), value, 1e-3 * value) << line;
      EXPECT_TRUE(value >= 0.0 && value <= 1.0) << line;
    }
  }
  EXPECT_EQ(100u, row);
}

TEST(MeasuredMaterials, CountInCellsAndRuleNoneOut) {
  const std::vector<double> alpha =
      AlphaValues(AlphaGrid::kUniformRoughness, 8);
  const std::vector<double> prior =
      PriorOfMeasuredMaterials(alpha, UnitValues(8));
  ASSERT_EQ(64u, prior.size());
  double sum = 0.0;
  for (const double p : prior) {
    EXPECT_GE(p, 1.0);
    sum += p;
  }
  EXPECT_EQ(300.0 + 64.0, sum);
  EXPECT_TRUE(CheckPrior(prior, 64).ok());
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
