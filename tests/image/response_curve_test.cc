#include "ibrdf/image/response_curve.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <string>
#include <vector>

#include "tests/image/reference_curve.h"
#include "tests/support/non_finite.h"

namespace ibrdf {
namespace {

using testing::AllCurves;
using testing::Curve;
using testing::Describe;
using testing::Number;
using testing::ReferenceCurve;
using testing::Slope;

// Some operations of double precision.
constexpr double kRounding = 2e-14;

// Magnitudes from low to high, both among them.
std::vector<double> Magnitudes(double low, double high, int count) {
  std::vector<double> values;
  for (int i = 0; i < count; ++i) {
    values.push_back(low * std::pow(high / low, i / (count - 1.0)));
  }
  return values;
}

// Is x near where two parts of a curve meet? Slopes jump there.
bool IsNearKink(const ResponseDefinition& definition, double x, double near) {
  std::vector<double> kinks;
  if (definition.kind == ResponseKind::kSrgb) kinks.push_back(0.00313067);
  if (definition.kind == ResponseKind::kPower) {
    kinks.push_back(std::pow(2.0, -18.0 * *definition.parameter));
  }
  for (const CurveNode& node : definition.table) kinks.push_back(node.x);
  if (definition.kind == ResponseKind::kTable) {
    kinks.push_back(ResponseCurve(definition).Decode(0x1p-18));
  }
  return std::any_of(kinks.begin(), kinks.end(), [=](double kink) {
    return std::abs(std::log(x / kink)) < near;
  });
}

TEST(ResponseCurve, HasTheValuesOfTheStandard) {
  const ResponseCurve srgb = Curve(ResponseKind::kSrgb);
  EXPECT_DOUBLE_EQ(0.0, srgb.Encode(0.0));
  EXPECT_DOUBLE_EQ(0.01292, srgb.Encode(0.001));
  EXPECT_NEAR(0.461356129500441650, srgb.Encode(0.18), 1e-15);
  EXPECT_NEAR(0.735356983052449491, srgb.Encode(0.5), 1e-15);
  EXPECT_DOUBLE_EQ(1.0, srgb.Encode(1.0));
  EXPECT_NEAR(0.214041140482232442, srgb.Decode(0.5), 1e-15);
  // The standard as printed, with its rounded thresholds: the same but for its
  // step, at every code of 8 and of 16 bits.
  for (int code = 0; code <= 65535; ++code) {
    const double y = code / 65535.0;
    const double printed =
        y <= 0.04045 ? y / 12.92 : std::pow((y + 0.055) / 1.055, 2.4);
    ASSERT_NEAR(printed, srgb.Decode(y), 3e-9) << code;
    const double back = printed <= 0.0031308
                            ? 12.92 * printed
                            : 1.055 * std::pow(printed, 1.0 / 2.4) - 0.055;
    ASSERT_NEAR(back, srgb.Encode(printed), 3e-8) << code;
  }
}

TEST(ResponseCurve, HasTheValuesOfPowersAndLogs) {
  const ResponseCurve power = Curve(ResponseKind::kPower);
  EXPECT_EQ(2.2, power.parameter());
  EXPECT_NEAR(0.729740052840723097, power.Encode(0.5), 1e-15);
  EXPECT_NEAR(0.217637640824031034, power.Decode(0.5), 1e-15);
  const ResponseCurve log = Curve(ResponseKind::kLog);
  EXPECT_NEAR(0.461623122661288045, log.Encode(0.01),
              1e-15);  // ln 51 / ln 5001
  EXPECT_NEAR(0.0139435497665897156, log.Decode(0.5), 1e-15);
  EXPECT_DOUBLE_EQ(1.0, log.Encode(1.0));
}

TEST(ResponseCurve, HasTheValuesOfReinhard) {
  const ResponseCurve simple = Curve(ResponseKind::kReinhard);
  EXPECT_DOUBLE_EQ(0.5, simple.Encode(1.0));
  EXPECT_DOUBLE_EQ(0.75, simple.Encode(3.0));
  EXPECT_DOUBLE_EQ(3.0, simple.Decode(0.75));
  EXPECT_LT(simple.max_code(), 1.0);
  const ResponseCurve to_four = Curve(ResponseKind::kReinhard, 4.0);
  EXPECT_DOUBLE_EQ(17.0 / 32.0, to_four.Encode(1.0));
  EXPECT_DOUBLE_EQ(1.0, to_four.Encode(4.0));
  EXPECT_DOUBLE_EQ(4.0, to_four.Decode(1.0));
  // White at 1 is linear.
  EXPECT_DOUBLE_EQ(0.3, Curve(ResponseKind::kReinhard, 1.0).Encode(0.3));
}

// What was measured of RobIR's curve, and what its supplement says.
TEST(ResponseCurve, HasTheValuesOfScaledAces) {
  const ResponseCurve plain = Curve(ResponseKind::kAces, 1.0);
  EXPECT_NEAR(0.803797468354430380, plain.Encode(1.0), 1e-15);  // 2.54 / 3.16
  EXPECT_NEAR(0.266898920389496870, plain.Encode(0.18), 1e-15);
  EXPECT_NEAR(7.24165738677394139, plain.Decode(1.0), 1e-13);
  EXPECT_NEAR(81.6150466292942117, plain.Decode(1.03), 1e-10);
  EXPECT_NEAR(0.03 / 0.14, plain.EncodePoint(0.0).slope, 1e-15);
  EXPECT_NEAR(1.03292, plain.max_code(), 1e-5);
  EXPECT_NEAR(1.80, plain.EncodePoint(0.12).slope, 0.01);
  const ResponseCurve half = Curve(ResponseKind::kAces);
  EXPECT_EQ(0.5, half.parameter());
  EXPECT_NEAR(0.923320829649515480, half.Encode(1.0), 1e-15);
  EXPECT_NEAR(1.44020343649810499, half.Decode(1.0), 1e-14);
  EXPECT_NEAR(1.18651558479117608, half.max_code(), 1e-8);
  EXPECT_NEAR(1.637, Curve(ResponseKind::kAces, 0.1).max_code(), 1e-3);
  EXPECT_NEAR(6.5, Curve(ResponseKind::kAces, 1e-4).max_code(), 0.05);
  // Supplement, Fig. 10: gamma = 0.42 "matches well with the sRGB curve".
  const ResponseCurve fitted = Curve(ResponseKind::kAces, 0.42),
                      srgb = Curve(ResponseKind::kSrgb);
  double sum = 0.0, worst = 0.0;
  for (int i = 0; i <= 1000; ++i) {
    const double error =
        std::abs(fitted.Encode(i / 1000.0) - srgb.Encode(i / 1000.0));
    sum += error;
    worst = std::max(worst, error);
  }
  EXPECT_LE(sum / 1001, 0.055);
  EXPECT_LE(worst, 0.21);
}

TEST(ResponseCurve, EncodesAsPublished) {
  for (const ResponseDefinition& definition : AllCurves()) {
    SCOPED_TRACE(Describe(definition));
    const ResponseCurve curve(definition);
    const ReferenceCurve reference(definition);
    for (const double x : Magnitudes(1e-40, 0.99e8, 2000)) {
      const auto y = static_cast<double>(reference.Encode(x));
      ASSERT_NEAR(y, curve.Encode(x), kRounding * y) << x;
    }
  }
}

// Wanted are 2e-6 up to y = 1.03. What y's own rounding makes of x is all that
// is left: the slope of log x over log y times some 1e-16.
TEST(ResponseCurve, DecodesWhatWasEncoded) {
  for (const ResponseDefinition& definition : AllCurves()) {
    SCOPED_TRACE(Describe(definition));
    const ResponseCurve curve(definition);
    const ReferenceCurve reference(definition);
    const double most =
        std::min(1.03, curve.max_code() - 1e-6);  // Reinhard: below 1
    for (const double y : Magnitudes(1e-12, most, 200)) {
      const CurvePoint x = curve.DecodePoint(y);
      const auto slow = static_cast<double>(reference.Decode(y));
      const double bend = std::max(1.0, x.slope * y / x.value);
      ASSERT_NEAR(slow, x.value, kRounding * bend * slow) << y;
      ASSERT_NEAR(slow, x.value, 2e-6 * slow) << y;
      ASSERT_NEAR(y, curve.Encode(x.value), kRounding * y) << y;
    }
  }
}

// RobIR's code loses 5.8e-4 of dark values, and takes no y above 1.03.
TEST(ResponseCurve, AcesInverseHoldsFromBlackToItsLimit) {
  for (const double gamma : {1e-4, 0.1, 0.5, 1.0}) {
    const ResponseCurve curve = Curve(ResponseKind::kAces, gamma);
    const ReferenceCurve reference({ResponseKind::kAces, gamma, {}});
    for (const double x : Magnitudes(1e-30, 1e-3, 100)) {
      ASSERT_NEAR(x, curve.Decode(curve.Encode(x)), 1e-15 * x);
    }
    // To the limit: y is known to 1e-16, x to 1e-16 x.
    for (const double x : Magnitudes(1.0, 0.99e8, 100)) {
      const double y = curve.Encode(x);
      const auto slow = static_cast<double>(reference.Decode(y));
      ASSERT_NEAR(slow, curve.Decode(y), 1e-14 * x * slow);
    }
    EXPECT_EQ(kMaxCurveRadiance, curve.Decode(curve.max_code()));
    EXPECT_EQ(kMaxCurveRadiance, curve.Decode(2.51 / 2.43 * 7.0));
  }
}

TEST(ResponseCurve, SlopesAreThoseOfDifferences) {
  for (const ResponseDefinition& definition : AllCurves()) {
    SCOPED_TRACE(Describe(definition));
    const ResponseCurve curve(definition);
    const ReferenceCurve reference(definition);
    const bool fits = std::isfinite(curve.parameter());
    for (const double x : Magnitudes(1e-40, 0.9e8, 400)) {
      if (IsNearKink(definition, x, 0.01)) continue;
      const CurvePoint y = curve.EncodePoint(x);
      const auto slope = static_cast<double>(
          Slope([&](Number v) { return reference.Encode(v); }, x, 1e-4L));
      // Where the curve is flat the differences lose digits: 1e-19 x / 1e-4.
      const double lost = 1e-13 * std::max(1.0, x);
      ASSERT_NEAR(slope, y.slope, (1e-11 + lost) * slope) << x;
      if (curve.parameter() == 0.0) {
        ASSERT_EQ(0.0, y.parameter_slope);
      } else if (fits) {
        const auto by_parameter = static_cast<double>(
            Slope([&](Number p) { return reference.With(p).Encode(x); },
                  reference.parameter, 1e-5L));
        ASSERT_NEAR(by_parameter, y.parameter_slope,
                    1e-10 * std::abs(by_parameter) + 1e-13 * y.value)
            << x;
      }
    }
  }
}

TEST(ResponseCurve, SlopesOfTheInverseAreThoseOfDifferences) {
  for (const ResponseDefinition& definition : AllCurves()) {
    SCOPED_TRACE(Describe(definition));
    const ResponseCurve curve(definition);
    const ReferenceCurve reference(definition);
    // From where a power's line ends at every p that the differences take.
    for (const double x : Magnitudes(1e-30, 100.0, 60)) {
      if (IsNearKink(definition, x, 0.02)) continue;
      const double y = curve.Encode(x);
      const CurvePoint back = curve.DecodePoint(y);
      const auto slope = static_cast<double>(
          Slope([&](Number v) { return reference.Decode(v); }, y, 1e-5L));
      ASSERT_NEAR(slope, back.slope, 1e-6 * slope) << x;
      if (curve.parameter() == 0.0) {
        ASSERT_EQ(0.0, back.parameter_slope);
      } else if (std::isfinite(curve.parameter())) {
        const auto by_parameter = static_cast<double>(
            Slope([&](Number p) { return reference.With(p).Decode(y); },
                  reference.parameter, 1e-5L));
        ASSERT_NEAR(by_parameter, back.parameter_slope,
                    1e-6 * std::abs(by_parameter) + 1e-12 * back.value)
            << x;
      }
    }
  }
}

TEST(ResponseCurve, ExtremeArgumentsGiveFiniteNumbers) {
  for (const ResponseDefinition& definition : AllCurves()) {
    SCOPED_TRACE(Describe(definition));
    const ResponseCurve curve(definition);
    for (const double at : {-kInfinity,  -1e300,    -1.0,
                            -0.0,        0.0,       5e-324,
                            1e-300,      1e-30,     1e-6,
                            1.0 - 1e-16, 1.0,       1.0 + 1e-15,
                            1.03,        1.0329218, 1.04,
                            6.6,         1e7,       std::nextafter(1e8, 0.0),
                            1e8,         1e30,      1.7e308}) {
      SCOPED_TRACE(at);
      for (const CurvePoint& point :
           {curve.EncodePoint(at), curve.DecodePoint(at)}) {
        EXPECT_TRUE(std::isfinite(point.value));
        EXPECT_TRUE(std::isfinite(point.slope));
        EXPECT_TRUE(std::isfinite(point.parameter_slope));
        EXPECT_GE(point.value, 0.0);
        EXPECT_GE(point.slope, 0.0);
        if (at < 0.0) {
          EXPECT_EQ(0.0, point.value);
          EXPECT_EQ(0.0, point.slope);
        }
        if (at == 0.0) {
          EXPECT_EQ(0.0, point.value);
          EXPECT_GT(point.slope, 0.0);
        }
      }
      EXPECT_LE(curve.Encode(at), curve.max_code());
    }
    EXPECT_EQ(curve.max_code(), curve.Encode(kInfinity));
    EXPECT_TRUE(std::isnan(curve.Encode(std::nan(""))));
    EXPECT_TRUE(std::isnan(curve.DecodePoint(std::nan("")).slope));
    if (definition.kind == ResponseKind::kLinear) continue;
    EXPECT_EQ(kMaxCurveRadiance, curve.Decode(kInfinity));
    EXPECT_EQ(0.0, curve.EncodePoint(1e9).slope);
    EXPECT_EQ(0.0, curve.DecodePoint(1e300).slope);
    EXPECT_EQ(0.0, curve.DecodePoint(1e300).parameter_slope);
  }
}

TEST(ResponseCurve, NeverFalls) {
  for (const ResponseDefinition& definition : AllCurves()) {
    SCOPED_TRACE(Describe(definition));
    const ResponseCurve curve(definition);
    double y = 0.0, x = 0.0;
    for (const double at : Magnitudes(1e-60, 1e9, 20000)) {
      ASSERT_GE(curve.Encode(at), y) << at;
      ASSERT_GE(curve.Decode(at), x) << at;
      y = curve.Encode(at);
      x = curve.Decode(at);
    }
    // From one double to the next where two parts meet.
    std::vector<double> meets = {0.0031306684425006340, 0.04044823627710819,
                                 0x1p-18};
    if (definition.kind == ResponseKind::kPower) {
      meets.push_back(std::pow(2.0, -18.0 * *definition.parameter));
    }
    for (const CurveNode& node : definition.table) {
      meets.push_back(node.x);
      meets.push_back(node.y);
    }
    for (double at : meets) {
      for (int i = 0; i < 20; ++i) at = std::nextafter(at, 0.0);
      for (int i = 0; i < 40; ++i) {
        const double next = std::nextafter(at, kInfinity);
        // Powers are rounded; parts meet within as much.
        ASSERT_GE(curve.Encode(next), curve.Encode(at) * (1.0 - 4e-16));
        ASSERT_GE(curve.Decode(next), curve.Decode(at) * (1.0 - 4e-16));
        at = next;
      }
    }
  }
}

TEST(ResponseCurve, TablesKeepPowersAndNodes) {
  ResponseDefinition definition;
  definition.kind = ResponseKind::kTable;
  for (const double y : {0.01, 0.1, 0.3, 1.0}) {
    definition.table.push_back({std::pow(y, 2.2), y});
  }
  const ResponseCurve curve(definition);
  for (const double y : Magnitudes(0.01, 1.0, 50)) {
    ASSERT_NEAR(std::pow(y, 2.2), curve.Decode(y), 1e-13 * y);
  }
  for (const CurveNode& node : definition.table) {
    EXPECT_DOUBLE_EQ(node.y, curve.Encode(node.x));
    EXPECT_DOUBLE_EQ(node.x, curve.Decode(node.y));
  }
  // The same powers below and above; above at most proportional.
  EXPECT_NEAR(std::pow(0.002, 2.2), curve.Decode(0.002), 1e-15);
  EXPECT_NEAR(std::pow(1.03, 2.2), curve.Decode(1.03), 1e-13);
  const ResponseCurve convex({ResponseKind::kTable, {}, {{0.5, 0.2}, {1, 1}}});
  EXPECT_NEAR(1.5, convex.Encode(1.5), 1e-15);
  // The node (0, 0) says nothing new.
  ResponseDefinition with_origin = definition;
  with_origin.table.insert(with_origin.table.begin(), {0.0, 0.0});
  EXPECT_EQ(curve.Decode(0.2), ResponseCurve(with_origin).Decode(0.2));
  EXPECT_EQ(curve.Decode(0.002), ResponseCurve(with_origin).Decode(0.002));
}

// Tables of 256 codes of the other curves, decoded from half a code on.
TEST(ResponseCurve, TablesAreCloserThanLinesBetweenNodes) {
  for (const auto& [kind, most] : std::vector<std::pair<ResponseKind, double>>{
           {ResponseKind::kSrgb, 0.001},
           {ResponseKind::kPower, 1e-12},
           {ResponseKind::kAces, 0.04},
           {ResponseKind::kReinhard, 0.07},
           {ResponseKind::kLog, 0.01}}) {
    SCOPED_TRACE(NameOf(kind));
    const ResponseCurve curve = Curve(kind);
    ResponseDefinition definition;
    definition.kind = ResponseKind::kTable;
    for (int code = 0; code < 255; ++code) {
      definition.table.push_back({curve.Decode(code / 255.0), code / 255.0});
    }
    ASSERT_TRUE(definition.Check("t").ok());
    const ResponseCurve table(definition);
    double worst = 0.0, sum = 0.0, sum_of_lines = 0.0;
    for (double code = 0.5; code < 254.0; code += 0.03) {
      const double y = code / 255.0, x = curve.Decode(y);
      const double error = std::abs(std::log(table.Decode(y) / x));
      worst = std::max(worst, error);
      sum += error;
      const auto i = static_cast<size_t>(code);
      const CurveNode &a = definition.table[i], &b = definition.table[i + 1];
      const double line = a.x + (b.x - a.x) * (y - a.y) / (b.y - a.y);
      sum_of_lines += std::abs(std::log(line / x));
    }
    EXPECT_LT(worst, most);
    EXPECT_LT(sum, 0.51 * sum_of_lines);
  }
}

TEST(ResponseCurve, NamesAreWordsOfFiles) {
  for (const char* name :
       {"linear", "srgb", "power", "aces", "reinhard", "log", "table"}) {
    const StatusOr<ResponseKind> kind = ResponseKindOf("p.yaml: image", name);
    ASSERT_TRUE(kind.ok()) << name;
    EXPECT_EQ(name, NameOf(*kind));
  }
  for (const char* name : {"", "sRGB", "gamma", "auto", "srgb\n"}) {
    const StatusOr<ResponseKind> kind =
        ResponseKindOf("p.yaml: image.response", name);
    ASSERT_FALSE(kind.ok()) << name;
    EXPECT_EQ(StatusCode::kInvalidInput, kind.status().code());
  }
  EXPECT_EQ(
      "p.yaml: image.response: expected one of linear, srgb, power, aces, "
      "reinhard, log, table, not \"gamma\"",
      ResponseKindOf("p.yaml: image.response", "gamma").status().message());
  EXPECT_STREQ("gamma", ParameterOf(ResponseKind::kAces)->name);
  EXPECT_FALSE(ParameterOf(ResponseKind::kSrgb).has_value());
}

std::string FaultOf(const ResponseDefinition& definition) {
  const Status status = definition.Check("f: response");
  EXPECT_EQ(StatusCode::kInvalidInput, status.code());
  return status.message();
}

TEST(ResponseCurve, WrongParametersAreNamed) {
  for (const ResponseDefinition& definition : AllCurves()) {
    EXPECT_TRUE(definition.Check("").ok()) << Describe(definition);
  }
  const auto with = [](ResponseKind kind, double value) {
    return FaultOf({kind, value, {}});
  };
  EXPECT_EQ("f: response: p must be in [0.2, 5], not 0",
            with(ResponseKind::kPower, 0.0));
  EXPECT_EQ("f: response: gamma must be in [0.0001, 1], not 2.2",
            with(ResponseKind::kAces, 2.2));
  EXPECT_EQ("f: response: white must be at least 1, not 0.5",
            with(ResponseKind::kReinhard, 0.5));
  EXPECT_EQ("f: response: mu must be in [0.01, 1e+06], not inf",
            with(ResponseKind::kLog, kInfinity));
  EXPECT_NE("", with(ResponseKind::kPower, std::nan("")));
  EXPECT_NE("", with(ResponseKind::kAces, -1.0));
  EXPECT_NE("", with(ResponseKind::kReinhard, std::nan("")));
  EXPECT_EQ("f: response: srgb has no parameter",
            with(ResponseKind::kSrgb, 2.2));
  EXPECT_EQ("f: response: aces has no nodes",
            FaultOf({ResponseKind::kAces, {}, {{0.5, 0.5}, {1.0, 1.0}}}));
}

TEST(ResponseCurve, WrongTablesAreNamed) {
  const auto of = [](const std::vector<CurveNode>& table) {
    return FaultOf({ResponseKind::kTable, {}, table});
  };
  const std::string few = "f: response: a table needs two nodes beside (0, 0)";
  EXPECT_EQ(few, of({}));
  EXPECT_EQ(few, of({{0.0, 0.0}}));
  EXPECT_EQ(few, of({{0.0, 0.0}, {1.0, 1.0}}));
  EXPECT_EQ(
      "f: response: node 2 (0.5, 0.4): radiance and code value must both be "
      "larger than those of the node before",
      of({{0.2, 0.4}, {0.5, 0.4}, {1.0, 1.0}}));
  EXPECT_EQ("f: response: node 1 (0, 0.1): radiance must be in [1e-12, 1e+08]",
            of({{0.0, 0.1}, {1.0, 1.0}}));
  EXPECT_EQ(
      "f: response: node 2 (1, 255): code value must be in [1e-12, 2], "
      "relative to the largest code",
      of({{0.1, 1.0}, {1.0, 255.0}}));
  EXPECT_NE("", of({{0.1, 0.1}, {std::nan(""), 1.0}}));
  EXPECT_NE("", of({{0.1, 0.1}, {kInfinity, 1.0}}));
  EXPECT_NE("", of({{0.1, -0.1}, {1.0, 1.0}}));
  EXPECT_NE("", of({{0.5, 0.5}, {0.0, 0.0}, {1.0, 1.0}}));
  // A jump; rounding that leaves two nodes nearly equal.
  EXPECT_EQ(
      "f: response: node 2 (0.500001, 0.9): log code value over log radiance "
      "must rise by 0.0001 to 10000 from the node before, not 293894",
      of({{0.5, 0.5}, {0.500001, 0.9}}));
  EXPECT_DEATH(ResponseCurve({ResponseKind::kPower, -1.0, {}}), "p must be");
}

}  // namespace
}  // namespace ibrdf
