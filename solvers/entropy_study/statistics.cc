#include "ibrdf/solvers/entropy_study/statistics.h"

#include <algorithm>
#include <cmath>
#include <numeric>

#include "ibrdf/base/pi.h"

namespace ibrdf {
namespace {

std::vector<double> Ranks(const std::vector<double>& x) {
  std::vector<size_t> order(x.size());
  std::iota(order.begin(), order.end(), size_t{0});
  std::sort(order.begin(), order.end(),
            [&](size_t a, size_t b) { return x[a] < x[b]; });
  std::vector<double> out(x.size());
  for (size_t i = 0; i < order.size();) {
    size_t end = i;
    while (end < order.size() && x[order[end]] == x[order[i]]) ++end;
    for (size_t k = i; k < end; ++k) {
      out[order[k]] = 0.5 * static_cast<double>(i + end - 1);
    }
    i = end;
  }
  return out;
}

}  // namespace

double Mean(const std::vector<double>& x) {
  return std::accumulate(x.begin(), x.end(), 0.0) /
         static_cast<double>(x.size());
}

double Pearson(const std::vector<double>& x, const std::vector<double>& y) {
  const double mx = Mean(x), my = Mean(y);
  double xx = 0.0, yy = 0.0, xy = 0.0;
  for (size_t k = 0; k < x.size(); ++k) {
    xx += (x[k] - mx) * (x[k] - mx);
    yy += (y[k] - my) * (y[k] - my);
    xy += (x[k] - mx) * (y[k] - my);
  }
  return xx > 0.0 && yy > 0.0 ? xy / std::sqrt(xx * yy) : 0.0;
}

double Spearman(const std::vector<double>& x, const std::vector<double>& y) {
  return Pearson(Ranks(x), Ranks(y));
}

double PartialCorrelation(const std::vector<double>& x,
                          const std::vector<double>& y,
                          const std::vector<double>& z) {
  const double xy = Pearson(x, y), xz = Pearson(x, z), yz = Pearson(y, z);
  const double rest = (1.0 - xz * xz) * (1.0 - yz * yz);
  return rest > 1e-12 ? (xy - xz * yz) / std::sqrt(rest) : 0.0;
}

double AreaForTopFifth(const std::vector<double>& x,
                       const std::vector<double>& y) {
  std::vector<double> sorted = y;
  std::sort(sorted.begin(), sorted.end());
  const double threshold = sorted[sorted.size() * 4 / 5];
  const std::vector<double> ranks = Ranks(x);
  double sum = 0.0, in = 0.0;
  for (size_t k = 0; k < y.size(); ++k) {
    if (y[k] < threshold) continue;
    sum += ranks[k];
    in += 1.0;
  }
  const double out = static_cast<double>(y.size()) - in;
  return out > 0.0 ? (sum - 0.5 * in * (in - 1.0)) / (in * out) : 0.5;
}

TTest PairedTTest(const std::vector<double>& x, const std::vector<double>& y) {
  std::vector<double> d(x.size());
  for (size_t k = 0; k < x.size(); ++k) d[k] = x[k] - y[k];
  const double n = static_cast<double>(d.size()), mean = Mean(d);
  double square = 0.0;
  for (const double v : d) square += (v - mean) * (v - mean);
  const double t = mean / std::sqrt(square / (n - 1.0) / n);
  // The tail of Student's density, by Simpson's rule in t = tan(u).
  const double df = n - 1.0;
  const double scale =
      std::exp(std::lgamma(0.5 * (df + 1.0)) - std::lgamma(0.5 * df)) /
      std::sqrt(df * kPi);
  const double from = std::atan(std::abs(t)), to = 0.5 * kPi;
  constexpr int kSteps = 2000;
  double tail = 0.0;
  for (int i = 0; i <= kSteps; ++i) {
    const double u = from + (to - from) * i / kSteps;
    const double tan = std::tan(std::min(u, to - 1e-9));
    const double f = scale * std::pow(1.0 + tan * tan / df, -0.5 * (df + 1.0)) *
                     (1.0 + tan * tan);
    tail += f * (i == 0 || i == kSteps ? 1.0 : (i % 2 == 1 ? 4.0 : 2.0));
  }
  return {t, 2.0 * tail * (to - from) / kSteps / 3.0};
}

}  // namespace ibrdf
