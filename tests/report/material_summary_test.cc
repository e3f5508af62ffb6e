#include "ibrdf/solvers/report/material_summary.h"

#include <gtest/gtest.h>

#include <cmath>

namespace ibrdf {
namespace {

MerlTable Constant(double value) {
  MerlTable table;
  table.raw.assign(size_t{3} * kMerlBins, value);
  return table;
}

TEST(ReflectanceShares, ALambertianSurfaceIsDiffuse) {
  const ReflectanceShares shares = SharesOf(Constant(30.0));
  EXPECT_NEAR(1.0, shares.diffuse, 1e-3);
  EXPECT_NEAR(1.0, shares.diffuse + shares.specular, 1e-12);
}

TEST(ReflectanceShares, APeakAtTheMirrorDirectionIsSpecular) {
  MerlTable table = Constant(0.0);
  for (size_t k = 0; k < table.raw.size(); ++k) {
    const int theta_h = static_cast<int>(k % kMerlBins) / (90 * 180);
    table.raw[k] = theta_h < 30 ? 100.0 : 1.0;  // within 10 degrees
  }
  const ReflectanceShares shares = SharesOf(table);
  // The cone of light within 20 degrees of the mirror direction has the
  // projected solid angle pi sin(20 deg)^2 cos(30 deg).
  const double cone = std::pow(std::sin(20.0 / 57.29578), 2) * std::cos(0.5236);
  EXPECT_NEAR(1.0 / (1.0 + 99.0 * cone), shares.diffuse, 0.02);
}

TEST(ReflectanceShares, AreNoNumbersWithoutLight) {
  EXPECT_TRUE(std::isnan(SharesOf(Constant(0.0)).diffuse));
  EXPECT_TRUE(std::isnan(SharesOf(Constant(std::nan(""))).specular));
  EXPECT_EQ("", MaterialWords(MaterialSummary()));
}

TEST(MaterialSummary, IsEmptyForAKnownReflectance) {
  const MaterialSummary summary =
      SummariseMaterial(InverseProblem(), Solution());
  EXPECT_TRUE(summary.nearest.empty());
  EXPECT_TRUE(std::isnan(summary.shares.diffuse));
}

TEST(MaterialSummary, WordsNameMaterialsAndShares) {
  MaterialSummary summary;
  summary.nearest = {{"gold-paint", 0.254}, {"brass", 0.31}};
  summary.shares = {0.61, 0.39};
  const std::string words = MaterialWords(summary);
  for (const char* part : {"gold-paint (0.25), brass (0.31).",
                           "61 % is diffuse", "39 % specular"}) {
    EXPECT_NE(std::string::npos, words.find(part)) << words;
  }
}

}  // namespace
}  // namespace ibrdf
