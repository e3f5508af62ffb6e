// atan2 for inner loops.
#pragma once
#include <cmath>

namespace ibrdf {

// Radians in [-pi, pi]; 0 at (0, 0). Within 2e-9 of std::atan2 in double and
// 3e-7 in float, relative to the result where |y| < |x|. Without branches, so
// that loops of it become vector code. Arguments must be finite.
template <typename T>
[[gnu::always_inline]] inline T FastAtan2(T y, T x) {
  const T ax = x < 0 ? -x : x, ay = y < 0 ? -y : y;
  const T larger = ax > ay ? ax : ay, smaller = ax > ay ? ay : ax;
  // The addend keeps 0 / 0 at 0 and is lost beside anything else.
  const T t = smaller / (larger + T(1e-37));
  const T u = t * t;
  // Interpolates atan(t) / t at the Chebyshev points of u = t^2 in [0, 1].
  T p = T(-1.701169973239e-03);
  p = p * u + T(1.048764885309e-02);
  p = p * u + T(-3.035186404340e-02);
  p = p * u + T(5.708955518699e-02);
  p = p * u + T(-8.349724924501e-02);
  p = p * u + T(1.093234148590e-01);
  p = p * u + T(-1.426001607971e-01);
  p = p * u + T(1.999807528082e-01);
  p = p * u + T(-3.333327629197e-01);
  p = p * u + T(9.999999971605e-01);
  T angle = p * t;
  angle = ay > ax ? T(1.57079632679489661923) - angle : angle;
  angle = x < 0 ? T(3.14159265358979323846) - angle : angle;
  return y < 0 ? -angle : angle;
}

}  // namespace ibrdf
