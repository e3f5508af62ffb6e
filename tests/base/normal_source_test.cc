#include "ibrdf/base/normal_source.h"

#include <gtest/gtest.h>

namespace ibrdf {
namespace {

// The first numbers of two seeds: networks and images made from one hold them.
TEST(NormalSource, SeedsKeepTheirNumbers) {
  NormalSource zero(0), seven(7);
  for (const float v : {1.91280448f, -2.07940793f, 1.0357269f}) {
    EXPECT_EQ(v, zero.Next());
  }
  for (const float v : {0.713029861f, 1.61055636f, 1.86106396f}) {
    EXPECT_EQ(v, seven.Next());
  }
}

TEST(DoubleNormalSource, SeedsKeepTheirNumbers) {
  DoubleNormalSource zero(0), seven(7);
  for (const double v :
       {0.58937880373630924, -0.23249007105176506, 1.1704404331107556}) {
    EXPECT_DOUBLE_EQ(v, zero.Next());
  }
  for (const double v :
       {1.5913998756469563, 0.38890323470535709, 0.51917236460282778}) {
    EXPECT_DOUBLE_EQ(v, seven.Next());
  }
}

template <typename Source>
class NormalSources : public ::testing::Test {};
using Sources = ::testing::Types<NormalSource, DoubleNormalSource>;
TYPED_TEST_SUITE(NormalSources, Sources);

// Moments of 100000 numbers, to four standard errors: sqrt(1 / n) of the mean,
// sqrt(2 / n) of the variance, sqrt(96 / n) of the fourth moment.
TYPED_TEST(NormalSources, MomentsAreTheNormals) {
  constexpr int kCount = 100000;
  TypeParam source(3);
  double mean = 0.0, square = 0.0, fourth = 0.0;
  for (int i = 0; i < kCount; ++i) {
    const double x = source.Next();
    mean += x / kCount;
    square += x * x / kCount;
    fourth += x * x * x * x / kCount;
  }
  EXPECT_NEAR(0.0, mean, 0.013);
  EXPECT_NEAR(1.0, square, 0.018);
  EXPECT_NEAR(3.0, fourth, 0.13);
}

}  // namespace
}  // namespace ibrdf
