#include "ibrdf/base/gauss_legendre.h"

#include <glog/logging.h>

#include <cmath>

#include "ibrdf/base/pi.h"

namespace ibrdf {

void GaussLegendre(int n, std::vector<double>* nodes,
                   std::vector<double>* weights) {
  CHECK_GE(n, 1);
  nodes->resize(n);
  weights->resize(n);
  for (int i = 0; i < n; ++i) {
    // Newton's method on P_n from the usual start.
    double x = std::cos(kPi * (i + 0.75) / (n + 0.5)), slope = 1.0;
    for (int step = 0; step < 100; ++step) {
      double p = 1.0, before = 0.0;
      for (int k = 1; k <= n; ++k) {
        const double next = ((2 * k - 1) * x * p - (k - 1) * before) / k;
        before = p;
        p = next;
      }
      slope = n * (x * p - before) / (x * x - 1.0);
      const double change = p / slope;
      x -= change;
      if (std::abs(change) < 1e-15) break;
    }
    (*nodes)[n - 1 - i] = 0.5 * (1.0 + x);
    (*weights)[n - 1 - i] = 1.0 / ((1.0 - x * x) * slope * slope);
  }
}

}  // namespace ibrdf
