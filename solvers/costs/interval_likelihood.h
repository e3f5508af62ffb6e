// The probability that a normal variable lies in an interval: the likelihood of
// log radiance of which an image tells the ends.
#pragma once

namespace ibrdf {

// -log(Phi((high - mean) / s) - Phi((low - mean) / s)) and its derivatives by
// the mean. It is convex (Prekopa 1973: the integral of a log-concave function
// over a convex set is log-concave).
struct IntervalLikelihood {
  double cost = 0.0;       // nats
  double slope = 0.0;      // -d cost / d mean: what r / D is of one value
  double curvature = 0.0;  // d^2 cost / d mean^2, in [0, 1 / s^2]
  double third = 0.0;      // d^3 cost / d mean^3
};

// low <= high, natural logarithms; -infinity and infinity where there is no
// end, and 0 all over where there is neither. deviation: s > 0. Ends nearer
// than 1e-9 s are taken as that far apart, so that the cost stays finite.
//
// With x of the normal density cut to the interval: slope = (E x - mean) / s^2,
// curvature = (1 - Var x / s^2) / s^2, third = -E (x - E x)^3 / s^6, by
// quadrature from the interval's most probable point on, which loses no digits
// however far the mean is outside.
IntervalLikelihood EvaluateInterval(double low, double high, double mean,
                                    double deviation);

}  // namespace ibrdf
