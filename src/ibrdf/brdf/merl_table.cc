#include "ibrdf/brdf/merl_table.h"

#include <algorithm>
#include <cmath>

#include "ibrdf/base/pi.h"

namespace ibrdf {
namespace {

// Angles of the bins' centres: a table has 1.5 million.
struct BinTrigonometry {
  BinTrigonometry() {
    for (int i = 0; i < kMerlThetaH; ++i) {
      cos_h[i] = std::cos(MerlThetaH(i));
      sin_h[i] = std::sin(MerlThetaH(i));
    }
    for (int j = 0; j < kMerlThetaD; ++j) {
      cos_d[j] = std::cos(MerlThetaD(j));
      sin_d[j] = std::sin(MerlThetaD(j));
    }
    for (int k = 0; k < kMerlPhiD; ++k) cos_p[k] = std::cos(MerlPhiD(k));
  }
  double cos_h[kMerlThetaH], sin_h[kMerlThetaH];
  double cos_d[kMerlThetaD], sin_d[kMerlThetaD];
  double cos_p[kMerlPhiD];
};
}  // namespace

double MerlThetaH(int i) {
  const double x = (i + 0.5) / kMerlThetaH;
  return x * x * (kPi / 2);
}
double MerlThetaD(int j) { return (j + 0.5) / kMerlThetaD * (kPi / 2); }
double MerlPhiD(int k) { return (k + 0.5) / kMerlPhiD * kPi; }

double MerlBinLowestCosine(int theta_h, int theta_d, int phi_d) {
  static const BinTrigonometry t;
  // The two cosines are the sum and the difference of these.
  return t.cos_h[theta_h] * t.cos_d[theta_d] -
         std::abs(t.sin_h[theta_h] * t.sin_d[theta_d] * t.cos_p[phi_d]);
}

bool MerlBinAboveHorizon(int theta_h, int theta_d, int phi_d) {
  return MerlBinLowestCosine(theta_h, theta_d, phi_d) > 0.0;
}

Eigen::Array3d InterpolateMerl(const MerlTable& table, double theta_h,
                               double theta_d, double phi_d) {
  const double x =
      std::sqrt(std::max(theta_h, 0.0) / (kPi / 2)) * kMerlThetaH - 0.5;
  const double y = theta_d / (kPi / 2) * kMerlThetaD - 0.5;
  const double z = phi_d / kPi * kMerlPhiD - 0.5;
  const double x0 = std::floor(x), y0 = std::floor(y), z0 = std::floor(z);
  const double fx = x - x0, fy = y - y0, fz = z - z0;
  Eigen::Array3d sum = Eigen::Array3d::Zero();
  double weights = 0.0;
  for (int corner = 0; corner < 8; ++corner) {
    const int di = corner & 1, dj = (corner >> 1) & 1, dk = corner >> 2;
    const double w =
        (di ? fx : 1 - fx) * (dj ? fy : 1 - fy) * (dk ? fz : 1 - fz);
    if (w <= 0.0) continue;
    const int i = std::clamp(static_cast<int>(x0) + di, 0, kMerlThetaH - 1);
    const int j = std::clamp(static_cast<int>(y0) + dj, 0, kMerlThetaD - 1);
    const int k = (static_cast<int>(z0) + dk + kMerlPhiD) % kMerlPhiD;
    const int bin = MerlTable::Bin(i, j, k);
    if (table.Raw(0, bin) < 0.0) continue;
    weights += w;
    for (int c = 0; c < 3; ++c) {
      sum[c] += w * std::max(table.Raw(c, bin), 0.0) * kMerlScale[c];
    }
  }
  if (weights <= 0.0) return Eigen::Array3d::Zero();
  return sum / weights;
}

}  // namespace ibrdf
