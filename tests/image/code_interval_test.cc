#include "ibrdf/image/code_interval.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <string>
#include <tuple>
#include <vector>

#include "tests/image/reference_curve.h"
#include "tests/support/non_finite.h"

namespace ibrdf {
namespace {

using testing::AllCurves;
using testing::Curve;
using testing::Describe;

// Intervals are wider than half a code by 1e-9 of it.
constexpr double kNear = 1e-8;

TEST(CodeIntervals, AreHalfACodeAround) {
  const CodeIntervals codes(ResponseCurve(), CodeLevels::OfBits(8));
  EXPECT_NEAR(99.5 / 255.0, codes.Interval(100).low, kNear);
  EXPECT_NEAR(100.5 / 255.0, codes.Interval(100).high, kNear);
  EXPECT_TRUE(codes.Interval(100).HasLow());
  EXPECT_TRUE(codes.Interval(100).HasHigh());
  EXPECT_FALSE(codes.Interval(100).IsExact());
  // sRGB of 8 bits, code 128: ((y + 0.055) / 1.055)^2.4 at 127.5 and 128.5.
  const CodeIntervals srgb(Curve(ResponseKind::kSrgb), CodeLevels::OfBits(8));
  EXPECT_NEAR(0.2140411405, srgb.Interval(128).low, kNear);
  EXPECT_NEAR(0.2176888476, srgb.Interval(128).high, kNear);
}

TEST(CodeIntervals, AreOpenWhereFilesEnd) {
  const CodeIntervals codes(ResponseCurve(), CodeLevels::OfBits(8));
  EXPECT_EQ(0.0, codes.Interval(0).low);
  EXPECT_FALSE(codes.Interval(0).HasLow());
  EXPECT_NEAR(0.5 / 255.0, codes.Interval(0).high, kNear);
  EXPECT_NEAR(254.5 / 255.0, codes.Interval(255).low, kNear);
  EXPECT_EQ(kInfinity, codes.Interval(255).high);
  EXPECT_FALSE(codes.Interval(255).HasHigh());
  EXPECT_FALSE(codes.Interval(255).IsMissing());
  EXPECT_TRUE(RadianceInterval().IsMissing());
  EXPECT_TRUE(RadianceInterval().Contains(1e-300));
  // One bit: darker or brighter.
  const CodeIntervals bit(ResponseCurve(), CodeLevels::OfBits(1));
  EXPECT_NEAR(0.5, bit.Interval(0).high, kNear);
  EXPECT_NEAR(0.5, bit.Interval(1).low, kNear);
}

TEST(CodeIntervals, StartAtBlackAndEndAtWhite) {
  CodeLevels video = CodeLevels::OfBits(10);
  video.black = 64.0;
  video.white = 940.0;
  const CodeIntervals codes(ResponseCurve(), video);
  for (const int code : {0, 30, 64}) {
    EXPECT_EQ(0.0, codes.Interval(code).low);
    EXPECT_NEAR(0.5 / 876.0, codes.Interval(code).high, kNear) << code;
  }
  EXPECT_NEAR(0.5 / 876.0, codes.Interval(65).low, kNear);
  EXPECT_NEAR(438.5 / 876.0, codes.Interval(502).high, kNear);
  for (const int code : {940, 941, 1023}) {
    EXPECT_NEAR(875.5 / 876.0, codes.Interval(code).low, kNear) << code;
    EXPECT_EQ(kInfinity, codes.Interval(code).high);
  }
  // A level between codes: the code above it may still be black.
  CodeLevels between = CodeLevels::OfBits(12);
  between.black = 511.75;
  const CodeIntervals raw(ResponseCurve(), between);
  EXPECT_EQ(0.0, raw.Interval(512).low);
  EXPECT_NEAR(0.75 / 3583.25, raw.Interval(512).high, kNear);
  EXPECT_NEAR(0.5 / 3583.25, raw.Interval(511).high, kNear);
}

TEST(CodeIntervals, ClipBelowWhiteKeepsTheScale) {
  CodeLevels levels = CodeLevels::OfBits(8);
  levels.clip = 250.0;
  const CodeIntervals codes(ResponseCurve(), levels);
  EXPECT_NEAR(249.5 / 255.0, codes.Interval(249).high, kNear);
  for (const int code : {250, 253, 255}) {
    EXPECT_NEAR(249.5 / 255.0, codes.Interval(code).low, kNear) << code;
    EXPECT_EQ(kInfinity, codes.Interval(code).high);
  }
}

TEST(CodeIntervals, StepsAreThoseOfTheCamera) {
  // 12 bits in a file of 16.
  CodeLevels levels = CodeLevels::OfBits(16);
  levels.step = 65535.0 / 4095.0;
  const CodeIntervals wide(ResponseCurve(), levels);
  const CodeIntervals own(ResponseCurve(), CodeLevels::OfBits(12));
  for (const int code : {0, 1, 7, 1000, 4094, 4095}) {
    const auto stored = static_cast<int>(std::lround(code * levels.step));
    const RadianceInterval a = own.Interval(code), b = wide.Interval(stored);
    // The stored code is itself rounded.
    EXPECT_NEAR(a.low, b.low, 0.51 / 65535.0) << code;
    ASSERT_EQ(a.HasHigh(), b.HasHigh());
    if (a.HasHigh()) {
      EXPECT_NEAR(a.high, b.high, 0.51 / 65535.0) << code;
    }
  }
}

TEST(CodeIntervals, ExposureDividesRadiance) {
  for (const double exposure : {1e-100, 1e-30, 0.25, 8.0, 1e30, 1e100}) {
    CodeLevels levels;
    const CodeIntervals one(Curve(ResponseKind::kSrgb), levels);
    levels.exposure = exposure;
    const CodeIntervals codes(Curve(ResponseKind::kSrgb), levels);
    for (int code = 0; code < 256; ++code) {
      EXPECT_DOUBLE_EQ(one.Interval(code).low / exposure,
                       codes.Interval(code).low);
      EXPECT_DOUBLE_EQ(one.Interval(code).high / exposure,
                       codes.Interval(code).high);
      EXPECT_EQ(code > 0, codes.Interval(code).HasLow());
      EXPECT_EQ(code < 255, codes.Interval(code).HasHigh());
    }
  }
}

// Neighbours meet, nothing is left out, and ends rise.
TEST(CodeIntervals, CoverAllRadiance) {
  for (const ResponseDefinition& definition : AllCurves()) {
    for (const int bits : {1, 8, 10, 12, 16}) {
      SCOPED_TRACE(Describe(definition) + ", " + std::to_string(bits));
      const CodeIntervals codes(ResponseCurve(definition),
                                CodeLevels::OfBits(bits));
      const int last = (1 << bits) - 1;
      EXPECT_EQ(0.0, codes.Interval(0).low);
      EXPECT_EQ(kInfinity, codes.Interval(last).high);
      for (int code = 0; code < last; ++code) {
        const RadianceInterval &a = codes.Interval(code),
                               &b = codes.Interval(code + 1);
        ASSERT_LT(a.low, a.high) << code;
        ASSERT_LE(b.low, a.high) << code;
        // By no more than 2e-9 of a code.
        ASSERT_GE(b.low, a.high - 1e-7 * (a.high - a.low)) << code;
        ASSERT_LT(a.low, b.low) << code;
      }
    }
  }
}

TEST(CodeIntervals, AreMissingWhereTheCurveNeverGets) {
  // Half of white at most, whatever the radiance.
  const ResponseCurve curve(
      {ResponseKind::kTable, {}, {{1e-3, 0.1}, {1e8, 0.5}}});
  const CodeIntervals codes(curve, CodeLevels::OfBits(8));
  EXPECT_TRUE(codes.Interval(126).HasHigh());
  EXPECT_TRUE(codes.Interval(127).HasLow());
  EXPECT_FALSE(codes.Interval(127).HasHigh());
  EXPECT_TRUE(codes.Interval(129).IsMissing());
  EXPECT_TRUE(codes.Interval(255).IsMissing());
  EXPECT_EQ(0.0, codes.Slopes(255).low);
  // ACES falls short of no code.
  const CodeIntervals aces(Curve(ResponseKind::kAces, 1.0),
                           CodeLevels::OfBits(16));
  EXPECT_TRUE(aces.Interval(65534).HasHigh());
  EXPECT_NEAR(7.24, aces.Interval(65535).low, 0.01);
}

TEST(CodeIntervals, SlopesAreThoseOfDifferences) {
  const std::vector<std::pair<ResponseKind, double>> curves = {
      {ResponseKind::kAces, 0.4},     {ResponseKind::kAces, 0.95},
      {ResponseKind::kPower, 2.2},    {ResponseKind::kPower, 1.0},
      {ResponseKind::kReinhard, 4.0}, {ResponseKind::kLog, 500.0}};
  for (const auto& [kind, parameter] : curves) {
    SCOPED_TRACE(NameOf(kind));
    CodeLevels levels = CodeLevels::OfBits(8);
    levels.exposure = 3.0;
    const double h = 1e-5 * parameter;
    const CodeIntervals below(Curve(kind, parameter - h), levels),
        here(Curve(kind, parameter), levels),
        above(Curve(kind, parameter + h), levels);
    const auto slope = [h](double a, double b) {
      return (std::log(b) - std::log(a)) / (2.0 * h);
    };
    for (int code = 0; code < 256; ++code) {
      const RadianceInterval &a = below.Interval(code),
                             &b = above.Interval(code);
      const LogEndSlopes found = here.Slopes(code);
      for (const auto& [is_there, expected, value] :
           {std::tuple(a.HasLow(), slope(a.low, b.low), found.low),
            std::tuple(a.HasHigh(), slope(a.high, b.high), found.high)}) {
        if (is_there) {
          ASSERT_NEAR(expected, value, 1e-6 * (1.0 + std::abs(expected)))
              << code;
        } else {
          ASSERT_EQ(0.0, value);
        }
      }
    }
  }
  const CodeIntervals srgb(Curve(ResponseKind::kSrgb), CodeLevels());
  EXPECT_EQ(0.0, srgb.Slopes(100).low);
}

TEST(FloatInterval, HasEqualEnds) {
  // Every bit of an HDR file stays.
  for (const double value : {1e-30, 0.1, 1.0, 3.7e9, 1e38}) {
    const RadianceInterval interval =
        FloatInterval(ResponseCurve(), 1.0, value);
    EXPECT_EQ(value, interval.low);
    EXPECT_TRUE(interval.IsExact());
    EXPECT_TRUE(interval.Contains(value));
  }
  const RadianceInterval srgb =
      FloatInterval(Curve(ResponseKind::kSrgb), 4.0, 0.5);
  EXPECT_NEAR(0.214041140482232442 / 4.0, srgb.low, 1e-15);
  EXPECT_EQ(srgb.low, srgb.high);
}

TEST(FloatInterval, IsMissingWhereNoRadianceHasTheValue) {
  for (const double value :
       {0.0, -0.0, -1.0, kInfinity, -kInfinity, std::nan("")}) {
    EXPECT_TRUE(FloatInterval(ResponseCurve(), 1.0, value).IsMissing());
    EXPECT_TRUE(
        FloatInterval(Curve(ResponseKind::kSrgb), 1.0, value).IsMissing());
  }
  // Above the limit of the curve.
  const ResponseCurve aces = Curve(ResponseKind::kAces, 1.0);
  EXPECT_TRUE(FloatInterval(aces, 1.0, 1.03).IsExact());
  EXPECT_TRUE(FloatInterval(aces, 1.0, 1.04).IsMissing());
  // Quotients that no double holds.
  EXPECT_TRUE(FloatInterval(ResponseCurve(), 1e100, 1e-300).IsMissing());
  EXPECT_TRUE(FloatInterval(ResponseCurve(), 1e-100, 1e300).IsMissing());
}

TEST(IntersectBrackets, TakesWhatAllAllow) {
  EXPECT_TRUE(IntersectBrackets({}).interval.IsMissing());
  // Clipped, useful, black.
  const BracketedInterval three =
      IntersectBrackets({{0.5, kInfinity}, {0.7, 0.9}, {0.0, 2.0}});
  EXPECT_EQ(0.7, three.interval.low);
  EXPECT_EQ(0.9, three.interval.high);
  EXPECT_EQ(0.0, three.contradiction);
  // Two open ends close each other; missing ones say nothing.
  const BracketedInterval two =
      IntersectBrackets({{0.5, kInfinity}, {}, {0.0, 2.0}});
  EXPECT_EQ(0.5, two.interval.low);
  EXPECT_EQ(2.0, two.interval.high);
  // Ends that touch leave one radiance.
  EXPECT_TRUE(IntersectBrackets({{1.0, 2.0}, {2.0, 3.0}}).interval.IsExact());
  EXPECT_EQ(0.0, IntersectBrackets({{1.0, 2.0}, {2.0, 3.0}}).contradiction);
}

TEST(IntersectBrackets, SaysHowFarFilesContradict) {
  const BracketedInterval apart =
      IntersectBrackets({{1.0, 2.0}, {3.0, 4.0}, {0.5, 8.0}});
  EXPECT_EQ(2.0, apart.interval.low);
  EXPECT_EQ(3.0, apart.interval.high);
  EXPECT_FALSE(apart.interval.IsEmpty());
  EXPECT_NEAR(std::log(1.5), apart.contradiction, 1e-15);
  // Clipped in one, black in another.
  const BracketedInterval open =
      IntersectBrackets({{4.0, kInfinity}, {0.0, 1.0}});
  EXPECT_EQ(1.0, open.interval.low);
  EXPECT_EQ(4.0, open.interval.high);
  EXPECT_NEAR(std::log(4.0), open.contradiction, 1e-15);
  // HDR files that differ.
  const BracketedInterval exact = IntersectBrackets({{1.0, 1.0}, {1.1, 1.1}});
  EXPECT_EQ(1.0, exact.interval.low);
  EXPECT_EQ(1.1, exact.interval.high);
  EXPECT_NEAR(std::log(1.1), exact.contradiction, 1e-15);
}

std::string FaultOf(CodeLevels levels) {
  const Status status = levels.Check("f: image");
  EXPECT_EQ(StatusCode::kInvalidInput, status.code());
  return status.message();
}

TEST(CodeLevels, WrongOnesAreNamed) {
  for (int bits = 1; bits <= 16; ++bits) {
    EXPECT_TRUE(CodeLevels::OfBits(bits).Check("").ok()) << bits;
  }
  EXPECT_EQ(65535.0, CodeLevels::OfBits(16).white);
  CodeLevels levels;
  levels.bits = 17;
  EXPECT_EQ("f: image: bits must be 1 to 16, not 17", FaultOf(levels));
  levels = {};
  levels.black = 255.0;
  EXPECT_EQ("f: image: black must be in [0, 255), not 255", FaultOf(levels));
  levels = {};
  levels.black = 20.0;
  levels.white = 10.0;
  EXPECT_EQ("f: image: white must be in (black, 255] = (20, 255], not 10",
            FaultOf(levels));
  levels.white = 256.0;
  EXPECT_EQ("f: image: white must be in (black, 255] = (20, 255], not 256",
            FaultOf(levels));
  levels = {};
  levels.clip = 0.0;
  EXPECT_EQ("f: image: clip must be in (black, white] = (0, 255], not 0",
            FaultOf(levels));
  levels = {};
  levels.step = 0.5;
  EXPECT_EQ("f: image: step must be in [1, white - black] = [1, 255], not 0.5",
            FaultOf(levels));
  levels = {};
  for (const double exposure : {0.0, -1.0, 1e-101, kInfinity, std::nan("")}) {
    levels.exposure = exposure;
    EXPECT_NE("", FaultOf(levels));
  }
  for (double CodeLevels::*field :
       {&CodeLevels::black, &CodeLevels::white, &CodeLevels::step}) {
    for (const double value : {std::nan(""), kInfinity, -kInfinity}) {
      levels = {};
      levels.*field = value;
      EXPECT_NE("", FaultOf(levels));
    }
  }
  levels = {};
  levels.clip = std::nan("");
  EXPECT_NE("", FaultOf(levels));
  levels.bits = 0;
  EXPECT_DEATH(CodeIntervals(ResponseCurve(), levels), "bits must be");
}

}  // namespace
}  // namespace ibrdf
