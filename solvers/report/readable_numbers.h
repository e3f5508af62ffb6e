// Numbers as people read them.
#pragma once
#include <string>

namespace ibrdf {

// Four digits, whole numbers below a billion in full; "-" for what is not
// finite.
std::string ShortNumber(double value);

// The smallest of 1, 2 and 5 times a power of ten that is >= x > 0.
double RoundUp(double x);

}  // namespace ibrdf
