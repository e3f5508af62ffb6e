#include "ibrdf/solvers/estimation/material_ranking.h"

#include <gtest/gtest.h>

#include <cmath>
#include <limits>

namespace ibrdf {
namespace {

MaterialCandidate Candidate(const std::string& name, double cost) {
  MaterialCandidate candidate;
  candidate.name = name;
  candidate.screen_cost = cost;
  return candidate;
}

TEST(MaterialRanking, EqualCostsShareEvenly) {
  const MaterialRanking ranking =
      RankMaterials({Candidate("a", -700.0), Candidate("b", -700.0),
                     Candidate("c", 1e300), Candidate("d", -700.0),
                     Candidate("e", std::numeric_limits<double>::infinity())});
  ASSERT_EQ(5u, ranking.materials.size());
  EXPECT_NEAR(3.0, ranking.effective_number(), 1e-12);
  EXPECT_NEAR(std::log(3.0), ranking.entropy, 1e-12);
  EXPECT_EQ("a", ranking.materials[0].name);
  EXPECT_NEAR(1 / 3.0, ranking.materials[2].weight, 1e-15);
  EXPECT_EQ(0.0, ranking.materials[3].weight);
}

TEST(MaterialRanking, OneFarBelowIsAllThereIs) {
  const MaterialRanking ranking =
      RankMaterials({Candidate("a", 50.0), Candidate("b", 0.0)});
  EXPECT_EQ("b", ranking.materials[0].name);
  EXPECT_NEAR(1.0, ranking.effective_number(), 1e-12);
}

TEST(MaterialRanking, OfNothingIsEmpty) {
  EXPECT_TRUE(RankMaterials({}).materials.empty());
  EXPECT_EQ(0.0, RankMaterials({}).effective_number());
  EXPECT_TRUE(
      RankMaterials({Candidate("a", std::numeric_limits<double>::infinity())})
          .materials.empty());
}

}  // namespace
}  // namespace ibrdf
