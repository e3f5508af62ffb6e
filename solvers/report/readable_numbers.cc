#include "ibrdf/solvers/report/readable_numbers.h"

#include <cmath>

#include "ibrdf/base/format.h"

namespace ibrdf {

std::string ShortNumber(double value) {
  if (!std::isfinite(value)) return "-";
  const double size = std::fabs(value);
  const bool whole = size < 1e9 && (size >= 1e4 || value == std::floor(value));
  return Format(whole ? "%.0f" : "%.4g", value);
}

double RoundUp(double x) {
  const double power = std::pow(10.0, std::floor(std::log10(x)));
  for (const double factor : {1.0, 2.0, 5.0}) {
    if (x <= factor * power * (1.0 + 1e-9)) return factor * power;
  }
  return 10.0 * power;
}

}  // namespace ibrdf
