#include "ibrdf/base/fast_atan2.h"

#include <gtest/gtest.h>

#include <cmath>
#include <random>

namespace ibrdf {
namespace {

TEST(FastAtan2, StaysWithinItsPromise) {
  std::mt19937 rng(1);
  std::uniform_real_distribution<double> angle(-3.14159, 3.14159);
  std::uniform_real_distribution<double> size(-20.0, 20.0);
  for (int i = 0; i < 100000; ++i) {
    const double a = angle(rng), r = std::exp2(size(rng));
    const double y = r * std::sin(a), x = r * std::cos(a);
    EXPECT_NEAR(std::atan2(y, x), FastAtan2(y, x), 2e-9);
    const auto fy = static_cast<float>(y), fx = static_cast<float>(x);
    EXPECT_NEAR(std::atan2(fy, fx), FastAtan2(fy, fx), 4e-7);
  }
}

TEST(FastAtan2, SmallAnglesAreRelativelyExact) {
  for (const double t : {1e-3, 1e-9, 1e-30}) {
    EXPECT_NEAR(1.0, FastAtan2(t, 1.0) / std::atan(t), 4e-9);
  }
}

TEST(FastAtan2, AxesAndOrigin) {
  EXPECT_EQ(0.0, FastAtan2(0.0, 0.0));
  EXPECT_EQ(0.0f, FastAtan2(0.0f, 0.0f));
  EXPECT_EQ(0.0, FastAtan2(0.0, 2.0));
  EXPECT_DOUBLE_EQ(std::acos(0.0), FastAtan2(1.0, 0.0));
  EXPECT_DOUBLE_EQ(-std::acos(0.0), FastAtan2(-1.0, 0.0));
  EXPECT_DOUBLE_EQ(std::acos(-1.0), FastAtan2(0.0, -3.0));
}

}  // namespace
}  // namespace ibrdf
