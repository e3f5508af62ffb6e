#include "experiments/validation/stability/sweep_table.h"

#include <glog/logging.h>

#include <algorithm>
#include <cmath>
#include <cstdio>
#include <limits>

namespace ibrdf {
namespace stability {

void SweepTable::Add(const std::string& sweep, double x,
                     const std::string& quantity,
                     const std::string& implementation,
                     const std::vector<double>& errors) {
  CHECK(!errors.empty());
  std::vector<double> sorted;
  int not_finite = 0;
  double worst = -1.0;
  for (const double e : errors) {
    const bool finite = std::isfinite(e);
    sorted.push_back(finite ? e : std::numeric_limits<double>::infinity());
    not_finite += !finite;
    if (finite) worst = std::max(worst, e);
  }
  std::sort(sorted.begin(), sorted.end());
  const double median = sorted[(sorted.size() - 1) / 2];
  if (worst < 0.0) worst = std::numeric_limits<double>::infinity();
  char line[256];
  std::snprintf(line, sizeof(line), "%s,%.6g,%s,%s,%zu,%d,%.3g,%.3g",
                sweep.c_str(), x, quantity.c_str(), implementation.c_str(),
                errors.size(), not_finite, median, worst);
  lines_.emplace_back(line);
}

std::string SweepTable::Csv() const {
  std::string out =
      "sweep,x,quantity,implementation,count,not_finite,median,worst\n";
  for (const std::string& line : lines_) out += line + "\n";
  return out;
}

double RelativeError(double value, Real reference) {
  const Real size = std::abs(reference);
  const Real difference = std::abs(value - reference);
  return static_cast<double>(size > 0 ? difference / size : difference);
}

}  // namespace stability
}  // namespace ibrdf
