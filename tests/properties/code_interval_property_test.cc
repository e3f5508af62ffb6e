// What was encoded lies in the interval of its code, whatever curve, levels and
// exposure.
#include <gtest/gtest.h>
#include <rapidcheck/gtest.h>

#include <algorithm>
#include <cmath>

#include "ibrdf/image/code_interval.h"
#include "tests/properties/generators.h"

namespace ibrdf {
namespace {

// Two nodes or more, from steep to flat.
std::vector<CurveNode> AnyTable() {
  const int count = 2 + *Choice(30);
  std::vector<CurveNode> table = {{*Magnitude(1e-6, 1e-2), 0.0}};
  table[0].y = table[0].x * *Magnitude(0.1, 10.0);
  for (int i = 1; i < count; ++i) {
    const double ratio = *Magnitude(1.01, 3.0);
    table.push_back({table.back().x * ratio,
                     table.back().y * std::pow(ratio, *Magnitude(0.05, 20.0))});
  }
  // To 1, or somewhat beside it.
  const double x = 1.0 / table.back().x,
               y = *Between(0.9, 1.1) / table.back().y;
  for (CurveNode& node : table) node = {node.x * x, node.y * y};
  return table;
}

ResponseCurve AnyCurve() {
  ResponseDefinition definition;
  do {
    definition = {};
    definition.kind = static_cast<ResponseKind>(*Choice(7));
    if (const auto known = ParameterOf(definition.kind)) {
      const bool open = std::isinf(known->most);
      definition.parameter = *rc::gen::oneOf(
          rc::gen::element(known->least, known->usual, known->most),
          Magnitude(known->least, open ? 1e9 : known->most));
      // exp(log(.)) may be past the end.
      definition.parameter =
          std::clamp(*definition.parameter, known->least, known->most);
    }
    if (definition.kind == ResponseKind::kTable) definition.table = AnyTable();
  } while (!definition.Check("").ok());  // some tables are too dark
  return ResponseCurve(definition);
}

CodeLevels AnyLevels() {
  CodeLevels levels =
      CodeLevels::OfBits(*rc::gen::element(1, 2, 4, 8, 8, 10, 12, 14, 16));
  const double most = levels.white;
  if (*rc::gen::arbitrary<bool>()) {
    levels.black = std::floor(0.4 * most * *Unit());
    levels.white = std::ceil(most - 0.4 * most * *Unit());
  }
  // Between two codes, where that leaves a step between black and white.
  if (levels.white - levels.black >= 2.0 && *Choice(4) == 0) {
    levels.black += 0.4 * *Unit();
  }
  if (*Choice(4) == 0) {
    const double share = *Between(0.5, 1.0);
    levels.clip = (1.0 - share) * levels.black + share * levels.white;
    // The sum is rounded.
    levels.clip = std::min(*levels.clip, levels.white);
  }
  levels.exposure = *rc::gen::oneOf(rc::gen::just(1.0), Magnitude(1e-3, 1e3),
                                    Magnitude(1e-99, 1e99));
  return levels;
}

// As a camera does it: rounds, and holds to what the file has.
int CodeOf(const ResponseCurve& curve, const CodeLevels& levels,
           double radiance) {
  const double y = curve.Encode(levels.exposure * radiance);
  const double code = levels.black + (levels.white - levels.black) * y;
  return static_cast<int>(
      std::lround(std::clamp(code, 0.0, std::ldexp(1.0, levels.bits) - 1.0)));
}

RC_GTEST_PROP(CodeIntervalProperty, EachCodeHoldsWhatWasEncoded, ()) {
  const ResponseCurve curve = AnyCurve();
  const CodeLevels levels = AnyLevels();
  RC_ASSERT(levels.Check("").ok());
  const CodeIntervals codes(curve, levels);
  for (int i = 0; i < 50; ++i) {
    // In the file's range, far out of it, and at the ends of a code.
    double x = *rc::gen::oneOf(Magnitude(1e-4, 2.0), Magnitude(1e-60, 1e30));
    if (*rc::gen::arbitrary<bool>()) {
      const int end = *Choice(1 << levels.bits);
      const double y =
          (end + 0.5 - levels.black) / (levels.white - levels.black);
      if (y > 0.0 && y < curve.max_code()) {
        x = curve.Decode(y) * (1.0 + 2.2e-16 * (*Choice(9) - 4));
      }
    }
    const double radiance = x / levels.exposure;
    const int code = CodeOf(curve, levels, radiance);
    const RadianceInterval& interval = codes.Interval(code);
    RC_ASSERT(!interval.IsEmpty());
    RC_ASSERT(interval.Contains(radiance));
    RC_ASSERT(std::isfinite(interval.low) && !std::isnan(interval.high));
    const LogEndSlopes& slopes = codes.Slopes(code);
    RC_ASSERT(std::isfinite(slopes.low) && std::isfinite(slopes.high));
  }
}

// Frames of one radiance never contradict each other, and narrow each other.
RC_GTEST_PROP(CodeIntervalProperty, BracketsHoldWhatWasEncoded, ()) {
  const ResponseCurve curve = AnyCurve();
  const double radiance = *Magnitude(1e-3, 1e3);
  std::vector<RadianceInterval> frames;
  const int count = 1 + *Choice(5);
  for (int i = 0; i < count; ++i) {
    CodeLevels levels = AnyLevels();
    levels.exposure = *Magnitude(1e-3, 1e3);
    const CodeIntervals codes(curve, levels);
    frames.push_back(codes.Interval(CodeOf(curve, levels, radiance)));
  }
  const BracketedInterval all = IntersectBrackets(frames);
  RC_ASSERT(all.contradiction == 0.0);
  RC_ASSERT(all.interval.Contains(radiance));
  for (const RadianceInterval& frame : frames) {
    RC_ASSERT(all.interval.low >= frame.low);
    RC_ASSERT(all.interval.high <= frame.high);
  }
}

// Whatever files say, what is reported meets each of them.
RC_GTEST_PROP(CodeIntervalProperty, ContradictionsAreBridged, ()) {
  std::vector<RadianceInterval> frames;
  const int count = 1 + *Choice(5);
  for (int i = 0; i < count; ++i) {
    const double low = *Magnitude(1e-3, 1e3);
    frames.push_back({low, low * *Magnitude(1.0, 10.0)});
    if (*Choice(5) == 0) frames.back().low = 0.0;
    if (*Choice(5) == 0) frames.back() = {low, RadianceInterval().high};
  }
  const BracketedInterval all = IntersectBrackets(frames);
  RC_ASSERT(!all.interval.IsEmpty());
  RC_ASSERT(all.contradiction >= 0.0 && std::isfinite(all.contradiction));
  for (const RadianceInterval& frame : frames) {
    RC_ASSERT(frame.low <= all.interval.high);
    RC_ASSERT(frame.high >= all.interval.low);
    if (all.contradiction == 0.0) {
      RC_ASSERT(frame.low <= all.interval.low);
      RC_ASSERT(frame.high >= all.interval.high);
    }
  }
}

RC_GTEST_PROP(CodeIntervalProperty, CurvesAndTheirInversesRise, ()) {
  const ResponseCurve curve = AnyCurve();
  for (int i = 0; i < 20; ++i) {
    const double a = *Magnitude(1e-30, 1e9), b = a * *Magnitude(1.001, 1e3);
    RC_ASSERT(curve.Encode(a) <= curve.Encode(b));
    RC_ASSERT(curve.Decode(a) <= curve.Decode(b));
    const double y = curve.Encode(a);
    if (y < 1.03 && y < curve.max_code() - 1e-6) {
      RC_ASSERT(std::abs(curve.Encode(curve.Decode(y)) - y) <= 1e-13 * y);
    }
  }
}

}  // namespace
}  // namespace ibrdf
