#include "ibrdf/solvers/segmentation/label_overlap.h"

#include <gtest/gtest.h>

namespace ibrdf {
namespace {

TEST(Agreement, IsBlindToNames) {
  const Labelling a{{0, 0, 1, 1, 2, 2}, 3};
  EXPECT_EQ(1.0, Agreement(a, a));
  EXPECT_EQ(1.0, Agreement(a, {{2, 2, 0, 0, 1, 1}, 3}));
  EXPECT_NEAR(5.0 / 6.0, Agreement(a, {{2, 2, 0, 0, 1, 0}, 3}), 1e-12);
  // One label has no partner.
  EXPECT_NEAR(4.0 / 6.0, Agreement(a, {{1, 1, 0, 0, 0, 0}, 2}), 1e-12);
  EXPECT_NEAR(4.0 / 6.0, Agreement({{1, 1, 0, 0, 0, 0}, 2}, a), 1e-12);
  EXPECT_EQ(1.0, Agreement({{}, 1}, {{}, 2}));
}

}  // namespace
}  // namespace ibrdf
