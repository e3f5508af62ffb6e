#include "ibrdf/brdf/bivariate.h"

#include <glog/logging.h>

#include <algorithm>
#include <cmath>

#include "ibrdf/base/pi.h"

namespace ibrdf {
namespace {

constexpr double kFloor = 1e-6;  // raw units, as in the metric
constexpr int kCells = kMerlThetaH * kMerlThetaD;

// Lower of the two centres beside x, and where between them; x in bins.
int Lower(double x, int n, double* fraction) {
  const double at = std::clamp(x - 0.5, 0.0, n - 1.0);
  const int i = std::min(static_cast<int>(at), n - 2);
  *fraction = at - i;
  return i;
}

// Values of cells without bins, for one channel at one theta_d.
void FillColumn(const std::vector<char>& known, int theta_d, double* raw) {
  int last = -1;
  for (int i = 0; i < kMerlThetaH; ++i) {
    const int cell = BivariateTable::Cell(i, theta_d);
    if (known[cell]) {
      if (last < 0) {
        for (int k = 0; k < i; ++k) {
          raw[BivariateTable::Cell(k, theta_d)] = raw[cell];
        }
      }
      last = cell;
    } else if (last >= 0) {
      raw[cell] = raw[last];
    }
  }
}

}  // namespace

Eigen::Array3d BivariateTable::Evaluate(double theta_h, double theta_d,
                                        double /*phi_d*/) const {
  double fh = 0.0, fd = 0.0;
  const int i =
      Lower(std::sqrt(std::max(theta_h, 0.0) / (kPi / 2)) * kMerlThetaH,
            kMerlThetaH, &fh);
  const int j = Lower(theta_d / (kPi / 2) * kMerlThetaD, kMerlThetaD, &fd);
  Eigen::Array3d f;
  for (int c = 0; c < 3; ++c) {
    const double low = (1 - fd) * Raw(c, i, j) + fd * Raw(c, i, j + 1);
    const double high = (1 - fd) * Raw(c, i + 1, j) + fd * Raw(c, i + 1, j + 1);
    f[c] = kMerlScale[c] * ((1 - fh) * low + fh * high);
  }
  return f;
}

BrdfFunction BivariateTable::Function() const {
  return [brdf = *this](double theta_h, double theta_d, double phi_d) {
    return brdf.Evaluate(theta_h, theta_d, phi_d);
  };
}

StatusOr<BivariateTable> FitBivariate(const MerlTable& table,
                                      BivariateMean mean) {
  CHECK_EQ(size_t{3} * kMerlBins, table.raw.size());
  BivariateTable result;
  result.raw.assign(size_t{3} * kCells, 0.0);
  std::vector<char> known(kCells, 0);
  for (int cell = 0; cell < kCells; ++cell) {
    const int first = cell * kMerlPhiD;
    for (int c = 0; c < 3; ++c) {
      double sum = 0.0;
      int count = 0;
      for (int bin = first; bin < first + kMerlPhiD; ++bin) {
        const double raw = table.Raw(c, bin);
        if (!std::isfinite(raw)) {
          return InvalidInput("table: bin " + std::to_string(bin),
                              "expected finite values");
        }
        if (!(table.Raw(0, bin) > 0.0)) continue;
        const double value = std::max(raw, 0.0);
        sum += mean == BivariateMean::kGeometric ? std::log(value + kFloor)
                                                 : value;
        ++count;
      }
      if (count == 0) continue;
      known[cell] = 1;
      sum /= count;
      result.raw[static_cast<size_t>(c) * kCells + cell] =
          mean == BivariateMean::kGeometric
              ? std::max(std::exp(sum) - kFloor, 0.0)
              : sum;
    }
  }
  if (std::find(known.begin(), known.end(), 1) == known.end()) {
    return InvalidInput("table: red", "expected a bin with a positive value");
  }
  for (int c = 0; c < 3; ++c) {
    for (int j = 0; j < kMerlThetaD; ++j) {
      FillColumn(known, j, result.raw.data() + static_cast<size_t>(c) * kCells);
    }
  }
  return result;
}

}  // namespace ibrdf
