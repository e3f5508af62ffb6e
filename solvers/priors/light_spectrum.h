// The light's correlation by Fourier transform along the rows of a map.
#pragma once
#include <Eigen/Core>
#include <functional>
#include <memory>
#include <vector>

#include "ibrdf/solvers/optim/dense_algebra.h"
#include "ibrdf/solvers/priors/light_process.h"

namespace ibrdf {

// A symmetric function of two texels that is the same at every longitude: with
// F an orthonormal real Fourier basis along the rows, C = F^T diag_k(S_k) F,
// S_k [H][H] for each frequency. A product takes O(W H (W + H)) instead of
// (W H)^2.
class LightSpectrum {
 public:
  using Correlation =
      std::function<double(const Eigen::Vector3d&, const Eigen::Vector3d&)>;
  // width even. correlation: of unit directions, 1 of one with itself.
  LightSpectrum(int height, int width, const Correlation& correlation);

  int height() const { return height_; }
  int width() const { return width_; }
  int num_frequencies() const { return width_ / 2 + 1; }
  // Columns of [column][coefficient]: constant, then cosine and sine of each
  // frequency; the highest has a cosine alone. FrequencyOf names them.
  const RowMatrix& basis() const { return *basis_; }
  static int FrequencyOf(int coefficient) { return (coefficient + 1) / 2; }
  // S_k, symmetric.
  const RowMatrix& block(int frequency) const { return blocks_[frequency]; }

  // out = X C for rows of maps: X [n][H W].
  void Multiply(const RowMatrix& X, RowMatrix* out) const;

  // share diag(by_row) C diag(by_row), by_row [H].
  LightSpectrum Scaled(double share, const Eigen::VectorXd& by_row) const;
  // C + value[r] value[r'] between texels of rows r and r', value [H].
  LightSpectrum PlusRows(const Eigen::VectorXd& value) const;
  // The other one has the same size.
  LightSpectrum Plus(const LightSpectrum& other) const;

 private:
  int height_, width_;
  std::shared_ptr<const RowMatrix> basis_;
  std::vector<RowMatrix> blocks_;
};

// The correlation of LightProcess on a map, for any hyperparameters.
class ProcessSpectrum {
 public:
  ProcessSpectrum(int height, int width, const LightProcess& process);
  // All of C, and its rough part.
  LightSpectrum At(const LightHyperparameters& hyperparameters) const;
  LightSpectrum RoughAt(const LightHyperparameters& hyperparameters) const;

 private:
  LightProcess process_;
  LightSpectrum smooth_, rough_;
};

}  // namespace ibrdf
