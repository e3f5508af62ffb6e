#include "ibrdf/solvers/marginal/best_of_searches.h"

#include <gtest/gtest.h>

#include <limits>
#include <string>
#include <utility>
#include <vector>

namespace ibrdf {
namespace {

constexpr double kDropped = std::numeric_limits<double>::infinity();

MaterialCandidate Candidate(const std::string& name, double cost,
                            double first_cost) {
  MaterialCandidate candidate;
  candidate.name = name;
  candidate.cost = cost;
  candidate.first_cost = first_cost;
  candidate.parameters = {cost};
  candidate.light_level.setConstant(cost);
  return candidate;
}

// Found from the first of the candidates.
ReflectanceSearchResult Result(size_t model, int map_width,
                               std::vector<MaterialCandidate> candidates) {
  ReflectanceSearchResult result;
  result.model = model;
  result.map_width = map_width;
  result.cost = candidates.front().cost;
  result.initial_guess = candidates.front().name;
  result.parameters = candidates.front().parameters;
  result.candidates = std::move(candidates);
  return result;
}

TEST(BestOfSearches, IsTheOptimumOfLessCost) {
  const ReflectanceSearchResult brass =
      Result(0, 32, {Candidate("brass", -10.0, 5.0)});
  const ReflectanceSearchResult paint =
      Result(0, 32, {Candidate("paint", -30.0, 7.0)});
  for (const auto& best :
       {BestOfSearches({brass}, {paint}), BestOfSearches({paint}, {brass})}) {
    ASSERT_EQ(1u, best.size());
    EXPECT_EQ(-30.0, best[0].cost);
    EXPECT_EQ("paint", best[0].initial_guess);
    EXPECT_EQ(paint.parameters, best[0].parameters);
  }
  EXPECT_EQ("brass", BestOfSearches({brass}, {brass})[0].initial_guess);
}

// A material's rank stays the first search's, whichever found its optimum.
TEST(BestOfSearches, CandidatesAreTheBetterOfEachMaterial) {
  const std::vector<ReflectanceSearchResult> best =
      BestOfSearches({Result(0, 32,
                             {Candidate("brass", -10.0, 5.0),
                              Candidate("paint", -8.0, 7.0),
                              Candidate("felt", kDropped, 3.0),
                              Candidate("wood", kDropped, 4.0)})},
                     {Result(0, 32,
                             {Candidate("paint", -30.0, 1.0),
                              Candidate("wood", -9.0, 2.0),
                              Candidate("brass", -9.0, 1.0),
                              Candidate("felt", kDropped, 2.0)})});
  ASSERT_EQ(1u, best.size());
  EXPECT_EQ("paint", best[0].initial_guess);
  const std::vector<MaterialCandidate>& all = best[0].candidates;
  const std::vector<MaterialCandidate> expected = {
      Candidate("paint", -30.0, 7.0), Candidate("brass", -10.0, 5.0),
      Candidate("wood", -9.0, 4.0), Candidate("felt", kDropped, 3.0)};
  ASSERT_EQ(expected.size(), all.size());
  for (size_t k = 0; k < all.size(); ++k) {
    EXPECT_EQ(expected[k].name, all[k].name);
    EXPECT_EQ(expected[k].cost, all[k].cost) << all[k].name;
    EXPECT_EQ(expected[k].first_cost, all[k].first_cost) << all[k].name;
    EXPECT_EQ(expected[k].parameters, all[k].parameters) << all[k].name;
    EXPECT_EQ(expected[k].light_level[0], all[k].light_level[0]);
  }
}

TEST(BestOfSearches, AModelOfOneSearchAloneIsKeptInOrder) {
  const ReflectanceSearchResult first =
      Result(1, 32, {Candidate("brass", -10.0, 5.0)});
  const ReflectanceSearchResult other =
      Result(0, 32, {Candidate("paint", -3.0, 7.0)});
  const std::vector<ReflectanceSearchResult> best =
      BestOfSearches({first}, {other});
  ASSERT_EQ(2u, best.size());
  EXPECT_EQ(0u, best[0].model);
  EXPECT_EQ("paint", best[0].initial_guess);
  EXPECT_EQ(1u, best[1].model);
  EXPECT_EQ("brass", best[1].initial_guess);
}

// Costs of two resolutions do not compare.
TEST(BestOfSearches, ASearchThatEndedCoarserCountsForNothing) {
  const ReflectanceSearchResult fine =
      Result(0, 32, {Candidate("brass", -10.0, 5.0)});
  const ReflectanceSearchResult coarse =
      Result(0, 24, {Candidate("paint", -300.0, 7.0)});
  for (const auto& best :
       {BestOfSearches({fine}, {coarse}), BestOfSearches({coarse}, {fine})}) {
    ASSERT_EQ(1u, best.size());
    EXPECT_EQ("brass", best[0].initial_guess);
    ASSERT_EQ(1u, best[0].candidates.size());
  }
}

}  // namespace
}  // namespace ibrdf
