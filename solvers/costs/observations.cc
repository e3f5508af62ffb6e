#include "ibrdf/solvers/costs/observations.h"

#include <glog/logging.h>

#include <cmath>
#include <utility>

namespace ibrdf {

Observations MakeObservations(std::vector<double> radiance) {
  return MakeObservations(std::move(radiance), {}, {});
}

Observations MakeObservations(std::vector<double> radiance,
                              std::vector<double> low,
                              std::vector<double> high) {
  CHECK_EQ(low.size(), high.size());
  CHECK(low.empty() || low.size() == radiance.size());
  Observations o;
  o.radiance = std::move(radiance);
  o.low = std::move(low);
  o.high = std::move(high);
  o.valid.resize(o.radiance.size() / 3);
  for (size_t i = 0; i < o.valid.size(); ++i) {
    bool valid = true;
    for (size_t k = 3 * i; k < 3 * i + 3; ++k) {
      const double v = o.radiance[k];
      valid &= std::isfinite(v) && v > 0.0 && !o.Interval(k).IsMissing();
    }
    o.valid[i] = valid;
    o.num_valid += valid;
  }
  return o;
}

Observations SelectObservations(const Observations& from,
                                const std::vector<size_t>& points) {
  const auto select = [&](const std::vector<double>& values) {
    std::vector<double> selected;
    if (values.empty()) return selected;
    for (const size_t i : points) {
      selected.insert(selected.end(), values.begin() + 3 * i,
                      values.begin() + 3 * i + 3);
    }
    return selected;
  };
  return MakeObservations(select(from.radiance), select(from.low),
                          select(from.high));
}

double MeanRadiance(const Observations& observed) {
  double sum = 0.0;
  for (size_t i = 0; i < observed.radiance.size(); ++i) {
    if (observed.valid[i / 3]) sum += observed.radiance[i];
  }
  return sum / (3.0 * observed.num_valid);
}

}  // namespace ibrdf
