#include "ibrdf/image/code_interval.h"

#include <glog/logging.h>

#include <algorithm>
#include <cmath>

#include "ibrdf/base/format.h"

namespace ibrdf {
namespace {

constexpr int kMostBits = 16;

// The slack of a code. At white = 65535 it is 1.5e-14 of y: some 70 times the
// rounding of y, and of radiance some 7 times where x = y^0.2, which narrows it
// most.
constexpr double kSlack = 1e-9;

// Products and quotients with what curves decode stay normal numbers.
constexpr double kLeastExposure = 1e-100, kMostExposure = 1e100;

// The code values y between which a code lies; absent where it says nothing.
struct CodeEnds {
  std::optional<double> low, high;
};

CodeEnds EndsOf(const CodeLevels& levels, double code) {
  const double half = 0.5 * levels.step + kSlack;
  const double range = levels.white - levels.black;
  const double clip = levels.clip.value_or(levels.white);
  CodeEnds ends;
  if (code > levels.black) {
    ends.low = (std::min(code, clip) - half - levels.black) / range;
    if (*ends.low <= 0.0) ends.low.reset();
  }
  if (code < clip) {
    ends.high = (std::max(code, levels.black) + half - levels.black) / range;
  }
  return ends;
}

}  // namespace

CodeLevels CodeLevels::OfBits(int bits) {
  CodeLevels levels;
  levels.bits = bits;
  levels.white = std::ldexp(1.0, bits) - 1.0;
  return levels;
}

Status CodeLevels::Check(const std::string& where) const {
  if (bits < 1 || bits > kMostBits) {
    return InvalidInput(
        where, Format("bits must be 1 to %d, not %d", kMostBits, bits));
  }
  const double most = std::ldexp(1.0, bits) - 1.0;
  if (!(black >= 0.0 && black < most)) {
    return InvalidInput(
        where, Format("black must be in [0, %g), not %g", most, black));
  }
  if (!(white > black && white <= most)) {
    return InvalidInput(where, Format("white must be in (black, %g] = (%g, "
                                      "%g], not %g",
                                      most, black, most, white));
  }
  if (clip.has_value() && !(*clip > black && *clip <= white)) {
    return InvalidInput(where, Format("clip must be in (black, white] = (%g, "
                                      "%g], not %g",
                                      black, white, *clip));
  }
  if (!(step >= 1.0 && step <= white - black)) {
    return InvalidInput(where, Format("step must be in [1, white - black] = "
                                      "[1, %g], not %g",
                                      white - black, step));
  }
  if (!(exposure >= kLeastExposure && exposure <= kMostExposure)) {
    return InvalidInput(where, Format("exposure must be in [%g, %g], not %g",
                                      kLeastExposure, kMostExposure, exposure));
  }
  return OkStatus();
}

CodeIntervals::CodeIntervals(const ResponseCurve& curve,
                             const CodeLevels& levels) {
  const Status status = levels.Check("CodeLevels");
  CHECK(status.ok()) << status.message();
  const size_t count = size_t{1} << levels.bits;
  intervals_.resize(count);
  slopes_.resize(count);
  for (size_t code = 0; code < count; ++code) {
    const CodeEnds ends = EndsOf(levels, static_cast<double>(code));
    // A curve that never gets here says nothing of the radiance.
    if (ends.low.has_value() && *ends.low >= curve.max_code()) continue;
    if (ends.low.has_value()) {
      const CurvePoint x = curve.DecodePoint(*ends.low);
      intervals_[code].low = x.value / levels.exposure;
      slopes_[code].low = x.parameter_slope / x.value;
    }
    if (ends.high.has_value() && *ends.high < curve.max_code()) {
      const CurvePoint x = curve.DecodePoint(*ends.high);
      intervals_[code].high = x.value / levels.exposure;
      slopes_[code].high = x.parameter_slope / x.value;
    }
  }
}

RadianceInterval FloatInterval(const ResponseCurve& curve, double exposure,
                               double value) {
  // NaN too.
  if (!(value > 0.0 && value < curve.max_code())) return {};
  const double radiance = curve.Decode(value) / exposure;
  if (!(radiance > 0.0 && std::isfinite(radiance))) return {};
  return {radiance, radiance};
}

BracketedInterval IntersectBrackets(
    const std::vector<RadianceInterval>& intervals) {
  BracketedInterval all;
  RadianceInterval& common = all.interval;
  for (const RadianceInterval& one : intervals) {
    DCHECK(!one.IsEmpty());
    common.low = std::max(common.low, one.low);
    common.high = std::min(common.high, one.high);
  }
  if (common.IsEmpty()) {
    all.contradiction = std::log(common.low) - std::log(common.high);
    std::swap(common.low, common.high);
  }
  return all;
}

}  // namespace ibrdf
