// Measured isotropic BRDFs on the grid of the MERL database
// (Matusik et al. 2003).
#pragma once
#include <Eigen/Core>
#include <array>
#include <cstddef>
#include <vector>

namespace ibrdf {

inline constexpr int kMerlThetaH = 90;
inline constexpr int kMerlThetaD = 90;
inline constexpr int kMerlPhiD = 180;
inline constexpr int kMerlBins = kMerlThetaH * kMerlThetaD * kMerlPhiD;
// BRDF in 1/sr = raw * kMerlScale[channel], channels red, green, blue.
inline constexpr std::array<double, 3> kMerlScale = {1.0 / 1500, 1.15 / 1500,
                                                     1.66 / 1500};

// Raw values in the order of the file: [channel][theta_h][theta_d][phi_d].
// Entries are values at bin centres: theta_h = ((i + 1/2) / 90)^2 pi/2,
// theta_d = (j + 1/2) / 90 pi/2, phi_d = (k + 1/2) / 180 pi. A negative raw
// value marks an invalid bin (a direction below the horizon).
struct MerlTable {
  std::vector<double> raw;  // [3 * kMerlBins]

  static constexpr int Bin(int theta_h, int theta_d, int phi_d) {
    return (theta_h * kMerlThetaD + theta_d) * kMerlPhiD + phi_d;
  }
  double Raw(int channel, int bin) const {
    return raw[static_cast<size_t>(channel) * kMerlBins + bin];
  }
};

// Angles of a bin centre, radians.
double MerlThetaH(int i);
double MerlThetaD(int j);
double MerlPhiD(int k);

// Smaller one of the cosines of the two directions of a bin's centre.
double MerlBinLowestCosine(int theta_h, int theta_d, int phi_d);

// Whether both directions of the bin's centre are above the horizon.
bool MerlBinAboveHorizon(int theta_h, int theta_d, int phi_d);

// BRDF in 1/sr at any angles, trilinear between bin centres (theta_h on its
// square-root axis, phi_d periodic), over the valid corners only; clamped
// beyond the first and last centre. 0 where no corner is valid.
Eigen::Array3d InterpolateMerl(const MerlTable& table, double theta_h,
                               double theta_d, double phi_d);

}  // namespace ibrdf
