#include "ibrdf/solvers/report/readable_numbers.h"

#include <gtest/gtest.h>

#include <cmath>
#include <limits>

namespace ibrdf {
namespace {

TEST(ShortNumber, HasFourDigitsAndNoExponentWhereAvoidable) {
  EXPECT_EQ("0.02513", ShortNumber(0.025134));
  EXPECT_EQ("120", ShortNumber(120.0));
  EXPECT_EQ("-3", ShortNumber(-3.0));
  EXPECT_EQ("2073", ShortNumber(2073.4));
  EXPECT_EQ("23232", ShortNumber(23231.7));
  EXPECT_EQ("123456789", ShortNumber(123456789.0));
  EXPECT_EQ("1.5e+09", ShortNumber(1.5e9));
  EXPECT_EQ("3.262e-130", ShortNumber(3.262e-130));
  EXPECT_EQ("-", ShortNumber(std::numeric_limits<double>::infinity()));
  EXPECT_EQ("-", ShortNumber(std::nan("")));
}

TEST(RoundUp, IsTheNextOfOneTwoAndFive) {
  EXPECT_DOUBLE_EQ(0.2, RoundUp(0.11));
  EXPECT_DOUBLE_EQ(0.2, RoundUp(0.2));
  EXPECT_DOUBLE_EQ(5.0, RoundUp(2.001));
  EXPECT_DOUBLE_EQ(10.0, RoundUp(7.0));
  EXPECT_DOUBLE_EQ(1000.0, RoundUp(1000.0));
}

}  // namespace
}  // namespace ibrdf
