#include "ibrdf/solvers/training/analytic_materials.h"

#include <gtest/gtest.h>

#include <cmath>

namespace ibrdf {
namespace {

MerlTable Table(double scale) {
  MerlTable table;
  table.raw.resize(3 * kMerlBins);
  for (size_t i = 0; i < table.raw.size(); ++i) {
    table.raw[i] = scale * (1.0 + static_cast<double>(i % 97));
  }
  return table;
}

class AnalyticMaterialsTest : public ::testing::Test {
 protected:
  const std::vector<int> columns_ = DrawColumns(20, 3);
  TrainingData data_ = ColumnsOfTable(columns_);

  AnalyticMaterialsTest() {
    AddTable(Table(1.0), columns_, "a", &data_);
    AddTable(Table(1e3), columns_, "b", &data_);
  }
};

TEST_F(AnalyticMaterialsTest, AnalyticMaterialsAreTheModelAtTheBins) {
  AddAnalyticMaterials(3, 5, &data_);
  ASSERT_EQ(size_t{6 + 9}, data_.names.size());
  EXPECT_EQ("analytic-001.green", data_.names[6 + 4]);
  ASSERT_EQ(size_t{15} * 20 * kMerlThetaH, data_.log_raw.size());
  const Disney brdf = RandomDisney(5 * 1000003 + 1);
  const int column = 7;
  const double theta_d = MerlThetaD(columns_[column] / kMerlPhiD);
  const double phi_d = MerlPhiD(columns_[column] % kMerlPhiD);
  for (int i = 0; i < data_.count[column]; i += 5) {
    const double raw =
        brdf.Evaluate(MerlThetaH(i), theta_d, phi_d)[1] / kMerlScale[1];
    // Angles went through floats: steep lobes see that.
    EXPECT_NEAR(std::log(raw + kLogFloor), data_.LogRaw(10, column)[i], 1e-3);
  }
}

TEST_F(AnalyticMaterialsTest, RandomMaterialsSpanTheirRanges) {
  int metals = 0;
  double least = 1.0, most = 0.0;
  for (int seed = 0; seed < 200; ++seed) {
    const Disney brdf = RandomDisney(seed);
    metals += brdf.metallic == 1.0;
    least = std::min(least, brdf.roughness);
    most = std::max(most, brdf.roughness);
    EXPECT_TRUE((brdf.base >= 0.003 - 1e-12).all() &&
                (brdf.base <= 0.98).all());
  }
  EXPECT_GT(metals, 60);
  EXPECT_LT(metals, 140);
  EXPECT_LT(least, std::sqrt(0.015));
  EXPECT_GT(most, std::sqrt(0.5));
}

}  // namespace
}  // namespace ibrdf
