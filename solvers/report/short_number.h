// Numbers of tables and sentences.
#pragma once
#include <string>

namespace ibrdf {

// Four digits, whole numbers below a billion in full; "-" for what is not
// finite.
std::string ShortNumber(double value);

}  // namespace ibrdf
