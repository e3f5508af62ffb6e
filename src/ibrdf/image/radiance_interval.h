// What an image says of radiance at a pixel and channel: an interval.
#pragma once
#include <limits>

namespace ibrdf {

// Radiance from low to high, ends included; low <= high unless it is empty.
//
// low = 0 says that there is no lower end: radiance is > 0, and log low is
// -infinity. high is infinite where there is no upper end. A sum or product
// with the log of such an end may be NaN: ask HasLow() and HasHigh() first.
struct RadianceInterval {
  double low = 0.0;
  double high = std::numeric_limits<double>::infinity();

  bool HasLow() const { return low > 0.0; }
  bool HasHigh() const {
    return high < std::numeric_limits<double>::infinity();
  }
  // Nothing is known.
  bool IsMissing() const { return !HasLow() && !HasHigh(); }
  // One end of two is known.
  bool IsOneSided() const { return HasLow() != HasHigh(); }
  // One radiance, as of an HDR file.
  bool IsExact() const { return low == high; }
  bool IsEmpty() const { return low > high; }
  bool Contains(double radiance) const {
    return low <= radiance && radiance <= high;
  }
  // What is in the interval and nearest to a radiance.
  double Nearest(double radiance) const {
    return radiance < low ? low : radiance > high ? high : radiance;
  }
};

}  // namespace ibrdf
