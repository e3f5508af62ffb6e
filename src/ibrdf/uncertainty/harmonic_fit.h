// Fits of spherical harmonics to scattered samples.
#pragma once
#include <Eigen/Core>
#include <cstdint>
#include <vector>

#include "ibrdf/approximation/harmonics.h"
#include "ibrdf/base/status.h"
#include "ibrdf/uncertainty/harmonic_fit_kernels.h"
#include "ibrdf/uncertainty/texel_samples.h"

namespace ibrdf {

// (Y^T W Y + lambda diag(e^l)) c = Y^T W f                  Eq. 12
//
// of Wiersma et al. 2025. W: weights of the samples, those of TexelSamples
// times cos^cosine_power(theta). The frame is that of the texel: harmonic
// (l, m) at HarmonicIndex(l, m), with its polar axis along the normal.
struct HarmonicFitOptions {
  int order = 5;  // l*, [1, 10]
  // The published code has 1e-3 for its fits and 1e-2 for the timing of the
  // entropy. > 0. It is not scaled by the number of samples, as in the code.
  double lambda = 1e-3;
  // The regulariser of degree 0, in units of lambda; the text and the published
  // code have e^0 = 1. We leave the constant almost free. The views see half a
  // sphere only, on which degree 0 costs less when odd degrees take a part of
  // it: then a matte surface under constant light has a spectrum, and looks
  // glossy. (0, 1].
  double constant_penalty = 1e-4;
  // The text weights samples by |cos(theta)|. The published code multiplies
  // both Y and f by it, which is 2. We follow the code: its results are those
  // of the tables. >= 0.
  double cosine_power = 2.0;

  Status Check() const;
};

// The samples of a batch, a lane a texel, in units of the map's mean radiance.
struct FitBatch {
  int num_views = 0;  // those that see a texel of the batch
  // [num_views, kFitBatch]: parts of the direction along the normal and the
  // two other axes.
  std::vector<float> polar, zero, side;
  std::vector<float> weight;  // [num_views, kFitBatch]: without the cosine
  std::vector<float> values;  // [num_views, kFitValues, kFitBatch]

  // Pointers into this and into the basis.
  BatchArguments Arguments(const HarmonicBasis& basis) const;
};

// Texels [first, first + kFitBatch) of the samples, divided by `unit`; those
// behind the last texel have no weight.
void GatherBatch(const TexelSamples& samples, int64_t first, double unit,
                 FitBatch* batch);

// Immutable; safe to share between threads, each with its own workspace.
class HarmonicFitter {
 public:
  // options: as they pass Check().
  explicit HarmonicFitter(const HarmonicFitOptions& options);

  struct Workspace {
    std::vector<double> numbers;
  };

  int order() const { return options_.order; }
  int count() const { return NumHarmonics(options_.order); }

  // coefficients [count(), kFitValues, kFitBatch]: all right-hand sides share
  // one Cholesky factor. Exactly 0 where all weights are.
  void Fit(const FitBatch& batch, Workspace* workspace,
           double* coefficients) const;

 private:
  HarmonicFitOptions options_;
  HarmonicBasis basis_;
  std::vector<double> regulariser_;  // [count()]: lambda e^l
};

// One texel's fit, to which samples are added one by one.
class SequentialFit {
 public:
  // num_values: right-hand sides.
  SequentialFit(const HarmonicFitOptions& options, int num_values);

  // A sample at the direction with harmonics Y [count], of weight >= 0 in the
  // normal equations, cosine and all; values [num_values]. O(count^2).
  void Add(const Eigen::VectorXd& Y, double weight,
           const Eigen::VectorXd& values);

  // Coefficients [count, num_values] as they are, and as Add would make them.
  const Eigen::MatrixXd& coefficients() const { return coefficients_; }
  Eigen::MatrixXd CoefficientsWith(const Eigen::VectorXd& Y, double weight,
                                   const Eigen::VectorXd& values) const;

 private:
  Eigen::MatrixXd inverse_;  // of the normal matrix
  Eigen::MatrixXd coefficients_;
};

// S(l) = sum_m c_lm^2 of every texel and channel.                      Eq. 8
struct PowerSpectra {
  int order = 0;
  int64_t num_signals = 0;  // 3 num_texels: red of all texels, green, blue
  // [order + 1, num_signals], row = degree.
  std::vector<float> outgoing, incoming;
};

// samples: as they pass Check(); radiance is divided by `unit`.
PowerSpectra FitPowerSpectra(const TexelSamples& samples,
                             const HarmonicFitOptions& options, double unit,
                             int num_threads);

}  // namespace ibrdf
