#include "ibrdf/solvers/report/readable_numbers.h"

#include <algorithm>
#include <cmath>

#include "ibrdf/base/format.h"

namespace ibrdf {

std::string ShortNumber(double value) {
  if (!std::isfinite(value)) return "-";
  const double size = std::fabs(value);
  const bool whole = size < 1e9 && (size >= 1e4 || value == std::floor(value));
  return Format(whole ? "%.0f" : "%.4g", value);
}

std::string RoundNumber(double value) {
  const double size = std::fabs(value);
  if (size > 0.0 && size < 1e-3) return "below 0.001";
  if (size == 0.0 || !std::isfinite(value)) return ShortNumber(value);
  const double digit = std::pow(10.0, std::floor(std::log10(size)) - 1.0);
  return ShortNumber(digit * std::round(value / digit));
}

std::string ErrorInWords(double log_error) {
  constexpr double kMostPercent = 0.4;
  const double size = std::fabs(log_error);
  if (!(size <= kLargestKnownError)) return "not determined";
  if (size < 0.01) return "less than 1 %";
  if (size < kMostPercent) {
    const double percent = 100.0 * size;
    const double step = percent < 10.0 ? 1.0 : percent < 20.0 ? 5.0 : 10.0;
    return Format("some %.0f %%", step * std::round(percent / step));
  }
  // Halves are fine enough.
  return Format("a factor of %.3g", std::round(2.0 * std::exp(size)) / 2.0);
}

std::string ProbabilityInWords(double cost) {
  constexpr double kAsProbable = 0.95, kMostCost = 700.0;  // exp stays above 0
  const double ratio = std::exp(-std::min(cost, kMostCost));
  return ratio > kAsProbable ? "as probable"
                             : RoundNumber(ratio) + " times as probable";
}

double RoundUp(double x) {
  const double power = std::pow(10.0, std::floor(std::log10(x)));
  for (const double factor : {1.0, 2.0, 5.0}) {
    if (x <= factor * power * (1.0 + 1e-9)) return factor * power;
  }
  return 10.0 * power;
}

}  // namespace ibrdf
