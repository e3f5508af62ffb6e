// A line through a BRDF, with what its posterior leaves open.
#pragma once
#include <array>
#include <string>
#include <vector>

namespace ibrdf {

struct BrdfSlice {
  std::string name;   // what is held fixed, in words
  std::string angle;  // that of the abscissa, in words
  std::vector<double> degrees;
  // 1/sr, red, green, blue at each of `degrees`: the estimate, and the ends of
  // the interval that holds nine tenths of the posterior.
  std::array<std::vector<double>, 3> value, low, high;
};

}  // namespace ibrdf
