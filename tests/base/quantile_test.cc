#include "ibrdf/base/quantile.h"

#include <gtest/gtest.h>

namespace ibrdf {
namespace {

TEST(Quantile, InterpolatesBetweenOrderStatistics) {
  EXPECT_EQ(3.0, Quantile({3.0}, 0.05));
  EXPECT_EQ(2.0, Quantile({3.0, 1.0, 2.0}, 0.5));
  EXPECT_NEAR(1.1, Quantile({3.0, 1.0, 2.0}, 0.05), 1e-12);
  EXPECT_NEAR(6.5, Quantile({9.0, 1.0, 4.0, 3.0}, 5.0 / 6.0), 1e-12);
  EXPECT_EQ(1.0, Quantile({3.0, 1.0, 2.0}, 0.0));
  EXPECT_EQ(3.0, Quantile({3.0, 1.0, 2.0}, 1.0));
}

}  // namespace
}  // namespace ibrdf
