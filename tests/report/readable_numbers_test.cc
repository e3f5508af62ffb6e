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

TEST(ErrorInWords, RoundsForPeople) {
  EXPECT_EQ("less than 1 %", ErrorInWords(5.739e-8));
  EXPECT_EQ("some 7 %", ErrorInWords(0.0712));
  EXPECT_EQ("some 15 %", ErrorInWords(-0.157));
  EXPECT_EQ("some 30 %", ErrorInWords(0.32));
  EXPECT_EQ("a factor of 1.5", ErrorInWords(0.43));
  EXPECT_EQ("a factor of 2.5", ErrorInWords(0.88));
  EXPECT_EQ("a factor of 5", ErrorInWords(kLargestKnownError));
  EXPECT_EQ("not determined", ErrorInWords(std::log(58.87)));
  EXPECT_EQ("not determined", ErrorInWords(std::nan("")));
}

TEST(RoundNumber, HasTwoDigits) {
  EXPECT_EQ("17000", RoundNumber(17137.0));
  EXPECT_EQ("3.1", RoundNumber(3.13));
  EXPECT_EQ("0.032", RoundNumber(0.0318));
  EXPECT_EQ("-100", RoundNumber(-99.7));
  EXPECT_EQ("below 0.001", RoundNumber(5.739e-8));
  EXPECT_EQ("0", RoundNumber(0.0));
  EXPECT_EQ("-", RoundNumber(std::nan("")));
}

TEST(ProbabilityInWords, IsARatioOrEqual) {
  EXPECT_EQ("as probable", ProbabilityInWords(0.0));
  EXPECT_EQ("as probable", ProbabilityInWords(0.04));
  EXPECT_EQ("0.9 times as probable", ProbabilityInWords(0.11));
  EXPECT_EQ("0.05 times as probable", ProbabilityInWords(3.0));
  EXPECT_EQ("below 0.001 times as probable", ProbabilityInWords(40.0));
  EXPECT_EQ("below 0.001 times as probable", ProbabilityInWords(1e4));
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
