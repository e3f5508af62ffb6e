// Maps as mixtures of spherical Gaussians (Tsai and Shih 2006):
// L_c(w) = sum_k a_kc exp(lambda_k (mu_k . w - 1)), of amplitude a, sharpness
// lambda and axis mu.
#pragma once
#include <Eigen/Cholesky>
#include <Eigen/Core>
#include <vector>

#include "ibrdf/image/image.h"

namespace ibrdf {

struct SphericalGaussian {
  Eigen::Vector3d axis;  // unit
  double sharpness;      // >= 0; 0 is constant, its width is 1/sqrt radians
};

// Amplitudes of red, green and blue; one row a Gaussian.
using GaussianColours = Eigen::Matrix<double, Eigen::Dynamic, 3>;

// The integral over the sphere of a Gaussian of amplitude 1, sr.
double GaussianIntegral(double sharpness);

struct GaussianFitOptions {
  // Equal Gaussians on axes evenly spread over the sphere, beside a constant.
  int spread = 128;
  // Theirs over their number: neighbours meet at about 0.2. Broader ones, which
  // overlap more, need amplitudes that almost cancel.
  double sharpness_each = 0.25;
  // Added to the normal equations' diagonal, over it: keeps amplitudes that
  // almost cancel small, which interpolation between tables would not survive.
  double ridge = 3e-3;
  // At most so many more at spots brighter than `contrast` times the mean of
  // the map without those found before, within peak_radius of their centre.
  int most_peaks = 16;
  double contrast = 8.0;
  double peak_radius_degrees = 5.0;
  // Spots with less of the map's flux are left to the spread ones.
  double least_flux = 1e-4;
  // Height of the map, 2 x 1, that the spread Gaussians are fitted to.
  int fit_height = 32;
};

// The linear map from radiance to amplitudes, with lobes chosen for one map.
//
// A spot's Gaussian takes over what its texels have above their surroundings,
// and has the energy, the mean direction and the spread of it. The rest is
// fitted by least squares, weighted by solid angle, under the condition that
// energy is kept. Amplitudes may be negative: held at zero, they would leave
// low frequencies, which matte surfaces show, in the residual, and the fit
// would not be linear.
//
// Immutable; safe to share between threads.
class GaussianLight {
 public:
  // map: finite, >= 0; which texels make spots is chosen by it, not by
  // differentiable means.
  explicit GaussianLight(const Image& map,
                         const GaussianFitOptions& options = {});

  // The constant, then the spread ones, then the spots'.
  const std::vector<SphericalGaussian>& lobes() const { return lobes_; }
  int count() const { return static_cast<int>(lobes_.size()); }
  int num_peaks() const { return count() - num_spread_; }

  // Amplitudes [count, 3] of a map [H, W, 3] of the constructor's size, linear
  // in it; their integrals add up to the map's.
  GaussianColours Fit(const float* map) const;
  // gradient [H, W, 3] of sum adjoint.Fit(map).
  void Transpose(const GaussianColours& adjoint, float* gradient) const;

  // What the spread Gaussians leave of a map without its spots: cells' means
  // less the mixture's, 2 fit_height x fit_height.
  Image Residual(const float* map) const;

 private:
  // A part of a texel that belongs to a spot.
  struct SpotTexel {
    int texel, lobe;
    double share;  // (0, 1]
  };
  // Area shared by a cell and a line of texels, over the cell's.
  struct Overlap {
    int cell, line;
    double share;
  };
  using Cells = Eigen::Matrix<double, Eigen::Dynamic, 3>;

  static std::vector<Overlap> Overlaps(const std::vector<double>& cells,
                                       const std::vector<double>& lines);
  struct SpotSearch;
  void FindSpots(const Image& map, const GaussianFitOptions& options);
  // The texels around a peak that are brighter than what surrounds them, its
  // mean radiance.
  std::vector<SpotTexel> SpotAround(const SpotSearch& search, int peak,
                                    double* background) const;
  double Area(int texel) const;  // sr
  // Adds the lobe of texels that take `share` of their radiance.
  void AddSpot(const Image& map, const std::vector<SpotTexel>& texels);
  void PrepareFit(double ridge);
  // Means of the cells without spots, and back.
  Cells Gather(const float* map) const;
  void Scatter(const Cells& adjoint, std::vector<double>* gradient) const;
  GaussianColours FitSpread(const Cells& cells) const;

  int height_, width_, rows_, columns_;
  int num_spread_ = 0;  // with the constant
  std::vector<SphericalGaussian> lobes_;
  std::vector<SpotTexel> spots_;
  std::vector<Overlap> by_row_, by_column_;
  Eigen::VectorXd solid_angle_;  // [cells]
  // Means of the spread lobes over cells [cells, num_spread_], the normal
  // equations' factors, the lobes' integrals, and what these equations make of
  // them.
  Eigen::MatrixXd basis_;
  Eigen::LLT<Eigen::MatrixXd> normal_;
  Eigen::VectorXd integrals_, solved_integrals_;
};

}  // namespace ibrdf
