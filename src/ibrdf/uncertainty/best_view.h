// The next view: that of the least entropy to expect.
#pragma once
#include <Eigen/Core>
#include <vector>

#include "ibrdf/base/status.h"
#include "ibrdf/uncertainty/harmonic_fit.h"
#include "ibrdf/uncertainty/spectrum_entropy.h"
#include "ibrdf/uncertainty/texel_samples.h"

namespace ibrdf {

struct BestViewOptions {
  // sigma: half of what maps of entropy take. A search may be surer than its
  // model is right: what counts is which view tells more (experiments/entropy).
  SpectrumOptions spectrum = WithSigma(0.025);
  // With fewer photographs all parameters are taken as equally probable, as in
  // the published code.
  int trusted_views = 10;
  // What is hypothetically observed has alpha = i / (num_alpha - 1), while its
  // probability is that of the square. A fault of the published code, whose
  // effect this measures.
  bool published_alpha = false;
  // Texels that no view has seen count with their entropy, 1. The published
  // code leaves them out (an exact comparison, H < 1), so that nothing is
  // gained by a view of what was never seen.
  bool published_mask = false;

  Status Check() const;

 private:
  static SpectrumOptions WithSigma(double sigma) {
    SpectrumOptions options;
    options.sigma = sigma;
    return options;
  }
};

// Greedy search, Wiersma et al. 2025, Eq. 13. Thread-compatible.
class BestViewSearch {
 public:
  // candidates: all views, as they pass Check(). Their incoming radiance,
  // directions and weights are known before a photograph is taken, as geometry
  // and light are; outgoing radiance is read of photographed views alone.
  // Must outlive the search. options: as they pass Check().
  BestViewSearch(const TexelSamples& candidates, BestViewOptions options,
                 int num_threads);

  // Takes a view; photographed: its outgoing radiance is known, and narrows the
  // parameters. A planned view only adds light. O(count^2) a texel.
  void Add(int view, bool photographed);

  // [num_views]: mean over texels and channels of the entropy to expect if the
  // view were added; infinite where it is taken already.
  std::vector<double> ExpectedEntropies() const;

  // The least of them, the first of equals; -1 where all are taken.
  int Best() const;

  const std::vector<int>& taken() const { return taken_; }

 private:
  void AddExpected(int texel, double* sums) const;
  std::vector<float> Probabilities(int texel, int channel) const;

  const TexelSamples& candidates_;
  const BestViewOptions options_;
  const int num_threads_;
  const HarmonicBasis basis_;
  // As the kernels take them.
  std::vector<float> filter_, hypothetical_, factor_, scale_, penalty_;

  std::vector<SequentialFit> observed_;  // both radiances, photographed views
  std::vector<SequentialFit> light_;     // incoming radiance, taken views
  std::vector<int> taken_;
  int num_photographed_ = 0;
};

// `count` views in all, the first of them `initial`, photographed or planned.
std::vector<int> BestViews(const TexelSamples& candidates,
                           const std::vector<int>& initial, int count,
                           bool photographed, const BestViewOptions& options,
                           int num_threads);

// Farthest-point sampling, the baseline: `count` of the points, first `initial`
// (the point 0, where it is empty), then always the one that is farthest from
// those taken, the first of equals.
std::vector<int> FarthestPoints(const std::vector<Eigen::Vector3d>& points,
                                const std::vector<int>& initial, int count);

}  // namespace ibrdf
