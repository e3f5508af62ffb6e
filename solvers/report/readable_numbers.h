// Numbers as people read them.
#pragma once
#include <string>

namespace ibrdf {

// Four digits; whole numbers, and those from 10000 to a billion, without
// decimals and in full; "-" for what is not finite.
std::string ShortNumber(double value);

// Two digits without an exponent where ShortNumber has none; "below 0.001".
std::string RoundNumber(double value);

// Errors (natural logarithm) beyond it, a factor of 5, say nothing.
inline constexpr double kLargestKnownError = 1.6;

// An error of a logarithm as people say it: "some 20 %", "a factor of 2.5";
// "not determined" beyond kLargestKnownError and where it is not finite.
std::string ErrorInWords(double log_error);

// How probable something is beside what costs this many nats less: "as
// probable", "0.4 times as probable".
std::string ProbabilityInWords(double cost);

// The smallest of 1, 2 and 5 times a power of ten that is >= x > 0.
double RoundUp(double x);

}  // namespace ibrdf
