// What a value of a file says of radiance: an interval.
#pragma once
#include <optional>
#include <vector>

#include "ibrdf/base/status.h"
#include "ibrdf/image/radiance_interval.h"
#include "ibrdf/image/response_curve.h"

namespace ibrdf {

// How a file's whole numbers stand for code values y of a response curve:
// y = (code - black) / (white - black).
struct CodeLevels {
  int bits = 8;          // 1 to 16: codes are 0 to 2^bits - 1
  double black = 0.0;    // y = 0
  double white = 255.0;  // y = 1
  // Codes from here on are clipped; absent: from white on.
  std::optional<double> clip;
  // From a code that the camera can write to the next: more than 1 where a file
  // of 16 bits holds fewer, as a PNG's sBIT says.
  double step = 1.0;
  // x = exposure * radiance: seconds, or seconds times ISO over the square of
  // the f-number; only ratios between files of one view matter.
  double exposure = 1.0;

  // black 0, white 2^bits - 1.
  static CodeLevels OfBits(int bits);
  // kInvalidInput says what is wrong; `where`: file and field.
  Status Check(const std::string& where) const;
};

// d log end / d parameter of the curve; 0 where there is no end.
struct LogEndSlopes {
  double low = 0.0, high = 0.0;
};

// The radiance of each code of a file, with g = Decode / exposure:
//
//   code <= black                (0, g(black + step / 2)]
//   code                         [g(code - step / 2), g(code + step / 2)]
//   code >= clip                 [g(clip - step / 2), infinity)
//
// An end at or below black, or at or above the largest code of the curve, is
// absent. Ends are 1e-9 of a code further apart than rounding to the nearest
// code makes them, so that errors of arithmetic leave what was encoded inside.
class CodeIntervals {
 public:
  // The levels pass Check().
  CodeIntervals(const ResponseCurve& curve, const CodeLevels& levels);

  // code in [0, 2^bits).
  const RadianceInterval& Interval(int code) const { return intervals_[code]; }
  const LogEndSlopes& Slopes(int code) const { return slopes_[code]; }

 private:
  std::vector<RadianceInterval> intervals_;  // [2^bits]
  std::vector<LogEndSlopes> slopes_;         // [2^bits]
};

// The radiance of a value of a file of floats: equal ends, Decode(value) /
// exposure. Missing where that is no finite number > 0, and where the curve has
// no such code value. exposure > 0.
RadianceInterval FloatInterval(const ResponseCurve& curve, double exposure,
                               double value);

// What several files of one view say of one pixel.
struct BracketedInterval {
  RadianceInterval interval;
  // log(low / high) of the largest low and the smallest high where they
  // contradict each other: no radiance is in all intervals. Then `interval` is
  // what lies between those two ends, the least interval that meets every one.
  // 0 where they agree.
  double contradiction = 0.0;
};

// Intersects them, each of its own exposure; none may be empty. Missing where
// there are none.
BracketedInterval IntersectBrackets(
    const std::vector<RadianceInterval>& intervals);

}  // namespace ibrdf
