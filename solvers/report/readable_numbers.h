// Numbers as people read them.
#pragma once
#include <string>

namespace ibrdf {

// Four digits; whole numbers, and those from 10000 to a billion, without
// decimals and in full; "-" for what is not finite.
std::string ShortNumber(double value);

// The smallest of 1, 2 and 5 times a power of ten that is >= x > 0.
double RoundUp(double x);

}  // namespace ibrdf
