#include "ibrdf/solvers/report/short_number.h"

#include <cmath>

#include "ibrdf/base/format.h"

namespace ibrdf {

std::string ShortNumber(double value) {
  if (!std::isfinite(value)) return "-";
  const bool whole = value == std::floor(value) && std::fabs(value) < 1e9;
  return Format(whole ? "%.0f" : "%.4g", value);
}

}  // namespace ibrdf
