#include "ibrdf/solvers/problem/unknown_curve.h"

#include <cmath>
#include <limits>

namespace ibrdf {
namespace {

// The radiance that stands for an interval.
double Representative(const RadianceInterval& interval,
                      const ResponseCurve& curve, const CodeLevels& levels,
                      int code) {
  if (interval.IsMissing()) return std::numeric_limits<double>::quiet_NaN();
  if (!interval.HasHigh()) return interval.low;
  if (!interval.HasLow()) return interval.high;
  const double y = (code - levels.black) / (levels.white - levels.black);
  return interval.Nearest(curve.Decode(y) / levels.exposure);
}

}  // namespace

std::vector<CurveFamily> FamiliesOf(ResponseChoice choice) {
  const CurveFamily srgb;
  const CurveFamily power = {ResponseKind::kPower, true, std::log(2.2), 0.2};
  const CurveFamily aces = {ResponseKind::kAces, true, std::log(0.5), 0.7};
  switch (choice) {
    case ResponseChoice::kUnknown:
      return {srgb, power, aces};
    case ResponseChoice::kUnknownPower:
      return {power};
    case ResponseChoice::kUnknownAces:
      return {aces};
    default:
      return {};
  }
}

DecodedCodes DecodeCodes(const ResponseCurve& curve, const CodeLevels& levels,
                         const Image& codes) {
  const CodeIntervals intervals(curve, levels);
  std::vector<float> radiance(size_t{1} << levels.bits);
  for (size_t code = 0; code < radiance.size(); ++code) {
    const int k = static_cast<int>(code);
    radiance[code] = static_cast<float>(
        Representative(intervals.Interval(k), curve, levels, k));
  }
  DecodedCodes out;
  out.radiance = out.bounds.low = out.bounds.high =
      Image(codes.width, codes.height);
  for (size_t i = 0; i < codes.rgb.size(); ++i) {
    const int code = static_cast<int>(codes.rgb[i]);
    const RadianceInterval& interval = intervals.Interval(code);
    out.bounds.low.rgb[i] = static_cast<float>(interval.low);
    out.bounds.high.rgb[i] = static_cast<float>(interval.high);
    out.radiance.rgb[i] = radiance[code];
  }
  return out;
}

}  // namespace ibrdf
