#include "ibrdf/brdf/void_bins.h"

#include <cmath>

#include "ibrdf/base/pi.h"

namespace ibrdf {

void VoidBeyond(double degrees, MerlTable* table) {
  if (degrees >= 90.0) return;  // those are below the horizon
  const double lowest = std::cos(degrees / 180.0 * kPi);
  for (int h = 0; h < kMerlThetaH; ++h) {
    for (int d = 0; d < kMerlThetaD; ++d) {
      for (int p = 0; p < kMerlPhiD; ++p) {
        if (MerlBinLowestCosine(h, d, p) >= lowest) continue;
        for (int c = 0; c < 3; ++c) {
          table->raw[size_t{kMerlBins} * c + MerlTable::Bin(h, d, p)] = -1.0;
        }
      }
    }
  }
}

}  // namespace ibrdf
