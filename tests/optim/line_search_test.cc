#include "ibrdf/solvers/optim/line_search.h"

#include <gtest/gtest.h>

#include <cmath>
#include <functional>
#include <limits>
#include <vector>

namespace ibrdf {
namespace {

// Lengths tried for a gain of cost, accepted below `enough`.
struct Tried {
  std::vector<double> lengths;
  double found = -1.0;
};
Tried Search(double longest, double shortest, double slope, double enough,
             const std::function<double(double)>& gain) {
  Tried tried;
  tried.found = LineSearch(longest, shortest, slope, [&](double length) {
    tried.lengths.push_back(length);
    return LineSearchTrial{gain(length), length <= enough};
  });
  return tried;
}

TEST(LineSearch, TakesTheLongestWhereItIsGood) {
  const Tried tried = Search(0.75, 0.1, 1.0, 1.0, [](double) { return -3.0; });
  EXPECT_EQ(0.75, tried.found);
  EXPECT_EQ(std::vector<double>{0.75}, tried.lengths);
}

// A quadratic cost, -2 s + 2 s^2, lowest at 1/2: 2 s - 2 s^2 are its gains.
TEST(LineSearch, SecondLengthIsTheLowestPointOfAParabola) {
  for (const double longest : {1.25, 2.0, 4.0}) {
    const Tried tried = Search(longest, 1e-3, 2.0, 0.6,
                               [](double s) { return 2.0 * s - 2.0 * s * s; });
    ASSERT_EQ(2u, tried.lengths.size());
    EXPECT_DOUBLE_EQ(0.5, tried.lengths[1]);
    EXPECT_EQ(tried.lengths[1], tried.found);
  }
}

TEST(LineSearch, ShortensByATenthToAHalf) {
  // A loss of 1e6 would be followed by next to nothing, a gain of nearly the
  // slope's promise by more than the last.
  const Tried loss = Search(1.0, 1e-9, 1.0, 0.15, [](double) { return -1e6; });
  EXPECT_EQ((std::vector<double>{1.0, 0.1}), loss.lengths);
  const Tried gain =
      Search(1.0, 1e-9, 1.0, 0.3, [](double s) { return 0.9 * s; });
  EXPECT_EQ((std::vector<double>{1.0, 0.5, 0.25}), gain.lengths);
}

TEST(LineSearch, GoesOnByTenthsWhereThereIsNoCost) {
  for (const double none : {-std::numeric_limits<double>::infinity(),
                            std::numeric_limits<double>::infinity(),
                            std::numeric_limits<double>::quiet_NaN()}) {
    const Tried tried =
        Search(1.0, 1e-9, 1.0, 0.02, [&](double) { return none; });
    ASSERT_EQ(3u, tried.lengths.size());
    EXPECT_DOUBLE_EQ(0.01, tried.found);
  }
}

TEST(LineSearch, GivesUpAtTheShortest) {
  const Tried tried = Search(1.0, 0.1, 1.0, -1.0, [](double) { return 0.0; });
  EXPECT_EQ(0.0, tried.found);
  EXPECT_EQ((std::vector<double>{1.0, 0.5, 0.25, 0.125}), tried.lengths);
  EXPECT_TRUE(
      Search(0.1, 0.1, 1.0, 1.0, [](double) { return 0.0; }).lengths.empty());
}

}  // namespace
}  // namespace ibrdf
